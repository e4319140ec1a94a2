#include "cli/render_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "cli/format.h"

namespace wavelobe {
namespace {

double samples_per_second(const RenderStats& stats) {
    return stats.render_seconds > 0.0 ? static_cast<double>(stats.samples) / stats.render_seconds : 0.0;
}

}  // namespace

std::string closing_line(const RenderReport& report) {
    const RenderStats& stats = report.stats;
    std::string line = fmt::format("render {:.3f} s, setup {:.3f} s, {} samples, {} samples/s", stats.render_seconds,
                                   stats.setup_seconds(), format_millions(static_cast<double>(stats.samples)),
                                   format_millions(samples_per_second(stats)));
    if (stats.estimated_error) line += fmt::format(", estimated relMSE {:.3g}", *stats.estimated_error);
    return line;
}

std::string report_table(const RenderReport& report) {
    const RenderStats& stats = report.stats;
    std::string text = fmt::format("device    {}, {} threads\nfeatures  {}\nbuffers   {}\n", report.device, report.threads,
                                   fmt::join(stats.features, " "), format_bytes(stats.device_bytes));
    text += "set-up                        seconds\n";
    for (const auto& [part, seconds] : stats.setup_parts) text += fmt::format("  {:<24} {:>10.3f}\n", part, seconds);
    text += "rays\n";
    for (const auto& [kind, count] : stats.rays) text += fmt::format("  {:<24} {:>18}\n", kind, format_count(count));
    text += "stage                     launches              items    seconds   ns/item\n";
    for (const StageStats& stage : stats.stages) {
        const double nanoseconds = stage.items > 0 ? 1e9 * stage.seconds / static_cast<double>(stage.items) : 0.0;
        text += fmt::format("  {:<20} {:>11} {:>18} {:>10.3f} {:>9.1f}\n", stage.name, stage.launches,
                            format_count(stage.items), stage.seconds, nanoseconds);
    }
    return text;
}

std::string report_json(const RenderReport& report) {
    using Json = nlohmann::ordered_json;
    const RenderStats& stats = report.stats;
    Json json;
    json["version"] = WAVELOBE_VERSION;
    json["scene"] = report.scene_path;
    json["device"] = report.device;
    json["threads"] = report.threads;
    json["width"] = report.width;
    json["height"] = report.height;
    json["spp"] = report.samples_per_pixel;
    json["seed"] = report.seed;
    json["complete"] = report.complete;
    json["render_seconds"] = stats.render_seconds;
    json["setup_seconds"] = stats.setup_seconds();
    json["samples"] = stats.samples;
    json["samples_per_second"] = samples_per_second(stats);
    if (stats.estimated_error) json["estimated_relmse"] = *stats.estimated_error;
    json["nan_samples"] = stats.nan_samples;
    json["nan_examples"] = Json::array();
    for (const auto& [name, stage] : stats.nan_examples) {
        json["nan_examples"].push_back({{"x", name.x}, {"y", name.y}, {"sample", name.sample}, {"stage", stage}});
    }
    json["setup"] = stats.setup_parts;
    json["rays"] = stats.rays;
    json["features"] = stats.features;
    json["device_bytes"] = stats.device_bytes;
    json["expected_peak_bytes"] = stats.expected_peak_bytes;
    json["stages"] = Json::array();
    for (const StageStats& stage : stats.stages) {
        json["stages"].push_back({{"name", stage.name},
                                  {"launches", stage.launches},
                                  {"items", stage.items},
                                  {"seconds", stage.seconds}});
    }
    // Paths need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string holes_warning(const RenderReport& report) {
    // Every tile has its first sample before any has its second.
    const std::uint64_t pixels = static_cast<std::uint64_t>(report.width) * static_cast<std::uint64_t>(report.height);
    const bool none_asked_for = report.stats.samples == 0;  // paths of no edges
    if (none_asked_for || report.stats.samples >= pixels) return {};
    return fmt::format("{} of {} pixels have no sample yet and are black: the picture was ended too soon", pixels - report.stats.samples, pixels);
}

std::string non_finite_warning(const RenderStats& stats) {
    if (stats.nan_samples == 0) return {};
    std::string text = fmt::format("{} samples were NaN or infinite and are left out of the picture", stats.nan_samples);
    const char* separator = "; the first: ";
    for (const auto& [name, stage] : stats.nan_examples) {
        text += fmt::format("{}pixel ({}, {}) sample {} in {}", separator, name.x, name.y, name.sample, stage);
        separator = ", ";
    }
    if (!stats.nan_examples.empty()) {
        const SampleName& name = stats.nan_examples.front().name;
        text += fmt::format("\n  `--replay {},{},{}` in place of the output shows the first of these paths", name.x, name.y, name.sample);
    }
    return text;
}

std::string replay_text(const Replay& replay) {
    const auto vector = [](const glm::vec3& v) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z); };
    std::string text;
    for (const Replay::Vertex& v : replay.vertices) {
        text += v.shadow ? "  light sample" : v.emission_ray ? "emission ray" : fmt::format("vertex {}", v.depth);
        text += fmt::format(": {}, ", v.stage);
        if (v.shape && v.primitive) text += fmt::format("{} shape {} primitive {} ", v.shadow ? "from" : "hit", *v.shape, *v.primitive);
        if (!v.shape) text += "hit nothing, from ";
        text += fmt::format("at {}, distance {:.9g} along {}, {} {}, pdf {:.9g}, radiance so far {}\n", vector(v.position), v.distance,
                            vector(v.direction), v.shadow ? "brings" : "throughput", vector(v.throughput), v.pdf, vector(v.radiance));
    }
    if (replay.left_out > 0) text += fmt::format("... and {} more\n", replay.left_out);
    text += fmt::format("radiance of the sample: {}\n", vector(replay.radiance));
    if (!replay.broken_by.empty()) text += fmt::format("not finite since {}\n", replay.broken_by);
    return text;
}

}  // namespace wavelobe
