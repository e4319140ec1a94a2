#include "accel/bvh.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

namespace wavelobe {
namespace {

constexpr unsigned width = BVH_WIDTH;
// Below this depth Embree stops looking for good splits; real scenes stay under 15 levels of eight.
constexpr unsigned max_depth = 40;

// What Embree's builder makes; lives in its thread-local allocator.
struct BuildNode {
    bool leaf = false;
    unsigned count = 0;
    BuildNode* child[width] = {};
    Bounds bounds[width];
    std::uint32_t primitive[width] = {};  // leaves
};

// Which part of all the work a build is, and whom to tell. Embree's threads report as they go.
class Reports {
public:
    Reports(const BuildProgress& tell, int builds) : tell_(tell), builds_(builds) {}

    void next_build() { ++begun_; }
    bool report(double share) {
        const std::lock_guard lock(mutex_);
        if (!tell_ || stopped_) return !stopped_;
        done_ = std::max(done_, (begun_ - 1 + std::min(share, 1.0)) / builds_);
        stopped_ = !tell_(done_);
        return !stopped_;
    }
    bool stopped() const { return stopped_; }

private:
    const BuildProgress& tell_;
    const int builds_;
    int begun_ = 0;
    double done_ = 0.0;
    bool stopped_ = false;
    std::mutex mutex_;
};

struct Source {
    std::span<const TriangleVertices> triangles;
    std::size_t analytic_count = 0;
    std::span<const Bounds> instance_bounds{};
    Reports* reports = nullptr;
    bool is_triangle(std::uint32_t id) const { return id < triangles.size(); }
    bool is_instance(std::uint32_t id) const { return id >= triangles.size() + analytic_count; }
};

BuildNode* allocate_node(RTCThreadLocalAllocator allocator, unsigned count, bool leaf) {
    auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
    node->leaf = leaf;
    node->count = count;
    return node;
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
    return allocate_node(allocator, count, false);
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<BuildNode*>(node)->child[i] = static_cast<BuildNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        static_cast<BuildNode*>(node)->bounds[i] = {
            {bounds[i]->lower_x, bounds[i]->lower_y, bounds[i]->lower_z},
            {bounds[i]->upper_x, bounds[i]->upper_y, bounds[i]->upper_z}};
    }
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
    BuildNode* leaf = allocate_node(allocator, static_cast<unsigned>(count), true);
    for (std::size_t i = 0; i < count && i < width; ++i) leaf->primitive[i] = primitives[i].primID;
    return leaf;
}

// Bounds of the parts of a triangle on both sides of a plane, within the primitive's present bounds.
void split_primitive(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
                     RTCBounds* right, void* user) {
    const glm::vec3 lower{primitive->lower_x, primitive->lower_y, primitive->lower_z};
    const glm::vec3 upper{primitive->upper_x, primitive->upper_y, primitive->upper_z};
    const auto dimension = static_cast<glm::length_t>(axis);
    Bounds l{lower, upper};
    Bounds r{lower, upper};
    l.upper[dimension] = position;
    r.lower[dimension] = position;
    const Source& source = *static_cast<const Source*>(user);
    if (source.is_triangle(primitive->primID)) {
        Bounds below;
        Bounds above;
        const TriangleVertices& v = source.triangles[primitive->primID];
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::vec3 a = v[i];
            const glm::vec3 b = v[(i + 1) % 3];
            const float pa = a[dimension];
            const float pb = b[dimension];
            if (pa <= position) below.extend(a);
            if (pa >= position) above.extend(a);
            if ((pa < position && pb > position) || (pa > position && pb < position)) {
                const glm::vec3 crossing = a + (b - a) * ((position - pa) / (pb - pa));
                // Six roundings, each half an epsilon, of at most these magnitudes: bounds that are short of them would leave a gap.
                const glm::vec3 margin = 3.0F * std::numeric_limits<float>::epsilon() * (glm::abs(a) + glm::abs(b));
                for (glm::vec3 corner : {crossing - margin, crossing + margin}) {
                    corner[dimension] = position;
                    below.extend(corner);
                    above.extend(corner);
                }
            }
        }
        l = {glm::max(below.lower, l.lower), glm::min(below.upper, l.upper)};
        r = {glm::max(above.lower, r.lower), glm::min(above.upper, r.upper)};
    }
    *left = {l.lower.x, l.lower.y, l.lower.z, 0.0F, l.upper.x, l.upper.y, l.upper.z, 0.0F};
    *right = {r.lower.x, r.lower.y, r.lower.z, 0.0F, r.upper.x, r.upper.y, r.upper.z, 0.0F};
}

// Copies Embree's tree into the layout of the kernels, depth first so that a subtree is contiguous.
class Encoder {
public:
    explicit Encoder(const Source& source) : source_(source) {}
    Bvh take() { return std::move(bvh_); }

