#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/render_report.h"
#include "film/exr.h"
#include "film/png.h"
#include "film/replace_file.h"
#include "render/render.h"
#include "scene/fault.h"

namespace wavelobe {
namespace {

const std::map<std::string, BvhQuality> bvh_names = {{"fast", BvhQuality::fast}, {"best", BvhQuality::best}};
const std::map<std::string, Driver> driver_names = {{"one-kernel", Driver::one_kernel}, {"staged", Driver::staged}};

struct RenderOptions {
    SceneArguments scene;
    std::string exr_path;
    std::string png_path;    // empty: none
    std::string stats_path;  // empty: none
    std::optional<int> samples_per_pixel;
    std::optional<int> max_depth;
    std::string crop;    // empty: the scene's
    std::string replay;  // empty: a picture is made
    std::optional<std::uint32_t> seed;
    int threads = 0;
    Driver driver = Driver::one_kernel;
    std::optional<BvhQuality> bvh;
    double target_error = 0.0;  // 0: none
    double time_limit = 0.0;    // 0: none
    std::string device;
    bool smooth_terminator = false;
    bool quiet = false;
    bool verbose = false;
};

// Where an error or the time ends a render.
constexpr int most_samples = 1 << 20;

class Stopwatch {
public:
    // Seconds since the last call, or since the start.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> passed = now - last_;
        last_ = now;
        return passed.count();
    }
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count(); }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void check_outputs(const RenderOptions& options) {
    std::vector<Fault> faults;
    std::vector<std::filesystem::path> seen;
    for (const std::string* path : {&options.exr_path, &options.png_path, &options.stats_path}) {
        if (path->empty()) continue;
        try {
            refuse_unwritable(*path);
        } catch (const InputError& error) {
            faults.insert(faults.end(), error.faults().begin(), error.faults().end());
        }
        const std::filesystem::path target = output_target(*path);
        if (std::find(seen.begin(), seen.end(), target) != seen.end()) {
            faults.push_back(Fault{*path, 0, 0, "", "is named for two outputs", "give each its own name"});
        }
        seen.push_back(target);
    }
    if (!faults.empty()) throw InputError(std::move(faults));
}

Scene read_scene(const RenderOptions& options) {
    Scene scene = options.scene.read();
    if (options.samples_per_pixel) {
        scene.sample_count = *options.samples_per_pixel;
    } else if (options.target_error > 0.0 || options.time_limit > 0.0) {
        scene.sample_count = most_samples;
    }
    if (options.max_depth) scene.integrator.max_depth = *options.max_depth;
    if (options.seed) scene.seed = *options.seed;
    if (const auto window = parse_window(options.crop)) set_crop_window(scene.film, *window);
    return scene;
}

void write_outputs(const RenderOptions& options, const Scene& scene, const Image& image, const RenderReport& report) {
    const PictureNotes notes{scene.name, report.samples_per_pixel, report.stats.samples, report.seed,
                             report.stats.render_seconds};
    replace_file(options.exr_path, encode_exr(image, scene.film, scene.camera, notes));
    if (!options.png_path.empty()) replace_file(options.png_path, encode_png(image));
    if (!options.stats_path.empty()) replace_file(options.stats_path, report_json(report));
}

int nothing_rendered() {
    std::fprintf(stderr, "stopped before the first sample: no picture\n");
    return exit_interrupted;
}

void check_is_of_picture(const SampleName& sample, const Scene& scene, const std::string& option) {
    const auto refuse = [&](const char* message, std::string hint) {
        throw InputError(Fault{.file = "--replay " + option, .element = {}, .message = message, .hint = std::move(hint)});
    };
    const Film& film = scene.film;
    const int column = sample.x - film.crop_x;
    const int row = sample.y - film.crop_y;
    if (column < 0 || row < 0 || column >= film.crop_width || row >= film.crop_height) {
        refuse("the pixel is not one of the picture's", fmt::format("columns are {} to {}, rows {} to {}", film.crop_x, film.crop_x + film.crop_width - 1,
                                                                    film.crop_y, film.crop_y + film.crop_height - 1));
    }
    if (sample.sample >= static_cast<std::uint32_t>(scene.sample_count)) {
        refuse("the sample is not one of the picture's", fmt::format("samples are 0 to {}; --spp says how many a pixel has", scene.sample_count - 1));
    }
}

// Shows one path in place of making a picture.
int show_path(const RenderOptions& options, const Device& device, const Scene& scene, RenderSettings settings) {
    settings.driver = Driver::replay;
    settings.replayed = *parse_sample_name(options.replay);
    check_is_of_picture(settings.replayed, scene, options.replay);
    Renderer renderer(device, scene, settings);
    renderer.render();
    std::printf("%s", replay_text(renderer.stats().replay).c_str());
    return exit_ok;
}

int run(const RenderOptions& options) {
    Stopwatch watch;
    check_outputs(options);
    catch_interrupts();
    const Scene scene = read_scene(options);
    const double parse_seconds = watch.lap();
    if (!options.quiet) {
        print_warnings(scene);
        print_notes(scene);
    }
    if (interrupted()) return nothing_rendered();

    const Device device(DeviceOptions{options.threads, options.device});
    const double device_seconds = watch.lap();
    RenderSettings settings;
    settings.samples_per_pixel = scene.sample_count;
    settings.seed = scene.seed;
    settings.driver = options.driver;
    settings.bvh = options.bvh;
    settings.target_error = options.target_error;
    settings.time_limit = options.time_limit;
    settings.smooth_terminator = options.smooth_terminator;
    if (!options.replay.empty()) return show_path(options, device, scene, settings);
    ProgressDisplay display(options.quiet);
    const Stopwatch building;
    settings.build_progress = [&](double share) {
        display.update_building(share, building.seconds());
        return !interrupted();
    };
    Renderer renderer(device, scene, settings);
    display.finish();
    if (interrupted()) return nothing_rendered();

    if (!options.quiet) {
        const bool open_end = options.target_error > 0.0 || options.time_limit > 0.0;
        std::fprintf(stderr, "rendering %d x %d pixels, %s%d samples each\n", scene.film.crop_width,
                     scene.film.crop_height, open_end ? "at most " : "", scene.sample_count);
    }
    const bool complete = renderer.render([&display](const Progress& progress) {
        display.update(progress);
        return !interrupted();
    });
    display.finish();

    const Image image = renderer.image();
    RenderReport report{options.scene.path, device.info().name, device.info().compute_units, scene.sample_count,
                        scene.seed,         image.width,        image.height,                complete,
                        renderer.stats()};
    report.stats.setup_parts["parse"] = parse_seconds;
    report.stats.setup_parts["device"] = device_seconds;
    write_outputs(options, scene, image, report);

    for (const std::string& warning : {non_finite_warning(report.stats), holes_warning(report)}) {
        if (!warning.empty()) std::fprintf(stderr, "warning: %s\n", warning.c_str());
    }
    if (!options.quiet) {
        if (options.verbose) std::printf("%s", report_table(report).c_str());
        for (const std::string* path : {&options.exr_path, &options.png_path, &options.stats_path}) {
            if (!path->empty()) std::printf("wrote %s\n", output_target(*path).c_str());
        }
        std::printf("%s\n", closing_line(report).c_str());
    }
    return complete ? exit_ok : exit_interrupted;
}

}  // namespace

