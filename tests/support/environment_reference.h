// An environment picture in double precision, as lights/envmap.h defines it.
#pragma once

#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "support/analytic_shapes.h"
#include "support/light_probe.h"
#include "tables/environment_table.h"

namespace wavelobe::test {

struct EnvironmentReference {
    Bitmap image;
    glm::dmat3 to_world{1.0};  // a rotation

    struct Place {
        double u, v;  // over [0, 1]
    };

    Place place(const glm::dvec3& world) const {
        const glm::dvec3 d = glm::transpose(to_world) * world;
        const double turns = std::atan2(d.x, -d.z) / (2.0 * std::numbers::pi);
        return {turns - std::floor(turns), std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi};
    }

    glm::dvec3 texel(int column, int row) const {
        const int x = (column % image.width + image.width) % image.width;
        const float* rgb = &image.rgb[3 * static_cast<std::size_t>(row * image.width + x)];
        return {rgb[0], rgb[1], rgb[2]};
    }

    glm::dvec3 radiance(Place p) const {
        const double x = p.u * image.width - 0.5;
        const double y = p.v * (image.height - 1);
        const int column = static_cast<int>(std::floor(x));
        const int row = std::min(static_cast<int>(std::floor(y)), image.height - 2);
        const double s = x - column;
        const double t = y - row;
        return (1.0 - t) * ((1.0 - s) * texel(column, row) + s * texel(column + 1, row)) +
               t * ((1.0 - s) * texel(column, row + 1) + s * texel(column + 1, row + 1));
    }

    glm::dvec3 direction(Place p) const {
        const double theta = p.v * std::numbers::pi;
        const double phi = p.u * 2.0 * std::numbers::pi;
        return to_world *
               glm::dvec3(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta));
    }

    // Integral over all directions of radiance times `weight`: midpoint rule on each cell, whose borders are kinks.
    template <class Weight>
    glm::dvec3 integral(const Weight& weight, int steps = 64) const {
        glm::dvec3 sum(0.0);
        const double column_step = 1.0 / (image.width * steps);
        const double row_step = 1.0 / ((image.height - 1) * steps);
        for (int i = 0; i < image.width * steps; ++i) {
            for (int j = 0; j < (image.height - 1) * steps; ++j) {
                const Place p{(i + 0.5) * column_step + 0.5 / image.width, (j + 0.5) * row_step};
                const Place wrapped{p.u - std::floor(p.u), p.v};
                const double measure = 2.0 * std::numbers::pi * std::numbers::pi * std::sin(p.v * std::numbers::pi);
                sum += radiance(wrapped) * (weight(direction(p)) * measure * column_step * row_step);
            }
        }
        return sum;
    }
};

// Puts the picture and its tables into the buffers.
inline void set_environment(LightBuffers& buffers, const EnvironmentReference& reference, const glm::vec3& scale) {
    const EnvironmentTable table = build_environment_table(reference.image);
    Environment& e = buffers.environment[0];
    e.to_world = affine_of(glm::dmat4(reference.to_world));
    e.to_object = affine_of(glm::dmat4(glm::transpose(reference.to_world)));
    e.width = static_cast<Uint32>(reference.image.width);
    e.height = static_cast<Uint32>(reference.image.height);
    e.cell_columns = table.cell_columns;
    e.cell_rows = table.cell_rows;
    e.radiance = {scale.r, scale.g, scale.b};
    buffers.texels = reference.image.rgb;
    buffers.sums = table.sums;
    buffers.density = table.density;
}

}  // namespace wavelobe::test
