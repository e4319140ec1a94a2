// The hierarchy that the kernels walk: what every builder must guarantee.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "accel/bvh.h"
#include "accel/few_triangles.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Walk {
    std::map<std::uint32_t, std::vector<Bounds>> triangles;  // and the bounds of the leaves they are in
    std::map<std::uint32_t, std::vector<Bounds>> analytics;
    std::set<std::uint32_t> blocks;
    std::size_t nodes = 0;
    int depth = 0;
};

class Hierarchy : public testing::TestWithParam<BvhQuality> {
protected:
    Bvh build(const Triangles& triangles, const std::vector<Bounds>& analytic = {}) {
        triangles_ = triangles;
        analytic_ = analytic;
        bvh_ = build_bvh(triangles_, analytic_, GetParam(), 2);
        return bvh_;
    }

    // Visits the whole tree from the root and checks each node.
    Walk walk() {
        Walk w;
        visit(0, {glm::vec3(-infinity), glm::vec3(infinity)}, 1, w);
        return w;
    }

    void expect_complete(const Walk& w) {
        EXPECT_EQ(w.triangles.size(), triangles_.size());
        EXPECT_EQ(w.analytics.size(), analytic_.size());
        EXPECT_EQ(w.nodes, bvh_.nodes.size()) << "nodes that nothing reaches";
        EXPECT_EQ(w.blocks.size(), bvh_.blocks.size()) << "blocks that nothing reaches";
        EXPECT_EQ(w.depth, bvh_.depth) << "the traversal stack is as deep as the tree says it is";
        expect_covered(w);
    }

    // A primitive lies in the bounds of its leaves together, to the bit: its corners, and where the leaves' planes cut
    // it. (Between those points it is convex.)
    void expect_covered(const Walk& w) {
        for (const auto& [index, leaves] : w.triangles) {
            const TriangleVertices& v = triangles_[index];
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::dvec3 a{v[i]};
                const glm::dvec3 b{v[(i + 1) % 3]};
                ASSERT_TRUE(covered(a, leaves)) << "corner of triangle " << index;
                for (const Bounds& leaf : leaves) {
                    for (glm::length_t axis = 0; axis < 3; ++axis) {
                        for (const double plane :
                             {static_cast<double>(leaf.lower[axis]), static_cast<double>(leaf.upper[axis])}) {
                            const double t = (plane - a[axis]) / (b[axis] - a[axis]);
                            if (!(t > 0.0 && t < 1.0)) continue;
                            glm::dvec3 crossing = a + (b - a) * t;
                            crossing[axis] = plane;
                            ASSERT_TRUE(covered(crossing, leaves)) << "edge of triangle " << index;
                        }
                    }
                }
            }
        }
        for (const auto& [index, leaves] : w.analytics) {
            for (int corner = 0; corner < 8; ++corner) {
                const Bounds& b = analytic_[index];
                const glm::dvec3 p{(corner & 1 ? b.upper : b.lower).x, (corner & 2 ? b.upper : b.lower).y,
                                   (corner & 4 ? b.upper : b.lower).z};
                ASSERT_TRUE(covered(p, leaves)) << "corner of analytic shape " << index;
            }
        }
    }

private:
    static bool covered(const glm::dvec3& p, const std::vector<Bounds>& leaves) {
        const glm::dvec3 rounding = 4.0 * std::numeric_limits<double>::epsilon() * glm::abs(p);
        return std::any_of(leaves.begin(), leaves.end(), [&](const Bounds& b) {
            return glm::all(glm::greaterThanEqual(p + rounding, glm::dvec3(b.lower))) &&
                   glm::all(glm::lessThanEqual(p - rounding, glm::dvec3(b.upper)));
        });
    }

    void visit(std::uint32_t index, const Bounds& outer, int level, Walk& w) {
        ASSERT_LT(index, bvh_.nodes.size());
        ++w.nodes;
        w.depth = std::max(w.depth, level);
        const BvhNode& node = bvh_.nodes[index];
        for (std::size_t i = 0; i < BVH_WIDTH; ++i) {
            const Bounds b{{node.bounds[0][i], node.bounds[2][i], node.bounds[4][i]},
                           {node.bounds[1][i], node.bounds[3][i], node.bounds[5][i]}};
            const std::uint32_t child = node.child[i];
            if (child == BVH_EMPTY) {
                EXPECT_EQ(b.lower, glm::vec3(infinity));
                EXPECT_EQ(b.upper, glm::vec3(-infinity));
                continue;
            }
            for (glm::length_t axis = 0; axis < 3; ++axis) {
                EXPECT_GE(b.lower[axis], outer.lower[axis]);
                EXPECT_LE(b.upper[axis], outer.upper[axis]);
            }
            if ((child & BVH_LEAF) == 0) {
                visit(child, b, level + 1, w);
            } else if ((child & BVH_ANALYTIC) != 0) {
                visit_analytics(child, b, w);
            } else {
                visit_block(child & ~BVH_LEAF, b, w);
            }
        }
    }

    void visit_analytics(std::uint32_t reference, const Bounds& b, Walk& w) {
        const std::uint32_t run = reference & ~(BVH_LEAF | BVH_ANALYTIC);
        EXPECT_GT(run & 15U, 0U);
        for (std::uint32_t i = 0; i < (run & 15U); ++i) {
            ASSERT_LT((run >> 4U) + i, bvh_.analytic_order.size());
            const std::uint32_t shape = bvh_.analytic_order[(run >> 4U) + i];
            w.analytics[shape].push_back(b);
        }
    }

    void visit_block(std::uint32_t index, const Bounds& b, Walk& w) {
        ASSERT_LT(index, bvh_.blocks.size());
        EXPECT_TRUE(w.blocks.insert(index).second) << "two parents";
        const TriangleBlock& block = bvh_.blocks[index];
        int present = 0;
        for (std::size_t lane = 0; lane < BVH_WIDTH; ++lane) {
            TriangleVertices v;
            for (std::size_t i = 0; i < 3; ++i)
                v[i] = {block.vertex[3 * i][lane], block.vertex[3 * i + 1][lane], block.vertex[3 * i + 2][lane]};
            const bool absent = v == TriangleVertices{};
            if (absent) continue;
            ++present;
            ASSERT_LT(block.primitive[lane], triangles_.size());
            EXPECT_EQ(v, triangles_[block.primitive[lane]]) << "vertices to the bit";
            w.triangles[block.primitive[lane]].push_back(b);
        }
        EXPECT_GT(present, 0);
    }

    Triangles triangles_;
    std::vector<Bounds> analytic_;
    Bvh bvh_;
};

