// One block, its queues filled by hand, and the stages of a scene's program run on it one at a time.
#pragma once

#include <cstring>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "cl/program.h"
#include "render/device_buffers.h"
#include "render/features.h"
#include "render/flatten.h"
#include "shared/block.h"
#include "support/probe.h"
#include "support/scenes.h"

namespace wavelobe::test {

// A path in a queue (kernels/core/block.h). `pdf` is negative for paths that the camera or a delta lobe sent.
struct TestPath {
    float t = std::numeric_limits<float>::infinity();
    std::uint32_t hit = HIT_NONE;
    float u = 0.0F;
    float v = 0.0F;
    glm::vec3 direction{0, 0, 1};
    glm::vec3 throughput{1};
    float pdf = -1.0F;
    std::uint32_t id = 0;
    std::uint32_t depth = 0;
    float eta = 1.0F;     // only in scenes with transmission
    std::uint32_t receiver = 0xffffffffU;  // only in scenes with a light tree; by itself: both sides
    glm::vec3 origin{0};  // traced paths keep it only in scenes with analytic shapes
    std::uint32_t instance = INSTANCE_NONE;  // only in scenes with instances
};

struct TestShadowRay {
    float t = std::numeric_limits<float>::infinity();
    glm::vec3 direction{0, 0, 1};
    glm::vec3 contribution{1};
    std::uint32_t id = 0;
    glm::vec3 origin{0};
    std::uint32_t from = HIT_NONE;
    std::uint32_t to = HIT_NONE;  // only in scenes with facets
};

class StageBench {
public:
    // `few`: rays are tested against all triangles, without the hierarchy.
    // `extra`: kernels of the test's own, after those of the program.
    explicit StageBench(const Scene& scene, int lanes = 16, int slots = 64, bool few = false,
                        const std::string& extra = {})
        : scene_(flatten_scene(scene)), buffers_(device()) {
        const Bvh bvh = build_scene_bvh(scene_, 1);
        for (const TriangleBlock& block : bvh.blocks) {
            for (const std::uint32_t primitive : block.primitive) primitives_.push_back(primitive & ~PRIMITIVE_MASKED);
        }
        const FewTriangleSet set = few ? find_few_triangles(bvh, scene_.analytic_bounds) : FewTriangleSet{};
        scene_.features.few_triangles = few;
        scene_.parameters.few = set.summary;
        buffers_.upload(scene_, bvh, set);
        buffers_.add_blocks(1, block_words(scene_.features, slots));
        program_.emplace(device(), program_source(scene_.features, lanes, slots) + layout_source + extra, "stage.cl");
        read_layout();
        header().path_count = TILE_PIXELS;
        header().next_path = TILE_PIXELS;
        header().nonfinite_path = WAVELOBE_NONE;
    }

    // `more`: buffers beside those of the scene, for kernels of the test's own.
    void run(const char* stage, const BufferTable& more = {}) {
        BufferTable table = buffers_.table();
        table.insert(more.begin(), more.end());
        Kernel kernel(*program_, stage);
        kernel.bind(table);
        kernel.launch(device(), 1);
        device().finish();
    }

    BlockHeader& header() { return buffers_.view<BlockHeader>("headers")[0]; }
    RenderParameters& parameters() { return buffers_.view<RenderParameters>("parameters")[0]; }
    std::span<FilmPixel> film() { return buffers_.view<FilmPixel>("film"); }
    const DeviceScene& scene() const { return scene_; }

    // What a hit of a triangle names; triangles are numbered over all meshes in order.
    std::uint32_t slot_of(std::uint32_t triangle) const {
        for (std::uint32_t slot = 0; slot < primitives_.size(); ++slot) {
            if (primitives_[slot] == triangle) return slot;
        }
        return HIT_NONE;
    }

    void fill(std::uint32_t queue, const std::vector<TestPath>& paths) {
        for (std::uint32_t i = 0; i < paths.size(); ++i) put(queue, i, paths[i]);
        header().count[queue] = static_cast<std::uint32_t>(paths.size());
    }

