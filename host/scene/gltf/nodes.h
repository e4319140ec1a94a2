// The tree of nodes: where each stands in the world.
#pragma once

#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/gltf/document.h"

namespace wavelobe::gltf {

// A node against its parent; a matrix takes the place of the other three.
struct LocalTransform {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    std::optional<glm::dmat4> matrix;
    std::vector<double> weights;  // of morph targets; empty: those of the mesh

    glm::dmat4 to_parent() const;
};

class NodeTree {
public:
    // Adds a fault for each node with two parents or among its own ancestors.
    explicit NodeTree(Document& document);

    std::vector<LocalTransform> local;  // of each node; animation changes it
    std::vector<glm::dmat4> world;      // after place(), of all nodes
    std::vector<std::size_t> shown;     // nodes of the scene, parents first

    // Whether no node has two parents or is among its own ancestors; without that there are no roots.
    bool is_tree() const { return is_tree_; }
    std::size_t root_of(std::size_t node) const { return root_[node]; }
    // Whether `node` is `ancestor` or below it.
    bool is_below(std::size_t node, std::size_t ancestor) const;

    // Fills `world` and `shown`. The scene is the file's default, or its first, or all there is.
    void place();

private:
    void read_parents();
    LocalTransform read_local(const Element& node);
    std::vector<std::size_t> roots();

    Document& document_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<int> parent_;  // -1: none
    std::vector<std::size_t> root_;
    bool is_tree_ = true;
};

}  // namespace wavelobe::gltf