TEST_P(Hierarchy, HoldsEveryTriangle) {
    build(triangle_soup(5000, 0.1F, 1.0F, {}, 1));
    expect_complete(walk());
}

TEST_P(Hierarchy, HoldsLongThinTriangles) {
    Generator random(2);
    Triangles triangles;
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 a = uniform_in_cube(random, 1.0F);
        triangles.push_back({a, a + 3.0F * uniform_direction(random), a + uniform_in_cube(random, 0.01F)});
    }
    build(triangles);
    expect_complete(walk());
}

TEST_P(Hierarchy, HoldsCopiesOfOneTriangle) {
    build(Triangles(1000, {glm::vec3{1, 0, 0}, glm::vec3{0, 1, 0}, glm::vec3{0, 0, 1}}));
    expect_complete(walk());
}

TEST_P(Hierarchy, HoldsAnalyticShapesBesideTriangles) {
    Generator random(3);
    std::vector<Bounds> analytic;
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 p = uniform_in_cube(random, 1.0F);
        analytic.push_back({p - 0.1F, p + 0.1F});
    }
    build(triangle_soup(300, 0.2F, 1.0F, {}, 4), analytic);
    expect_complete(walk());
    build({}, analytic);
    expect_complete(walk());
    build({}, {analytic[0]});
    expect_complete(walk());
}

TEST_P(Hierarchy, OfOneTriangleAndOfNone) {
    build({{glm::vec3{1, 0, 0}, glm::vec3{0, 1, 0}, glm::vec3{0, 0, 1}}});
    expect_complete(walk());
    build({});
    expect_complete(walk());
    EXPECT_EQ(build({}).nodes.size(), 1U) << "there is always a root";
}

// The number of threads may not decide which of two triangles at the same distance a ray finds.
TEST_P(Hierarchy, IsTheSameForAnyNumberOfThreads) {
    const Triangles triangles = triangle_soup(20000, 0.05F, 1.0F, {}, 5);
    const Bvh one = build_bvh(triangles, {}, GetParam(), 1);
    const Bvh two = build_bvh(triangles, {}, GetParam(), 2);
    ASSERT_EQ(one.blocks.size(), two.blocks.size());
    ASSERT_EQ(one.nodes.size(), two.nodes.size());
    for (std::size_t i = 0; i < one.blocks.size(); ++i) {
        ASSERT_TRUE(std::equal(std::begin(one.blocks[i].primitive), std::end(one.blocks[i].primitive),
                               two.blocks[i].primitive));
    }
    for (std::size_t i = 0; i < one.nodes.size(); ++i) {
        ASSERT_TRUE(std::equal(std::begin(one.nodes[i].child), std::end(one.nodes[i].child), two.nodes[i].child));
    }
}

INSTANTIATE_TEST_SUITE_P(All, Hierarchy, testing::Values(BvhQuality::fast, BvhQuality::split),
                         [](const auto& quality) { return quality.param == BvhQuality::fast ? "fast" : "split"; });

// A line that meets the root meets a box inside with the probability of its area over that of the root.
TEST(ExpectedSteps, AreTheNodesAndBlocksOfARandomLine) {
    Bvh bvh;
    BvhNode node{};
    for (std::uint32_t& child : node.child) child = BVH_EMPTY;
    const auto set_child = [&node](std::size_t i, const glm::vec3& lower, const glm::vec3& upper, std::uint32_t child) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            node.bounds[2 * axis][i] = lower[axis];
            node.bounds[2 * axis + 1][i] = upper[axis];
        }
        node.child[i] = child;
    };
    set_child(0, {0, 0, 0}, {1, 2, 2}, BVH_LEAF | 0U);
    set_child(1, {1, 0, 0}, {2, 2, 2}, BVH_LEAF | 1U);
    bvh.nodes.push_back(node);
    EXPECT_DOUBLE_EQ(expected_steps(bvh), 1.0 + 2.0 * 8.0 / 12.0);
}