    void put(std::uint32_t queue, std::uint32_t slot, const TestPath& p) {
        set(queue, layout_[path_t], slot, p.t);
        set_bits(queue, layout_[path_hit], slot, p.hit);
        set(queue, layout_[path_u], slot, p.u);
        set(queue, layout_[path_v], slot, p.v);
        set_vector(queue, layout_[path_direction], slot, p.direction);
        set_vector(queue, layout_[path_throughput], slot, p.throughput);
        set(queue, layout_[path_pdf], slot, p.pdf);
        set_bits(queue, layout_[path_id], slot, p.id);
        set_bits(queue, layout_[path_depth], slot, p.depth);
        set(queue, layout_[path_eta], slot, p.eta);
        if (scene_.features.light_tree()) set_bits(queue, layout_[path_receiver], slot, p.receiver);
        if (keeps_origin(queue)) set_vector(queue, layout_[path_origin], slot, p.origin);
        if (scene_.features.instances) set_bits(queue, layout_[path_instance], slot, p.instance);
    }

    TestPath path(std::uint32_t queue, std::uint32_t slot) {
        return {get(queue, layout_[path_t], slot),
                get_bits(queue, layout_[path_hit], slot),
                get(queue, layout_[path_u], slot),
                get(queue, layout_[path_v], slot),
                get_vector(queue, layout_[path_direction], slot),
                get_vector(queue, layout_[path_throughput], slot),
                get(queue, layout_[path_pdf], slot),
                get_bits(queue, layout_[path_id], slot),
                get_bits(queue, layout_[path_depth], slot),
                get(queue, layout_[path_eta], slot),
                scene_.features.light_tree() ? get_bits(queue, layout_[path_receiver], slot) : 0U,
                keeps_origin(queue) ? get_vector(queue, layout_[path_origin], slot) : glm::vec3{0},
                scene_.features.instances ? get_bits(queue, layout_[path_instance], slot) : INSTANCE_NONE};
    }

    void fill_shadows(const std::vector<TestShadowRay>& rays) {
        for (std::uint32_t i = 0; i < rays.size(); ++i) {
            set(QUEUE_SHADOW, layout_[shadow_t], i, rays[i].t);
            set_vector(QUEUE_SHADOW, layout_[shadow_direction], i, rays[i].direction);
            set_vector(QUEUE_SHADOW, layout_[shadow_contribution], i, rays[i].contribution);
            set_bits(QUEUE_SHADOW, layout_[shadow_id], i, rays[i].id);
            set_vector(QUEUE_SHADOW, layout_[shadow_origin], i, rays[i].origin);
            set_bits(QUEUE_SHADOW, layout_[shadow_from], i, rays[i].from);
            if (scene_.features.facets()) set_bits(QUEUE_SHADOW, layout_[shadow_to], i, rays[i].to);
        }
        header().count[QUEUE_SHADOW] = static_cast<std::uint32_t>(rays.size());
    }

    TestShadowRay shadow(std::uint32_t slot) {
        return {get(QUEUE_SHADOW, layout_[shadow_t], slot), get_vector(QUEUE_SHADOW, layout_[shadow_direction], slot),
                get_vector(QUEUE_SHADOW, layout_[shadow_contribution], slot),
                get_bits(QUEUE_SHADOW, layout_[shadow_id], slot),
                get_vector(QUEUE_SHADOW, layout_[shadow_origin], slot),
                get_bits(QUEUE_SHADOW, layout_[shadow_from], slot),
                scene_.features.facets() ? get_bits(QUEUE_SHADOW, layout_[shadow_to], slot) : HIT_NONE};
    }

    std::vector<std::uint32_t> ids(std::uint32_t queue) {
        std::vector<std::uint32_t> out;
        for (std::uint32_t i = 0; i < header().count[queue]; ++i) out.push_back(path(queue, i).id);
        return out;
    }

