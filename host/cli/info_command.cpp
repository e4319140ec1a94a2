#include <array>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/format.h"
#include "render/render.h"

namespace wavelobe {
namespace {

// In the order of the variants of MaterialModel and Emitter.
constexpr std::array material_names{"diffuse",       "conductor",       "roughconductor", "dielectric",
                                    "thindielectric", "roughdielectric", "plastic",        "roughplastic",   "phong",
                                    "metallicroughness", "normalmap", "bumpmap", "twosided", "blendbsdf",
                                    "principled", "principledthin", "ward"};
static_assert(material_names.size() == std::variant_size_v<MaterialModel>);
constexpr std::array emitter_names{"constant", "envmap", "point", "spot", "directional", "projector"};
static_assert(emitter_names.size() == std::variant_size_v<Emitter>);

const char* filter_name(ReconstructionFilter::Kind kind) {
    switch (kind) {
        case ReconstructionFilter::Kind::box: return "box";
        case ReconstructionFilter::Kind::tent: return "tent";
        case ReconstructionFilter::Kind::gaussian: return "gaussian";
        case ReconstructionFilter::Kind::mitchell: return "mitchell";
        case ReconstructionFilter::Kind::lanczos: return "lanczos";
    }
    return "";
}

// `3 diffuse, 1 phong`
std::string format_kinds(const std::map<std::string, int>& kinds) {
    std::string text;
    for (const auto& [name, count] : kinds) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
    return text.empty() ? "none" : text;
}

std::string describe(const Film& film) {
    std::string text = fmt::format("{} x {} pixels, {} filter", film.width, film.height, filter_name(film.filter.kind));
    if (film.crop_width != film.width || film.crop_height != film.height) {
        text += fmt::format(", crop {} x {} at ({}, {})", film.crop_width, film.crop_height, film.crop_x, film.crop_y);
    }
    return text;
}

std::string describe(const Camera& camera) {
    const glm::vec4 position = camera.to_world[3];
    const std::string at = fmt::format("at ({:.4g}, {:.4g}, {:.4g})", position.x, position.y, position.z);
    if (camera.projection == Camera::Projection::orthographic)
        return fmt::format("orthographic, {:.4g} across, {}", 2.0F * glm::length(glm::vec3(camera.to_world[0])), at);
    std::string text = fmt::format("perspective, {:.4g} degrees across, {}", camera.fov_x_degrees, at);
    if (camera.aperture_radius > 0.0F)
        text += fmt::format(", lens of radius {:.4g} focused at {:.4g}", camera.aperture_radius, camera.focus_distance);
    return text;
}

std::string describe(const Integrator& integrator) {
    const std::string depth = integrator.max_depth < 0 ? "no limit" : fmt::format("{}", integrator.max_depth);
    return fmt::format("path depth {}, Russian roulette from {}{}", depth, integrator.rr_depth,
                       integrator.hide_emitters ? ", emitters hidden" : "");
}

int run(const SceneArguments& arguments, bool program) {
    const Scene scene = arguments.read();
    if (program) {
        fmt::print("{}", scene_program(scene));
        return exit_ok;
    }
    print_warnings(scene);
    print_notes(scene);
    const SceneSummary summary = summarize(scene);
    std::map<std::string, int> materials;
    for (const Material& material : scene.materials) ++materials[material_names[material.model.index()]];
    std::map<std::string, int> emitters;
    for (const Shape& shape : scene.shapes) {
        if (shape.emitter) ++emitters["area"];
    }
    for (const Emitter& emitter : scene.emitters) ++emitters[emitter_names[emitter.index()]];

    fmt::print("scene       {}\n", arguments.path);
    fmt::print("film        {}\n", describe(scene.film));
    fmt::print("camera      {}\n", describe(scene.camera));
    fmt::print("integrator  {}, {} samples a pixel\n", describe(scene.integrator), scene.sample_count);
    fmt::print("shapes      {}: {} triangles, {} spheres, disks and cylinders\n", scene.shapes.size(),
               format_count(summary.triangles), format_count(summary.analytic_shapes));
    fmt::print("materials   {}\n", format_kinds(materials));
    fmt::print("emitters    {}; lights to sample {}\n", format_kinds(emitters), format_count(summary.lights));
    fmt::print("features    {}\n", fmt::join(summary.features, " "));
    fmt::print("memory      about {} at most once kernels are compiled, {} of them their buffers\n", format_bytes(summary.peak_bytes),
               format_bytes(summary.device_bytes));
    return exit_ok;
}

}  // namespace

void add_info_command(CLI::App& program, Chosen& chosen) {
    CLI::App* command = program.add_subcommand("info", "Say what a scene holds and needs, without rendering");
    auto arguments = std::make_shared<SceneArguments>();
    arguments->add_to(*command);
    auto source = std::make_shared<bool>(false);
    command->add_flag("--program", *source, "Print the scene's OpenCL program instead, as one source");
    command->callback([arguments, source, &chosen] { chosen = [arguments, source] { return run(*arguments, *source); }; });
}

}  // namespace wavelobe