void add_render_command(CLI::App& program, Chosen& chosen) {
    CLI::App* command = program.add_subcommand("render", "Render a scene to an OpenEXR picture");
    auto options = std::make_shared<RenderOptions>();
    options->scene.add_to(*command);
    // The last of an option given twice counts, so that scripts can put defaults in front of a user's options.
    const auto add = [command](const char* name, auto& value, const char* type, const char* help) {
        return command->add_option(name, value, help)->type_name(type)->take_last();
    };
    add("-o,--output", options->exr_path, "OUT.exr", "Picture to write: linear RGB, OpenEXR");
    add("--png", options->png_path, "OUT.png", "Also write it as 8-bit sRGB, clamped");
    add("--spp", options->samples_per_pixel, "N", "Samples a pixel (default: the scene's)")->check(whole_number(1, 1 << 24));
    add("--target-error", options->target_error, "E",
        "Stop each tile of the picture when its estimated relMSE is below E (--spp is then the most it may take)")
        ->check(CLI::PositiveNumber);
    add("--time-limit", options->time_limit, "S", "Stop after S seconds of rendering (--spp is then the most it may take)")
        ->check(CLI::PositiveNumber);
    add("--seed", options->seed, "N", "Another seed gives other noise (default: the scene's)")
        ->check(whole_number(0, UINT32_MAX));
    add("--threads", options->threads, "N", "Compute threads (default: one a core)")->check(whole_number(1, 1024));
    add("--max-depth", options->max_depth, "N", "Longest path in edges, -1 for no limit (default: the scene's)")
        ->check(whole_number(-1, 1 << 24));
    const auto is_window = [](const std::string& text) -> std::string {
        return parse_window(text) ? "" : "\"" + text + "\" is not of the form X0,Y0,X1,Y1";
    };
    add("--crop", options->crop, "X0,Y0,X1,Y1", "Render this window only, its right and lower edge excluded")
        ->check(CLI::Validator(is_window, ""));
    const auto is_sample = [](const std::string& text) -> std::string {
        return parse_sample_name(text) ? "" : "\"" + text + "\" is not of the form X,Y,S";
    };
    add("--replay", options->replay, "X,Y,S", "Write no picture: show the path of sample S of pixel (X, Y), a line a vertex")
        ->check(CLI::Validator(is_sample, ""));
    add("--stats", options->stats_path, "FILE.json", "Write timings and counts as JSON");
    add("--device", options->device, "TEXT", "Part of the name of the OpenCL device or platform");
    add("--bvh", options->bvh, "fast|best", "How the hierarchy of triangles is built (default: best up to 400,000 triangles)")
        ->transform(CLI::CheckedTransformer(bvh_names, CLI::ignore_case));
    add("--driver", options->driver, "NAME", "How stages are run: one-kernel, or staged (a launch each; slower)")
        ->transform(CLI::CheckedTransformer(driver_names, CLI::ignore_case));
    command->add_flag("--smooth-terminator", options->smooth_terminator,
                      "Coarse meshes with smooth normals do not shade themselves in steps (other pictures than Mitsuba's there)");
    command->add_flag("-q,--quiet", options->quiet, "Print nothing but the warnings of a faulty picture, and errors");
    command->add_flag("-v,--verbose", options->verbose, "Print timings and counts as a table");
    command->callback([options, &chosen] {
        if (options->exr_path.empty() && options->replay.empty()) throw CLI::RequiredError("--output");
        chosen = [options] {
            try {
                return run(*options);
            } catch (const BuildStopped&) {
                return nothing_rendered();
            }
        };
    });
}

}  // namespace wavelobe
