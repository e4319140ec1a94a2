#include "tables/light_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace wavelobe {
namespace {

using std::numbers::pi;

constexpr int buckets = 12;
constexpr int most_levels = 32;  // MOST_LIGHT_LEVELS of the kernel

glm::dvec3 center(const LightBounds& b) { return 0.5 * (b.lower + b.upper); }

double surface_area(const LightBounds& b) {
    const glm::dvec3 d = b.upper - b.lower;
    return 2.0 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

// Solid angle that the cone of normals lights, weighted by the cosine beyond its border: M_Omega of the paper.
double lit_solid_angle(const LightBounds& b) {
    const double o = b.spread;
    const double w = std::min(o + b.emission, pi);
    return 2.0 * pi * (1.0 - std::cos(o)) +
           0.5 * pi * (2.0 * w * std::sin(o) - std::cos(o - 2.0 * w) - 2.0 * o * std::sin(o) + std::cos(o));
}

double cost_of(const LightBounds& b) { return b.intensity * lit_solid_angle(b) * surface_area(b); }

struct Bucket {
    LightBounds bounds;
    std::size_t count = 0;

    void add(const LightBounds& b, std::size_t n) {
        bounds = count == 0 ? b : light_bounds_union(bounds, b);
        count += n;
    }
    double cost() const { return count == 0 ? 0.0 : cost_of(bounds); }
};

// A node of the binary tree.
struct Part {
    LightBounds bounds;
    std::size_t first = 0, last = 0;  // its lights in the builder's order
    std::size_t child = 0;            // first of two, side by side; 0: a leaf

    std::size_t lights() const { return last - first; }
};

struct Split {
    int axis = -1;
    int bucket = 0;  // the first that goes to the second child
    double cost = std::numeric_limits<double>::infinity();
};

class Builder {
public:
    explicit Builder(std::span<const LightBounds> lights) : lights_(lights), order_(lights.size()) {
        std::iota(order_.begin(), order_.end(), Uint32{0});
    }

    LightTree run() {
        if (lights_.empty()) return {};
        parts_.reserve(2 * lights_.size());
        parts_.emplace_back();
        build(0, 0, order_.size(), 0);
        // Importances stay far from the largest and smallest floats, whatever the unit of radiance.
        const double intensity = parts_[0].bounds.intensity;
        per_intensity_ = intensity > 0.0 ? 1.0 / intensity : 0.0;
        tree_.places.resize(lights_.size());
        collapse(0, LIGHT_ROOT, 1);
        return std::move(tree_);
    }

private:
    int bucket_of(const LightBounds& light, int axis, double low, double high) const {
        const double at = (center(light)[axis] - low) / (high - low) * buckets;
        return std::clamp(static_cast<int>(at), 0, buckets - 1);
    }

    // The split of least cost over all axes; none if all centres coincide.
    Split best_split(std::size_t first, std::size_t last, const glm::dvec3& low, const glm::dvec3& high) const {
        Split best;
        const glm::dvec3 size = high - low;
        const double longest = std::max({size.x, size.y, size.z});
        for (int axis = 0; axis < 3; ++axis) {
            if (!(size[axis] > 0.0)) continue;
            std::array<Bucket, buckets> bucket;
            for (std::size_t i = first; i < last; ++i) {
                const LightBounds& light = lights_[order_[i]];
                bucket[static_cast<std::size_t>(bucket_of(light, axis, low[axis], high[axis]))].add(light, 1);
            }
            std::array<double, buckets> above{};  // cost of the buckets from this one on
            Bucket sum;
            for (std::size_t k = buckets - 1; k > 0; --k) {
                if (bucket[k].count > 0) sum.add(bucket[k].bounds, bucket[k].count);
                above[k] = sum.cost();
            }
            Bucket below;
            for (std::size_t k = 1; k < buckets; ++k) {
                if (bucket[k - 1].count > 0) below.add(bucket[k - 1].bounds, bucket[k - 1].count);
                if (below.count == 0 || below.count == last - first) continue;
                // Thin slabs are dear: K_r of the paper.
                const double cost = longest / size[axis] * (below.cost() + above[k]);
                if (cost < best.cost) best = {axis, static_cast<int>(k), cost};
            }
        }
        return best;
    }

    // Where the second child's lights begin; order_ is rearranged.
    std::size_t divide(std::size_t first, std::size_t last, int level) {
        glm::dvec3 low(std::numeric_limits<double>::infinity());
        glm::dvec3 high = -low;
        for (std::size_t i = first; i < last; ++i) {
            const glm::dvec3 c = center(lights_[order_[i]]);
            low = glm::min(low, c);
            high = glm::max(high, c);
        }
        const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(last);
        // Levels that halving needs, one of them this one.
        const int needed = static_cast<int>(std::bit_width(last - first - 1));
        if (level + needed < most_levels) {
            const Split split = best_split(first, last, low, high);
            if (split.axis >= 0) {
                const auto middle = std::stable_partition(begin, end, [&](Uint32 i) {
                    return bucket_of(lights_[i], split.axis, low[split.axis], high[split.axis]) < split.bucket;
                });
                return static_cast<std::size_t>(middle - order_.begin());
            }
        }
        const glm::dvec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end, [&](Uint32 a, Uint32 b) {
            const double x = center(lights_[a])[axis];
            const double y = center(lights_[b])[axis];
            return x != y ? x < y : a < b;
        });
        return static_cast<std::size_t>(middle - order_.begin());
    }

    void build(std::size_t at, std::size_t first, std::size_t last, int level) {
        parts_[at].first = first;
        parts_[at].last = last;
        if (last - first == 1) {
            parts_[at].bounds = lights_[order_[first]];
            return;
        }
        const std::size_t middle = divide(first, last, level);
        const std::size_t child = parts_.size();
        parts_.resize(child + 2);
        parts_[at].child = child;
        build(child, first, middle, level + 1);
        build(child + 1, middle, last, level + 1);
        parts_[at].bounds = light_bounds_union(parts_[child].bounds, parts_[child + 1].bounds);
    }

    // Up to eight parts that make up this one: the dearest is opened, again and again. Of those that cost nothing, as lights in
    // one place, the one of most lights.
    std::vector<std::size_t> open(std::size_t part) const {
        std::vector<std::size_t> open{part};
        const auto dearness = [&](std::size_t i) {
            const Part& p = parts_[i];
            return p.child == 0 ? std::pair(-1.0, std::size_t{0}) : std::pair(cost_of(p.bounds), p.lights());
        };
        while (open.size() < LIGHT_CHILDREN) {
            const auto dearest = std::ranges::max_element(open, {}, dearness);
            const std::size_t child = parts_[*dearest].child;
            if (child == 0) break;
            *dearest = child;
            open.insert(dearest + 1, child + 1);
        }
        return open;
    }

    void collapse(std::size_t part, Uint32 place, int level) {
        tree_.depth = std::max(tree_.depth, level);
        const std::size_t node = tree_.nodes.size();
        tree_.nodes.emplace_back();
        tree_.nodes[node].place = place;
        std::size_t i = 0;
        for (const std::size_t child : open(part)) {
            const Part& p = parts_[child];
            const auto here = static_cast<Uint32>(LIGHT_PLACE(node, i));
            store(tree_.nodes[node], i, p.bounds);
            if (p.child == 0) {
                tree_.places[order_[p.first]] = here;
                tree_.nodes[node].child[i] = LIGHT_LEAF | order_[p.first];
            } else {
                tree_.nodes[node].child[i] = static_cast<Uint32>(tree_.nodes.size());
                collapse(child, here, level + 1);
            }
            ++i;
        }
    }

    void store(LightNode& node, std::size_t i, const LightBounds& b) const {
        const glm::vec3 c(center(b));
        const glm::vec3 axis(b.axis);
        node.center_x[i] = c.x, node.center_y[i] = c.y, node.center_z[i] = c.z;
        node.radius[i] = static_cast<float>(0.5 * glm::length(b.upper - b.lower));
        node.axis_x[i] = axis.x, node.axis_y[i] = axis.y, node.axis_z[i] = axis.z;
        node.cos_spread[i] = static_cast<float>(std::cos(b.spread));
        node.sin_spread[i] = b.spread >= pi ? 0.0F : static_cast<float>(std::sin(b.spread));
        node.cos_emission[i] = static_cast<float>(std::cos(b.emission));
        // However dim, it has a chance.
        const float least = b.intensity > 0.0 ? std::numeric_limits<float>::min() : 0.0F;
        node.intensity[i] = std::max(static_cast<float>(b.intensity * per_intensity_), least);
    }

    std::span<const LightBounds> lights_;
    std::vector<Uint32> order_;
    std::vector<Part> parts_;
    double per_intensity_ = 0.0;
    LightTree tree_;
};

// The cone about two: its axis in the plane of theirs.
void join_cones(const LightBounds& a, const LightBounds& b, LightBounds& out) {
    const LightBounds& wide = a.spread >= b.spread ? a : b;
    const LightBounds& narrow = a.spread >= b.spread ? b : a;
    out.axis = wide.axis;
    out.spread = wide.spread;
    const glm::dvec3 across = glm::cross(wide.axis, narrow.axis);
    const double between = std::atan2(glm::length(across), glm::dot(wide.axis, narrow.axis));
    if (std::min(between + narrow.spread, pi) <= wide.spread) return;
    out.spread = 0.5 * (wide.spread + between + narrow.spread);
    if (out.spread >= pi || glm::length(across) <= 0.0) {
        out.spread = pi;
        return;
    }
    const double turn = out.spread - wide.spread;
    const glm::dvec3 k = glm::normalize(across);
    out.axis = glm::normalize(wide.axis * std::cos(turn) + glm::cross(k, wide.axis) * std::sin(turn));
}

}  // namespace

LightBounds light_bounds_union(const LightBounds& a, const LightBounds& b) {
    // What does not shine does not widen anything.
    if (!(a.intensity > 0.0)) return b;
    if (!(b.intensity > 0.0)) return a;
    LightBounds out;
    out.lower = glm::min(a.lower, b.lower);
    out.upper = glm::max(a.upper, b.upper);
    join_cones(a, b, out);
    out.emission = std::max(a.emission, b.emission);
    out.intensity = a.intensity + b.intensity;
    return out;
}

LightTree build_light_tree(std::span<const LightBounds> lights) {
    if (lights.size() > (std::size_t{1} << 28)) throw std::invalid_argument("a light tree holds 2^28 lights at the most");
    return Builder(lights).run();
}

}  // namespace wavelobe
