// Turns the neutral scene into the arrays that kernels read.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/bvh.h"
#include "render/features.h"
#include "scene/scene.h"
#include "shared/caustics.h"
#include "shared/lights.h"
#include "shared/media.h"
#include "shared/scene.h"

namespace wavelobe {

inline Packed3 packed(const glm::vec3& v) { return {v.x, v.y, v.z}; }
inline glm::vec3 vector_of(const Packed3& p) { return {p.x, p.y, p.z}; }

// Device structs share names with the neutral ones; here they carry a prefix.
using DeviceMaterial = ::Material;
using DeviceNesting = ::Nesting;
using DeviceTexture = ::Texture;
using DeviceShape = ::Shape;
using DeviceOpacity = ::Opacity;
using DeviceInstance = ::Instance;
using DeviceMedium = ::Medium;

// What a hierarchy is built over: consecutive triangles and analytic shapes.
struct GeometryRange {
    std::size_t first_triangle = 0;
    std::size_t triangle_count = 0;
    std::size_t first_analytic = 0;
    std::size_t analytic_count = 0;
};

struct DeviceScene {
    FeatureSet features;
    RenderParameters parameters{};

    // surfaces
    std::vector<TriangleVertices> triangles;  // for the hierarchy; released once it is built
    std::vector<Bounds> analytic_bounds;
    GeometryRange world;                // what is not in a group
    std::vector<GeometryRange> groups;  // those with instances
    std::vector<DeviceInstance> instances;  // `root` is the group's number until the hierarchies are built
    std::vector<Bounds> instance_bounds;
    std::vector<std::uint32_t> primitive_shapes;
    std::vector<DeviceShape> shapes;
    std::vector<float> normals;
    std::vector<float> uvs;
    std::vector<float> colors;
    std::vector<Analytic> analytics;

    // appearance
    std::vector<DeviceMaterial> materials;
    std::vector<DeviceOpacity> opacities;  // one a shape, or none at all
    std::vector<DeviceTexture> textures;
    std::vector<float> texels;

    // media; both empty where nothing absorbs
    std::vector<DeviceMedium> media;      // vacuum first
    std::vector<ShapeMedia> shape_media;  // one a shape

    // light
    std::vector<Light> lights;      // with a tree: those with a place first
    std::vector<LightNode> light_tree;  // none if one light, or none with a place, is all there is
    std::vector<Environment> environment;  // none or one
    std::vector<float> environment_texels;
    std::vector<float> environment_sums;
    std::vector<float> environment_density;

    std::vector<float> filter_table;

    // caustics; no targets where nothing makes any
    std::vector<CausticTarget> caustic_targets;
    CausticGrid caustic_grid{};

    // picture
    std::vector<PictureChannel> channels;
    bool radiance = true;
    std::vector<const Shape*> shape_sources;   // of the scene, each device shape's
    std::vector<std::uint32_t> layer_shapes;   // the number layers give each device shape
};

// Only what a surface or light uses gets into the arrays and the feature set.
// Throws InputError where a scene cannot be represented.
DeviceScene flatten_scene(const Scene& scene, Estimator estimator = Estimator::mis);

}  // namespace wavelobe