    // Radiance that a path has gathered.
    float& radiance(std::uint32_t id, std::uint32_t channel) {
        return memory()[layout_[radiance_offset] + 3 * id + channel];
    }
    glm::vec3 radiance(std::uint32_t id) { return {radiance(id, 0), radiance(id, 1), radiance(id, 2)}; }

private:
    enum LayoutEntry : std::size_t {
        first_offset = 0,
        radiance_offset = QUEUE_COUNT,
        queue_stride,
        path_t,
        path_hit,
        path_u,
        path_v,
        path_direction,
        path_throughput,
        path_pdf,
        path_id,
        path_depth,
        path_eta,
        path_receiver,
        path_origin,
        path_instance,
        shadow_t,
        shadow_direction,
        shadow_contribution,
        shadow_id,
        shadow_origin,
        shadow_from,
        shadow_to,
        layout_size
    };
    static constexpr const char* layout_source = R"(
kernel void block_layout(global uint *out) {
    const uint layout[] = {RAYS_OFFSET, ESCAPED_OFFSET, EMITTED_OFFSET, DELTA_OFFSET, GLOSSY_OFFSET, DIFFUSE_OFFSET,
                           SHADOW_OFFSET, RADIANCE_OFFSET, QUEUE_STRIDE, PATH_T, PATH_HIT, PATH_U, PATH_V,
                           PATH_DIRECTION, PATH_THROUGHPUT, PATH_PDF, PATH_ID, PATH_DEPTH, PATH_ETA, PATH_RECEIVER, PATH_ORIGIN,
                           PATH_INSTANCE, SHADOW_T, SHADOW_DIRECTION, SHADOW_CONTRIBUTION, SHADOW_ID, SHADOW_ORIGIN, SHADOW_FROM, SHADOW_TO};
    for (uint i = 0u; i < sizeof layout / sizeof layout[0]; i++) out[i] = layout[i];
}
)";

    void read_layout() {
        const Buffer buffer(device(), layout_size * sizeof(std::uint32_t));
        Kernel kernel(*program_, "block_layout");
        kernel.set(0, buffer.memory());
        kernel.launch(device(), 1);
        device().finish();
        const auto view = buffer.view<std::uint32_t>();
        layout_.assign(view.begin(), view.end());
    }

    bool keeps_origin(std::uint32_t queue) const { return queue == QUEUE_RAYS || scene_.features.analytic; }
    std::span<float> memory() { return buffers_.view<float>("blocks"); }
    float& at(std::uint32_t queue, std::uint32_t field, std::uint32_t slot) {
        return memory()[layout_[first_offset + queue] + field * layout_[queue_stride] + slot];
    }

    void set(std::uint32_t queue, std::uint32_t field, std::uint32_t slot, float value) {
        at(queue, field, slot) = value;
    }
    void set_bits(std::uint32_t queue, std::uint32_t field, std::uint32_t slot, std::uint32_t bits) {
        std::memcpy(&at(queue, field, slot), &bits, sizeof bits);
    }
    void set_vector(std::uint32_t queue, std::uint32_t field, std::uint32_t slot, const glm::vec3& v) {
        for (std::uint32_t k = 0; k < 3; ++k) set(queue, field + k, slot, v[static_cast<glm::length_t>(k)]);
    }
    float get(std::uint32_t queue, std::uint32_t field, std::uint32_t slot) { return at(queue, field, slot); }
    std::uint32_t get_bits(std::uint32_t queue, std::uint32_t field, std::uint32_t slot) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &at(queue, field, slot), sizeof bits);
        return bits;
    }
    glm::vec3 get_vector(std::uint32_t queue, std::uint32_t field, std::uint32_t slot) {
        return {get(queue, field, slot), get(queue, field + 1, slot), get(queue, field + 2, slot)};
    }

    DeviceScene scene_;
    DeviceBuffers buffers_;
    std::vector<std::uint32_t> primitives_;
    std::optional<Program> program_;
    std::vector<std::uint32_t> layout_;
};

// A stage makes some tens of roundings.
constexpr double stage_rounding = 50 * 0x1p-24;

inline void expect_close(const glm::vec3& found, const glm::dvec3& expected, double relative = stage_rounding) {
    for (glm::length_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[c], expected[c], relative * glm::length(expected)) << "component " << c;
    }
}

// Tests that run at each width of the stage bodies.
class StageTest : public testing::TestWithParam<int> {};

}  // namespace wavelobe::test

#define WAVELOBE_AT_EACH_WIDTH(Suite) \
    INSTANTIATE_TEST_SUITE_P(Lanes, Suite, testing::Values(1, 8, 16), testing::PrintToStringParamName())