    void encode_root(const BuildNode* root) {
        if (root == nullptr) {
            new_node();
        } else if (root->leaf) {
            const auto node = new_node();
            constexpr float far = std::numeric_limits<float>::max();
            encode_child(node, 0, root, {glm::vec3{-far}, glm::vec3{far}}, 1);
        } else {
            encode_node(root, 1);
        }
    }

private:
    std::uint32_t new_node() {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        BvhNode node{};
        for (unsigned i = 0; i < width; ++i) {
            for (unsigned row = 0; row < 6; ++row) node.bounds[row][i] = row % 2 == 0 ? infinity : -infinity;
            node.child[i] = BVH_EMPTY;
        }
        bvh_.nodes.push_back(node);
        return static_cast<std::uint32_t>(bvh_.nodes.size() - 1);
    }

    std::uint32_t encode_node(const BuildNode* source, int level) {
        bvh_.depth = std::max(bvh_.depth, level);
        const std::uint32_t node = new_node();
        for (unsigned i = 0; i < source->count; ++i) encode_child(node, i, source->child[i], source->bounds[i], level);
        return node;
    }

    void encode_child(std::uint32_t node, unsigned i, const BuildNode* child, const Bounds& bounds, int level) {
        const std::uint32_t reference = child->leaf ? encode_leaf(child, bounds, level) : encode_node(child, level + 1);
        set_child(node, i, bounds, reference);
    }

    void set_child(std::uint32_t node, unsigned i, const Bounds& bounds, std::uint32_t reference) {
        BvhNode& n = bvh_.nodes[node];
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            n.bounds[2 * axis][i] = bounds.lower[axis];
            n.bounds[2 * axis + 1][i] = bounds.upper[axis];
        }
        n.child[i] = reference;
    }

    // A leaf holds triangles or analytic shapes. One that got several kinds becomes a node of leaves; so does one of
    // instances, each a leaf of its own.
    std::uint32_t encode_leaf(const BuildNode* leaf, const Bounds& bounds, int level) {
        if (leaf->count > width) throw std::runtime_error("the hierarchy builder made a leaf of " + std::to_string(leaf->count));
        std::vector<std::uint32_t> triangles;
        std::vector<std::uint32_t> analytics;
        std::vector<std::uint32_t> instances;
        for (unsigned i = 0; i < leaf->count; ++i) {
            const std::uint32_t id = leaf->primitive[i];
            (source_.is_triangle(id) ? triangles : source_.is_instance(id) ? instances : analytics).push_back(id);
        }
        if (analytics.empty() && instances.empty()) return add_block(triangles);
        if (triangles.empty() && instances.empty()) return add_analytics(analytics);
        bvh_.depth = std::max(bvh_.depth, level + 1);
        const std::uint32_t node = new_node();
        unsigned next = 0;
        if (!triangles.empty()) set_child(node, next++, bounds, add_block(triangles));
        if (!analytics.empty()) set_child(node, next++, bounds, add_analytics(analytics));
        const std::size_t first = source_.triangles.size() + source_.analytic_count;
        for (const std::uint32_t id : instances) {
            const auto instance = static_cast<std::uint32_t>(id - first);
            set_child(node, next++, source_.instance_bounds[instance], BVH_LEAF | BVH_INSTANCE | instance);
        }
        return node;
    }

    std::uint32_t add_block(std::span<const std::uint32_t> triangles) {
        TriangleBlock block{};
        for (unsigned lane = 0; lane < width; ++lane) {
            block.primitive[lane] = lane < triangles.size() ? triangles[lane] : HIT_NONE;
            if (lane >= triangles.size()) continue;
            for (unsigned vertex = 0; vertex < 3; ++vertex) {
                for (unsigned axis = 0; axis < 3; ++axis) {
                    block.vertex[3 * vertex + axis][lane] =
                        source_.triangles[triangles[lane]][vertex][static_cast<glm::length_t>(axis)];
                }
            }
        }
        bvh_.blocks.push_back(block);
        return BVH_LEAF | static_cast<std::uint32_t>(bvh_.blocks.size() - 1);
    }

    std::uint32_t add_analytics(std::span<const std::uint32_t> ids) {
        const auto first = static_cast<std::uint32_t>(bvh_.analytic_order.size());
        for (const std::uint32_t id : ids) {
            bvh_.analytic_order.push_back(id - static_cast<std::uint32_t>(source_.triangles.size()));
        }
        return BVH_LEAF | BVH_ANALYTIC | (first << 4U) | static_cast<std::uint32_t>(ids.size());
    }

    const Source& source_;
    Bvh bvh_;
};

