// Lights as the kernels see them.
#pragma once

#include "render/flatten_materials.h"
#include "tables/light_tree.h"

namespace wavelobe {

Affine affine(const glm::mat4& m);

// SHAPE_x bits of a shape that emits.
inline std::uint32_t emitter_flags(const AreaEmitter& emitter) {
    std::uint32_t flags = SHAPE_EMITS;
    if (!emitter.sampled) flags |= SHAPE_UNSAMPLED;
    if (emitter.both_sides) flags |= SHAPE_EMITS_BEHIND;
    if (emitter.colored && !emitter.sampled) flags |= SHAPE_EMITS_COLORED;
    return flags;
}

// Fills lights and the environment of a device scene, and what chooses among them.
class LightFlattener {
public:
    LightFlattener(MaterialFlattener& materials, DeviceScene& out) : materials_(materials), out_(out) {}

    // A light for each triangle, or one for a parallelogram; the triangles are the last of the device scene.
    void add_mesh(const AreaEmitter& emitter, const TriangleMesh& mesh);
    // What shines and is not sampled: a record of radiance behind the lights, for out.shapes[shape].
    void add_unsampled(const AreaEmitter& emitter, std::size_t shape);
    void add_analytic(const AreaEmitter& emitter, LightIndex kind, std::uint32_t analytic, double area,
                      const Bounds& bounds);
    // Those without a shape. Black ones are left out. Throws InputError for a picture build_environment_table refuses.
    void add_emitter(const Emitter& emitter);
    // How lights are sampled and chosen: those with a place by a tree, if there are several. `radius` is that of the scene.
    void finish(double radius);
    // Not at infinity.
    static bool has_place(const Emitter& emitter);
    // How many have one; they come first if add_emitter was called for them first.
    std::uint32_t finite_count() const { return static_cast<std::uint32_t>(bounds_.size()); }
    std::uint32_t count() const { return count_; }
    // By luminance: what lights with a place send out, about, W, and the mean irradiance of those at infinity, W / m^2.
    double placed_flux() const;
    double infinite_irradiance() const { return infinite_irradiance_; }

private:
    // What all triangles of a mesh have in common.
    struct MeshRadiance {
        TexturedRgb value;
        double mean;  // luminance
        const std::vector<glm::vec2>& uvs;
    };
    static const std::vector<glm::vec2>& uvs_of(const AreaEmitter& emitter, const TriangleMesh& mesh);
    void add_planar(const TriangleMesh& mesh, LightIndex kind, const MeshRadiance& radiance, const glm::uvec3& t, std::uint32_t number);
    void add_light(const Light& light);
    void add_placed_light(const Light& light, const LightBounds& bounds);
    void set_range(Light& light, float range);
    void build_tree();
    void share_out();
    void widen_triangles(double radius);
    void add(const EnvironmentMap& e);
    void add(const ConstantEmitter& e);
    void add(const PointEmitter& e);
    void add(const SpotEmitter& e);
    void add(const ProjectorEmitter& e);
    void add(const DirectionalEmitter& e);

    MaterialFlattener& materials_;
    DeviceScene& out_;
    std::uint32_t count_ = 0;
    double infinite_irradiance_ = 0.0;
    std::vector<LightBounds> bounds_;  // of the lights with a place
    std::vector<std::pair<std::size_t, TexturedRgb>> unsampled_;  // shapes and their radiance
};

}  // namespace wavelobe