TEST(BestHierarchy, IsTheCheaperOfBoth) {
    for (const float size : {0.02F, 0.8F}) {
        const Triangles triangles = triangle_soup(3000, size, 1.0F, {}, 21);
        const auto steps = [&](BvhQuality quality) { return expected_steps(build_bvh(triangles, {}, quality, 1)); };
        EXPECT_EQ(steps(BvhQuality::best), std::min(steps(BvhQuality::fast), steps(BvhQuality::split)));
    }
}

TEST(FewTriangles, AreTheTrianglesOnceWithSharedVertices) {
    const ClosedMesh mesh = cube_mesh(2);
    const Triangles triangles = mesh.triangles();
    const Bvh bvh = build_bvh(triangles, {}, BvhQuality::best, 1);
    const FewTriangleSet few = find_few_triangles(bvh);
    EXPECT_EQ(few.vertices.size(), 3 * mesh.vertices.size());
    std::set<std::uint32_t> found;
    for (const FewTriangle& t : few.triangles) {
        const std::uint32_t primitive = bvh.blocks[t.slot / BVH_WIDTH].primitive[t.slot % BVH_WIDTH];
        found.insert(primitive);
        for (std::size_t i = 0; i < 3; ++i) {
            const float* p = &few.vertices[3 * t.corner[i]];
            EXPECT_EQ(glm::vec3(p[0], p[1], p[2]), triangles[primitive][i]);
        }
    }
    EXPECT_EQ(few.triangles.size(), triangles.size());
    EXPECT_EQ(found.size(), triangles.size());
}

TEST(FewTriangles, AreNoneOfLargeScenesAndOfManyOtherShapes) {
    const Triangles triangles = triangle_soup(FEW_TRIANGLES_MAX + 1, 0.1F, 1.0F, {}, 6);
    EXPECT_TRUE(find_few_triangles(build_bvh(triangles, {}, BvhQuality::best, 1)).triangles.empty());
    std::vector<Bounds> shapes;
    for (std::uint32_t i = 0; i < FEW_ANALYTIC_MAX; ++i) {
        const glm::vec3 center(4.0F * static_cast<float>(i), 0, 0);
        shapes.push_back({center - 1.0F, center + 1.0F});
    }
    const auto few = [&](std::size_t count) {
        return find_few_triangles(build_bvh({triangles.data(), count}, shapes, BvhQuality::best, 1), shapes);
    };
    const FewTriangleSet set = few(3);
    ASSERT_EQ(set.analytics.size(), shapes.size());
    for (const FewAnalytic& a : set.analytics) {
        ASSERT_LT(a.entry, shapes.size());
        EXPECT_EQ(glm::vec3(a.lower[0], a.lower[1], a.lower[2]), shapes[a.entry].lower);
        EXPECT_EQ(glm::vec3(a.upper[0], a.upper[1], a.upper[2]), shapes[a.entry].upper);
    }
    EXPECT_TRUE(few(0).analytics.empty());
    shapes.push_back(shapes.front());
    EXPECT_TRUE(few(3).triangles.empty());
}

TEST_P(Hierarchy, HasTheLargestChildLast) {
    const Bvh bvh = build_bvh(triangle_soup(3000, 0.1F, 1.0F, {}, 22), {}, GetParam(), 1);
    for (const BvhNode& node : bvh.nodes) {
        double before = 0.0;
        for (unsigned i = 0; i < BVH_WIDTH && node.child[i] != BVH_EMPTY; ++i) {
            const auto extent = [&](unsigned axis) { return static_cast<double>(node.bounds[2 * axis + 1][i] - node.bounds[2 * axis][i]); };
            const double area = extent(0) * extent(1) + extent(1) * extent(2) + extent(2) * extent(0);
            EXPECT_GE(area, before * (1.0 - 1e-12));
            before = area;
        }
    }
}

TEST_P(Hierarchy, TellsHowFarItIs) {
    const Triangles triangles = triangle_soup(200000, 0.01F, 1.0F, {}, 3);
    std::vector<double> shares;
    build_bvh(triangles, {}, GetParam(), 2, {}, [&](double share) {
        shares.push_back(share);
        return true;
    });
    ASSERT_GT(shares.size(), 10U);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_GE(shares.front(), 0.0);
    EXPECT_LT(shares.front(), 0.2);
    EXPECT_GT(shares.back(), 0.9);
    EXPECT_LE(shares.back(), 1.0);
}

TEST_P(Hierarchy, StopsWhenAsked) {
    const Triangles triangles = triangle_soup(200000, 0.01F, 1.0F, {}, 3);
    double last = 0.0;
    EXPECT_THROW(build_bvh(triangles, {}, GetParam(), 2, {}, [&](double share) { return (last = share) < 0.1; }), BuildStopped);
    EXPECT_LT(last, 0.5);
}

}  // namespace
}  // namespace wavelobe::test