RTCBuildPrimitive build_primitive(const Bounds& b, std::size_t id) {
    return {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, static_cast<unsigned>(id)};
}

std::vector<RTCBuildPrimitive> build_primitives(const Source& source, std::span<const Bounds> analytic_bounds,
                                                BvhQuality quality) {
    const std::size_t count = source.triangles.size() + analytic_bounds.size() + source.instance_bounds.size();
    // Spatial splits need room for the references they add.
    std::vector<RTCBuildPrimitive> primitives(quality == BvhQuality::split ? 2 * count : count);
    std::size_t next = 0;
    for (const TriangleVertices& v : source.triangles) {
        Bounds b;
        for (const glm::vec3& p : v) b.extend(p);
        primitives[next] = build_primitive(b, next);
        ++next;
    }
    for (const std::span<const Bounds> boxes : {analytic_bounds, source.instance_bounds}) {
        for (const Bounds& b : boxes) {
            primitives[next] = build_primitive(b, next);
            ++next;
        }
    }
    return primitives;
}

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseBvh {
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};

bool report(void* source, double share) { return static_cast<Source*>(source)->reports->report(share); }

Bvh build_once(RTCDevice device, Source& source, std::span<const Bounds> analytic_bounds, BvhQuality quality) {
    const std::unique_ptr<RTCBVHTy, ReleaseBvh> tree(rtcNewBVH(device));
    std::vector<RTCBuildPrimitive> primitives = build_primitives(source, analytic_bounds, quality);

    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof arguments;
    arguments.buildQuality = quality == BvhQuality::split ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = width;
    arguments.maxDepth = max_depth;
    // Full leaves: a block of eight costs the same whether it holds one triangle or eight.
    arguments.sahBlockSize = width;
    arguments.minLeafSize = width;
    arguments.maxLeafSize = width;
    arguments.bvh = tree.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = source.triangles.size() + analytic_bounds.size() + source.instance_bounds.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = split_primitive;
    arguments.buildProgress = report;
    arguments.userPtr = &source;
    source.reports->next_build();
    const auto* root = static_cast<const BuildNode*>(rtcBuildBVH(&arguments));
    if (source.reports->stopped()) throw BuildStopped();
    if (root == nullptr) throw std::runtime_error("Embree's builder could not build the hierarchy");
    Encoder encoder(source);
    encoder.encode_root(root);
    return encoder.take();
}

}  // namespace

Bvh build_bvh(std::span<const TriangleVertices> triangles, std::span<const Bounds> analytic_bounds, BvhQuality quality,
              int threads, std::span<const Bounds> instance_bounds, const BuildProgress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const bool both = quality == BvhQuality::best;
    Reports reports(progress, both ? 2 : 1);
    Source source{triangles, analytic_bounds.size(), instance_bounds, &reports};
    if (triangles.empty() && analytic_bounds.empty() && instance_bounds.empty()) {
        Encoder encoder(source);
        encoder.encode_root(nullptr);
        return encoder.take();
    }
    const std::string config = threads > 0 ? "threads=" + std::to_string(threads) : "";
    const std::unique_ptr<RTCDeviceTy, ReleaseDevice> device(rtcNewDevice(config.c_str()));
    if (!device) throw std::runtime_error("Embree's builder could not be started");
    Bvh bvh = build_once(device.get(), source, analytic_bounds, both ? BvhQuality::fast : quality);
    if (both) {
        Bvh split = build_once(device.get(), source, analytic_bounds, BvhQuality::split);
        if (expected_steps(split) < expected_steps(bvh)) bvh = std::move(split);
    }
    order_children(bvh);
    bvh.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

std::uint32_t append_bvh(Bvh& all, const Bvh& group, std::uint32_t first_triangle, std::uint32_t first_analytic) {
    const auto root = static_cast<std::uint32_t>(all.nodes.size());
    const auto first_block = static_cast<std::uint32_t>(all.blocks.size());
    const auto first_entry = static_cast<std::uint32_t>(all.analytic_order.size());
    for (BvhNode node : group.nodes) {
        for (std::uint32_t& child : node.child) {
            if (child == BVH_EMPTY) continue;
            if ((child & BVH_LEAF) == 0) child += root;
            else child += (child & BVH_ANALYTIC) != 0 ? first_entry << 4U : first_block;
        }
        all.nodes.push_back(node);
    }
    for (TriangleBlock block : group.blocks) {
        for (std::uint32_t& primitive : block.primitive) {
            if (primitive != HIT_NONE) primitive += first_triangle;
        }
        all.blocks.push_back(block);
    }
    for (const std::uint32_t entry : group.analytic_order) all.analytic_order.push_back(entry + first_analytic);
    return root;
}

}  // namespace wavelobe
