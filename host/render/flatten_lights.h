// Lights as the kernels see them.
#pragma once

#include "render/flatten_materials.h"

namespace wavelobe {

Affine affine(const glm::mat4& m);

// Fills lights and the environment of a device scene, and the table that chooses among them.
class LightFlattener {
public:
    LightFlattener(MaterialFlattener& materials, DeviceScene& out) : materials_(materials), out_(out) {}

    // A light for each triangle, or one for a parallelogram.
    void add_mesh(const AreaEmitter& emitter, const TriangleMesh& mesh);
    void add_analytic(const AreaEmitter& emitter, LightIndex kind, std::uint32_t analytic, double area);
    // Those without a shape; `radius` is that of the scene's bounding sphere. Black ones are left out.
    void add_emitter(const Emitter& emitter, double radius);
    // Probabilities and the alias table, by power; alike if no light has any.
    void finish();

private:
    void add_planar(const AreaEmitter& emitter, const TriangleMesh& mesh, LightIndex kind, const TexturedRgb& radiance,
                    const glm::uvec3& t);
    void add_light(const Light& light, double power);
    void add_environment_map(const EnvironmentMap& e, double radius);
    void add(const ConstantEmitter& e, double power);
    void add(const PointEmitter& e, double power);
    void add(const SpotEmitter& e, double power);
    void add(const DirectionalEmitter& e, double power);

    MaterialFlattener& materials_;
    DeviceScene& out_;
    std::vector<double> powers_;
};

}  // namespace wavelobe
