// Reading and checking of option values shared by the commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "render/render.h"
#include "scene/gltf_reader.h"
#include "scene/mitsuba_reader.h"

namespace wavelobe {

// A check for whole numbers in a range, which says so when a value is anything else.
CLI::Validator whole_number(std::int64_t least, std::int64_t greatest);

// The positional SCENE, -D NAME=VALUE, and what glTF leaves to the user.
struct SceneArguments {
    std::string path;
    std::vector<std::string> definitions;
    std::string resolution;  // empty: the camera's aspect ratio decides
    std::optional<double> frame_time;

    void add_to(CLI::App& command);
    Scene read() const;
};

// What the reader passed over or repaired, on stderr.
void print_warnings(const Scene& scene);

// What the reader added, on stdout.
void print_notes(const Scene& scene);

// Pixels from (x0, y0) up to, not including, (x1, y1).
struct PixelWindow {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
};

// Reads `X0,Y0,X1,Y1`; nothing for any other text.
std::optional<PixelWindow> parse_window(const std::string& text);

// Reads `X,Y,S`; nothing for any other text.
std::optional<SampleName> parse_sample_name(const std::string& text);

// Throws InputError naming the film's size when the window is empty or not inside it.
void set_crop_window(Film& film, const PixelWindow& window);

}  // namespace wavelobe
