// How far rendering is: a bar on a terminal, now and then a line elsewhere.
#pragma once

#include "render/render.h"

namespace wavelobe {

// `  42 %  13.1 M samples/s  1:02 left`
std::string progress_text(const Progress& progress);

class ProgressDisplay {
public:
    explicit ProgressDisplay(bool quiet);
    void update(const Progress& progress);
    void finish();  // removes the bar

private:
    bool quiet_;
    bool terminal_;
    bool drawn_ = false;
    double last_seconds_ = 0.0;  // of rendering, at the last output
    double last_share_ = 0.0;
};

}  // namespace wavelobe
