// What `render` tells about a render: a closing line, a table, a file for machines.
#pragma once

#include <string>

#include "render/render.h"

namespace wavelobe {

struct RenderReport {
    std::string scene_path;
    std::string device;
    unsigned threads = 0;
    int samples_per_pixel = 0;
    std::uint32_t seed = 0;
    int width = 0;  // of the crop window
    int height = 0;
    bool complete = true;
    RenderStats stats;  // `setup_parts` with the program's own parts added
};

// `render 3.142 s, setup 0.210 s, 41.2 M samples, 13.1 M samples/s`
std::string closing_line(const RenderReport& report);
std::string report_table(const RenderReport& report);
std::string report_json(const RenderReport& report);

// A line a vertex and light sample of the path.
std::string replay_text(const Replay& replay);

// Names the first of the samples left out; empty when there are none.
std::string non_finite_warning(const RenderStats& stats);

// Of a picture that was ended before each pixel had a sample; empty otherwise.
std::string holes_warning(const RenderReport& report);

}  // namespace wavelobe
