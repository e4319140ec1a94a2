// Materials and textures as the kernels see them.
#pragma once

#include <cstring>
#include <map>

#include "render/flatten.h"

namespace wavelobe {

// Fills materials, textures and texels of a device scene, each the first time it is asked for, so that what nothing uses
// takes no memory and adds no feature.
class MaterialFlattener {
public:
    MaterialFlattener(const Scene& scene, DeviceScene& out) : scene_(scene), out_(out) {}

    // Index of the device material, or WAVELOBE_NONE for index -1.
    std::uint32_t add(int material);
    std::uint32_t add(const Material* material);
    std::uint32_t lobes(std::uint32_t device_material) const;

    TexturedRgb rgb(const Parameter& parameter);
    DeviceOpacity opacity(const Opacity& opacity);

private:
    TexturedFloat scalar(const Parameter& parameter);
    std::uint32_t texture(const std::shared_ptr<const Texture>& texture, int channel);
    std::uint32_t first_texel(const Texture& texture);
    void fill(DeviceMaterial& out, const Diffuse& m);
    void fill(DeviceMaterial& out, const Conductor& m);
    void fill(DeviceMaterial& out, const RoughConductor& m);
    void fill(DeviceMaterial& out, const Dielectric& m);
    void fill(DeviceMaterial& out, const ThinDielectric& m);
    void fill(DeviceMaterial& out, const RoughDielectric& m);
    void fill(DeviceMaterial& out, const Plastic& m);
    void fill(DeviceMaterial& out, const RoughPlastic& m);
    void fill(DeviceMaterial& out, const Phong& m);
    void fill(DeviceMaterial& out, const MetallicRoughness& m);
    void fill(DeviceMaterial& out, const Principled& m);  // these two in flatten_principled.cpp
    void fill(DeviceMaterial& out, const PrincipledThin& m);
    void fill(DeviceMaterial& out, const Ward& m);
    PrincipledParameters principled_parameters(DeviceMaterial& out, const PrincipledSurface& surface);
    // Materials that hold others.
    void fill(DeviceNesting& out, const NormalMapped& m);
    void fill(DeviceNesting& out, const BumpMapped& m);
    void fill(DeviceNesting& out, const TwoSided& m);
    void fill(DeviceNesting& out, const Blend& m);
    void nest(DeviceNesting& out, std::uint32_t kind, const NestedMaterial& first, const NestedMaterial& second);
    int levels_of(const DeviceNesting& nesting) const;
    // What all dielectrics share.
    template <class Model>
    void fill_interface(DeviceMaterial& out, const Model& m);
    void fill_roughness(DeviceMaterial& out, const Parameter& alpha_u, const Parameter& alpha_v, Distribution distribution);

    // Its record (DeviceMaterial::extension).
    template <class Extension>
    std::uint32_t add_extension(const Extension& extension) {
        const std::size_t first = out_.materials.size();
        out_.materials.resize(first + (sizeof(Extension) + sizeof(DeviceMaterial) - 1) / sizeof(DeviceMaterial));
        std::memcpy(static_cast<void*>(&out_.materials[first]), &extension, sizeof(Extension));
        return static_cast<std::uint32_t>(first);
    }

    const Scene& scene_;
    DeviceScene& out_;
    std::map<const Material*, std::uint32_t> materials_;
    std::map<std::uint32_t, int> levels_;  // of materials that hold others
    std::map<std::pair<const Texture*, int>, std::uint32_t> textures_;
    std::map<const Texture*, std::uint32_t> texels_;
    std::uint32_t sheen_albedo_ = WAVELOBE_NONE;  // record of the table, once a material needs it
};

}  // namespace wavelobe
