#include "tables/light_power.h"

#include <cmath>
#include <numbers>

#include "tables/environment_table.h"

namespace wavelobe {
namespace {

using std::numbers::pi;

double mean_luminance(const Bitmap& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        sum += luminance({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    }
    return image.rgb.empty() ? 0.0 : sum / (static_cast<double>(image.rgb.size()) / 3.0);
}

double mean_luminance(const Checkerboard& checkerboard) {
    return 0.5 * (luminance(checkerboard.color0) + luminance(checkerboard.color1));
}

// Integral over directions of the share of the axial intensity: one within the beam, then linear in the angle down to
// zero at the cutoff; sr.
double spot_solid_angle(double beam, double cutoff) {
    if (cutoff <= beam) return 2.0 * pi * (1.0 - std::cos(cutoff));
    return 2.0 * pi * (1.0 - (std::sin(cutoff) - std::sin(beam)) / (cutoff - beam));
}

// The same with the smooth fall of glTF: the square of a ramp over the cosine.
double smooth_spot_solid_angle(double beam, double cutoff) {
    return 2.0 * pi * (1.0 - std::cos(beam) + (std::cos(beam) - std::cos(cutoff)) / 3.0);
}

// Flux through the disk that the scene's bounding sphere casts on a plane, for an irradiance of one.
double disk_area(double scene_radius) { return pi * scene_radius * scene_radius; }

struct Power {
    double scene_radius;

    double operator()(const ConstantEmitter& e) const {
        return environment_power(4.0 * pi * luminance(e.radiance), scene_radius);
    }
    double operator()(const EnvironmentMap& e) const {
        const EnvironmentTable table = build_environment_table(with_three_rows(e.image));
        return environment_power(static_cast<double>(e.scale) * table.luminance_integral, scene_radius);
    }
    double operator()(const PointEmitter& e) const { return 4.0 * pi * luminance(e.intensity); }
    double operator()(const SpotEmitter& e) const {
        const double beam = glm::radians(static_cast<double>(e.beam_width_degrees));
        const double cutoff = glm::radians(static_cast<double>(e.cutoff_degrees));
        const double share = e.texture == nullptr ? 1.0 : mean_luminance(Parameter{Rgb{1.0F}, e.texture});
        return share * luminance(e.intensity) * (e.smooth ? smooth_spot_solid_angle(beam, cutoff) : spot_solid_angle(beam, cutoff));
    }
    // As much as a plane at distance 1 receives.
    double operator()(const ProjectorEmitter& e) const {
        const double half_width = std::tan(0.5 * static_cast<double>(e.fov_x_degrees) * pi / 180.0);
        const double area = 4.0 * half_width * half_width / static_cast<double>(e.aspect);
        return pi * area * static_cast<double>(e.scale) * mean_luminance(e.irradiance);
    }
    double operator()(const DirectionalEmitter& e) const { return luminance(e.irradiance) * disk_area(scene_radius); }
};

}  // namespace

double luminance(const Rgb& color) {
    return 0.212671 * static_cast<double>(color.r) + 0.715160 * static_cast<double>(color.g) +
           0.072169 * static_cast<double>(color.b);
}

double mean_luminance(const Parameter& radiance) {
    if (!radiance.texture) return luminance(radiance.value);
    return std::visit([](const auto& source) { return mean_luminance(source); }, radiance.texture->source);
}

double environment_power(double luminance_integral, double scene_radius) {
    return luminance_integral * disk_area(scene_radius);
}

double emitter_power(const Emitter& emitter, double scene_radius) { return std::visit(Power{scene_radius}, emitter); }

}  // namespace wavelobe
