#include "render/device_buffers.h"

#include "render/flatten_caustics.h"
#include "shared/block.h"

namespace wavelobe {
namespace {

// Spatial splits and their time pay on scenes of this size; larger ones are built the fast way.
constexpr std::size_t best_quality_triangles = 400000;

// Marks the primitives whose opacity rays ask for.
void mark_masked(Bvh& bvh, const DeviceScene& scene) {
    const auto mark = [&scene](std::uint32_t& entry, std::size_t primitive) {
        if (entry == HIT_NONE) return;  // no triangle: a block has room for more than it holds
        const DeviceShape& shape = scene.shapes[scene.primitive_shapes[primitive]];
        if ((shape.flags & SHAPE_MASKED) != 0) entry |= PRIMITIVE_MASKED;
    };
    for (TriangleBlock& block : bvh.blocks) {
        for (std::uint32_t& primitive : block.primitive) {
            if (primitive != HIT_NONE) mark(primitive, primitive);
        }
    }
    for (std::uint32_t& entry : bvh.analytic_order) mark(entry, scene.triangles.size() + entry);
}

FewSlot few_slot(const DeviceScene& scene, const TriangleBlock& block, std::size_t column) {
    FewSlot slot{};
    for (std::size_t row = 0; row < std::size(slot.corners); ++row) slot.corners[row] = block.vertex[row][column];
    const auto corner = [&](int i) { return glm::dvec3(slot.corners[3 * i], slot.corners[3 * i + 1], slot.corners[3 * i + 2]); };
    const glm::dvec3 cross = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    if (const double length = glm::length(cross); length > 0.0) slot.normal = packed(glm::vec3(cross / length));
    slot.primitive = block.primitive[column] & ~PRIMITIVE_MASKED;
    if (slot.primitive >= scene.primitive_shapes.size()) return slot;
    slot.shape = scene.primitive_shapes[slot.primitive];
    slot.front_material = scene.shapes[slot.shape].front_material;
    return slot;
}

}  // namespace

Bvh build_scene_bvh(DeviceScene& scene, int threads, std::optional<BvhQuality> chosen, const BuildProgress& progress) {
    const BvhQuality by_size = scene.triangles.size() <= best_quality_triangles ? BvhQuality::best : BvhQuality::fast;
    const BvhQuality quality = chosen.value_or(by_size);
    const std::span<const TriangleVertices> triangles = scene.triangles;
    const std::span<const Bounds> analytics = scene.analytic_bounds;
    // By triangles; one for each hierarchy, however small.
    const double all = static_cast<double>(triangles.size() + scene.groups.size() + 1);
    double done = 0.0;
    const auto build = [&](const GeometryRange& range, BvhQuality wanted, std::span<const Bounds> instances) {
        const double part = static_cast<double>(range.triangle_count + 1);
        const BuildProgress of_part = [&, before = done](double share) { return !progress || progress((before + part * share) / all); };
        done += part;
        return build_bvh(triangles.subspan(range.first_triangle, range.triangle_count),
                         analytics.subspan(range.first_analytic, range.analytic_count), wanted, threads, instances, of_part);
    };
    // Splits of instances would only multiply them.
    Bvh bvh = build(scene.world, scene.instances.empty() ? quality : BvhQuality::fast, scene.instance_bounds);
    std::vector<std::uint32_t> roots;
    int depth = 0;
    for (const GeometryRange& group : scene.groups) {
        const Bvh part = build(group, quality, {});
        roots.push_back(append_bvh(bvh, part, static_cast<std::uint32_t>(group.first_triangle),
                                   static_cast<std::uint32_t>(group.first_analytic)));
        depth = std::max(depth, part.depth);
        bvh.build_seconds += part.build_seconds;
    }
    bvh.depth += depth;
    for (DeviceInstance& instance : scene.instances) instance.root = roots[instance.root];
    if (scene.features.masks) mark_masked(bvh, scene);
    // Stages read block 0 in lanes that hit no triangle.
    if (bvh.blocks.empty()) bvh.blocks.emplace_back();
    return bvh;
}

void DeviceBuffers::insert(const std::string& name, Buffer buffer) {
    const auto [entry, added] = buffers_.emplace(name, std::move(buffer));
    if (added) table_[name] = &entry->second;
}

std::uint64_t DeviceBuffers::total_bytes() const {
    std::uint64_t sum = 0;
    for (const auto& [name, buffer] : buffers_) sum += buffer.bytes();
    return sum;
}

void DeviceBuffers::upload(const DeviceScene& scene, const Bvh& bvh, const FewTriangleSet& few) {
    if (scene.features.few_triangles) {
        add_few(scene, bvh, few);
    } else {
        add("bvh_nodes", bvh.nodes);
        add("analytic_order", bvh.analytic_order);
    }
    add("triangle_blocks", bvh.blocks);
    // An empty scene still has kernels that name these.
    add("primitive_shapes", scene.primitive_shapes.empty() ? std::vector<std::uint32_t>(1) : scene.primitive_shapes);
    add("shapes", scene.shapes.empty() ? std::vector<DeviceShape>(1) : scene.shapes);
    add("materials", scene.materials.empty() ? std::vector<DeviceMaterial>(1) : scene.materials);
    add("opacities", scene.opacities);
    add_rows("normals", scene.normals);
    add_rows("uvs", scene.uvs);
    add_rows("colors", scene.colors);
    add("analytics", scene.analytics);
    add("instances", scene.instances);
    add("textures", scene.textures);
    add("texels", scene.texels.empty() && !scene.textures.empty() ? std::vector<float>(1) : scene.texels);
    add("media", scene.media);
    add("shape_media", scene.shape_media.empty() && !scene.media.empty() ? std::vector<ShapeMedia>(1) : scene.shape_media);
    add("lights", scene.lights);
    add("light_tree", scene.light_tree);
    add("environment", scene.environment);
    add("environment_texels", scene.environment_texels);
    add("environment_sums", scene.environment_sums);
    add("environment_density", scene.environment_density);
    add("filter_table", scene.filter_table);
    add("parameters", std::vector<RenderParameters>{scene.parameters});
    const std::size_t pixels = std::size_t{scene.parameters.window_width} * scene.parameters.window_height;
    if (scene.features.caustics) add_caustics(scene);
    add_zeros<FilmPixel>("film", pixels * (scene.features.error_estimate ? 2 : 1));
    if (scene.features.layers != 0) {
        add_zeros<double>("layer_film", pixels * scene.features.layer_channels());
        add("layer_shapes", scene.layer_shapes.empty() ? std::vector<std::uint32_t>(1) : scene.layer_shapes);
    }
    if (scene.features.moments) add_zeros<double>("moment_film", pixels * MOMENT_CHANNELS);
}

void DeviceBuffers::add_rows(const std::string& name, std::span<const float> values) {
    if (values.empty()) return;
    Buffer buffer(device_, (values.size() + ROW_WORDS) * sizeof(float));
    std::ranges::copy(values, buffer.view<float>().begin());
    insert(name, std::move(buffer));
}

void DeviceBuffers::add_few(const DeviceScene& scene, const Bvh& bvh, const FewTriangleSet& few) {
    add("few_vertices", few.vertices);
    add("few_triangles", few.triangles);
    add("few_analytics", few.analytics);
    if (scene.features.facets()) {
        add("few_facets", few.facets);
        add("few_corners", few.corners);
        add("few_numbers", few.numbers);
    }
    std::vector<FewSlot> slots;
    for (std::size_t slot = 0; slot < bvh.blocks.size() * BVH_WIDTH; ++slot) slots.push_back(few_slot(scene, bvh.blocks[slot / BVH_WIDTH], slot % BVH_WIDTH));
    add("few_slots", slots);
}

void DeviceBuffers::add_caustics(const DeviceScene& scene) {
    const std::size_t cells = caustic_cells(scene.caustic_grid);
    add("caustic_targets", scene.caustic_targets);
    add("caustic_grid", std::vector<CausticGrid>{scene.caustic_grid});
    add_zeros<std::uint32_t>("caustic_counts", cells);
    add_zeros<std::uint32_t>("caustic_cells", cells);
    add_zeros<std::uint64_t>("caustic_sums", CAUSTIC_MAPS * CAUSTIC_BINS);
    add_zeros<std::uint64_t>("caustic_squares", CAUSTIC_MAPS);
    add_zeros<float>("caustic_maps", CAUSTIC_MAPS * CAUSTIC_MAP_FLOATS);
}

void DeviceBuffers::add_blocks(std::size_t count, std::size_t words_each) {
    add_zeros<BlockHeader>("headers", count);
    add_zeros<float>("blocks", count * words_each);
}

}  // namespace wavelobe
