#include "scene/gltf/nodes.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace wavelobe::gltf {

glm::dmat4 LocalTransform::to_parent() const {
    if (matrix) return *matrix;
    return glm::scale(glm::translate(glm::dmat4(1.0), translation) * glm::mat4_cast(rotation), scale);
}

NodeTree::NodeTree(Document& document)
    : world(document.nodes.size(), glm::dmat4(1.0)), document_(document), children_(document.nodes.size()),
      parent_(document.nodes.size(), -1) {
    for (const Element& node : document.nodes) local.push_back(read_local(node));
    read_parents();
}

LocalTransform NodeTree::read_local(const Element& node) {
    LocalTransform out;
    if (node.has("matrix")) {
        const auto m = node.vector<16>("matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        glm::dmat4 matrix(1.0);
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<double>(m[static_cast<std::size_t>(i)]);
        if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0)
            node.fault("a `matrix` whose last row is not 0 0 0 1", "glTF stores matrices column by column");
        for (const char* name : {"translation", "rotation", "scale"})
            if (node.has(name)) node.fault(fmt::format("has both a `matrix` and a `{}`; expected one or the other", name));
        out.matrix = matrix;
    }
    const auto t = node.vector<3>("translation", {0, 0, 0});
    const auto r = node.vector<4>("rotation", {0, 0, 0, 1});
    const auto s = node.vector<3>("scale", {1, 1, 1});
    out.translation = {t[0], t[1], t[2]};
    out.scale = {s[0], s[1], s[2]};
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    const double length = glm::length(rotation);
    if (std::abs(length - 1.0) < 0.05) out.rotation = rotation / length;
    else node.fault(fmt::format("a `rotation` of length {:.4g}", length), "expected a unit quaternion");
    out.weights = node.numbers("weights");
    for (const char* name : {"skin", "weights"})
        if (node.has(name) && !node.has("mesh")) node.fault(fmt::format("has `{}` and no `mesh`", name));
    return out;
}

void NodeTree::read_parents() {
    const std::size_t count = document_.nodes.size();
    for (std::size_t i = 0; i < count; ++i) {
        for (const std::size_t child : document_.nodes[i].indices("children", count, "nodes")) {
            if (parent_[child] >= 0) {
                document_.nodes[i].fault(fmt::format("node {} is already a child of node {}", child, parent_[child]),
                                         "a node has one parent at most");
                is_tree_ = false;
                continue;
            }
            parent_[child] = static_cast<int>(i);
            children_[i].push_back(child);
        }
    }
    // Among nodes with one parent each, a cycle is what no root leads to.
    std::vector<bool> reached(count, false);
    std::vector<std::size_t> pending;
    root_.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        if (parent_[i] < 0) pending.push_back(root_[i] = i);
    while (!pending.empty()) {
        const std::size_t node = pending.back();
        pending.pop_back();
        reached[node] = true;
        for (const std::size_t child : children_[node]) pending.push_back(child), root_[child] = root_[node];
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (reached[i]) continue;
        document_.nodes[i].fault("is among its own ancestors, or below such a node", "nodes must form trees");
        is_tree_ = false;
    }
}

bool NodeTree::is_below(std::size_t node, std::size_t ancestor) const {
    while (node != ancestor && parent_[node] >= 0) node = static_cast<std::size_t>(parent_[node]);
    return node == ancestor;
}

std::vector<std::size_t> NodeTree::roots() {
    std::vector<std::size_t> out;
    for (const Element& scene : document_.scenes)
        for (const std::size_t node : scene.indices("nodes", document_.nodes.size(), "nodes"))
            if (parent_[node] >= 0) scene.fault(fmt::format("shows node {}, a child of node {}", node, parent_[node]), "expected roots alone");
    const auto chosen = document_.root.index("scene", document_.scenes.size(), "scenes");
    if (!document_.scenes.empty()) {
        if (document_.scenes.size() > 1)
            document_.warn(fmt::format("{}: of {} scenes number {} is shown", document_.file, document_.scenes.size(), chosen.value_or(0)));
        for (const std::int64_t node : document_.scenes[chosen.value_or(0)].whole_numbers("nodes"))
            if (node >= 0 && static_cast<std::size_t>(node) < document_.nodes.size()) out.push_back(static_cast<std::size_t>(node));
        return out;
    }
    for (std::size_t i = 0; i < document_.nodes.size(); ++i)
        if (parent_[i] < 0) out.push_back(i);
    return out;
}

void NodeTree::place() {
    shown.clear();
    const std::vector<std::size_t> first = roots();
    if (!is_tree_) return;
    // World matrices of all nodes: joints of a skin may lie outside the scene that is shown.
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < local.size(); ++i)
        if (parent_[i] < 0) pending.push_back(i);
    while (!pending.empty()) {
        const std::size_t node = pending.back();
        pending.pop_back();
        const glm::dmat4 above = parent_[node] < 0 ? glm::dmat4(1.0) : world[static_cast<std::size_t>(parent_[node])];
        world[node] = above * local[node].to_parent();
        pending.insert(pending.end(), children_[node].begin(), children_[node].end());
    }
    std::vector<bool> seen(local.size(), false);
    pending.assign(first.rbegin(), first.rend());
    while (!pending.empty()) {
        const std::size_t node = pending.back();
        pending.pop_back();
        if (seen[node]) continue;
        seen[node] = true;
        shown.push_back(node);
        pending.insert(pending.end(), children_[node].rbegin(), children_[node].rend());
    }
}

}  // namespace wavelobe::gltf
