// How far the work is: a bar on a terminal, now and then a line elsewhere.
#pragma once

#include <string>

#include "render/render.h"

namespace wavelobe {

// `  42 %  13.1 M samples/s  1:02 left`
std::string progress_text(const Progress& progress);

// `  42 %  building the hierarchy`
std::string building_text(double share);

class ProgressDisplay {
public:
    explicit ProgressDisplay(bool quiet);
    ~ProgressDisplay() { finish(); }
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;
    void update(const Progress& progress);
    // Before anything is rendered; nothing is shown of what takes no time to speak of.
    void update_building(double share, double seconds);
    void finish();  // removes the bar; what follows begins anew

private:
    void show(double share, double seconds, const std::string& text);

    bool quiet_;
    bool terminal_;
    bool drawn_ = false;
    double last_seconds_ = 0.0;  // of this work, at the last output
    double last_share_ = 0.0;
};

}  // namespace wavelobe
