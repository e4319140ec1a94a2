#include "scene/gltf/pose.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wavelobe::gltf {

void morph(Primitive& primitive, const std::vector<double>& weights) {
    const std::size_t count = std::min(weights.size(), primitive.targets.size());
    for (std::size_t t = 0; t < count; ++t) {
        const auto weight = static_cast<float>(weights[t]);
        if (weight == 0.0F) continue;
        const MorphTarget& target = primitive.targets[t];
        for (std::size_t i = 0; i < target.positions.size(); ++i) primitive.mesh.positions[i] += weight * target.positions[i];
        for (std::size_t i = 0; i < std::min(target.normals.size(), primitive.mesh.normals.size()); ++i)
            primitive.mesh.normals[i] += weight * target.normals[i];
        for (std::size_t i = 0; i < std::min(target.tangents.size(), primitive.tangents.size()); ++i)
            primitive.tangents[i] += glm::vec4(weight * target.tangents[i], 0.0F);
        for (std::size_t i = 0; i < std::min(target.colors.size(), primitive.colors.size()); ++i) primitive.colors[i] += weight * target.colors[i];
        for (std::size_t s = 0; s < std::min(target.uv_sets.size(), primitive.uv_sets.size()); ++s)
            for (std::size_t i = 0; i < target.uv_sets[s].size(); ++i) primitive.uv_sets[s][i] += weight * target.uv_sets[s][i];
    }
    for (glm::vec4& color : primitive.colors) color = glm::clamp(color, 0.0F, 1.0F);
}

std::vector<glm::dmat4> joint_matrices(Document& document, const Accessors& accessors, std::size_t skin, const NodeTree& tree) {
    const Element& element = document.skins[skin];
    element.require("joints");
    element.index("skeleton", document.nodes.size(), "nodes");
    const std::vector<std::size_t> joints = element.indices("joints", document.nodes.size(), "nodes");
    if (joints.empty() && element.has("joints")) element.fault("has no joints; expected at least one");
    const auto index = element.index("inverseBindMatrices", accessors.size(), "accessors");
    std::vector<float> numbers;
    if (index) {
        if (!accessors[*index].readable) return {};
        if (accessors[*index].type != "MAT4" || accessors[*index].count < joints.size()) {
            element.fault(fmt::format("`inverseBindMatrices` are {} of type {}; expected {} of type MAT4", accessors[*index].count,
                                      accessors[*index].type, joints.size()));
            return {};
        }
        numbers = accessors.floats(*index);
        if (!std::all_of(numbers.begin(), numbers.end(), [](float v) { return std::isfinite(v); })) {
            element.fault("`inverseBindMatrices` are not finite");
            return {};
        }
        for (std::size_t j = 0; accessors.has_data(*index) && j < joints.size(); ++j) {
            const float* m = numbers.data() + 16 * j;
            if (m[3] == 0.0F && m[7] == 0.0F && m[11] == 0.0F && std::abs(m[15] - 1.0F) < 1e-3F) continue;
            element.fault(fmt::format("matrix {} of `inverseBindMatrices` has a last row of {} {} {} {}; expected 0 0 0 1", j, m[3], m[7], m[11], m[15]));
            return {};
        }
    }
    std::vector<glm::dmat4> out;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        glm::dmat4 inverse_bind(1.0);
        if (index)
            for (std::size_t i = 0; i < 16; ++i) inverse_bind[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = static_cast<double>(numbers[16 * j + i]);
        out.push_back(tree.world[joints[j]] * inverse_bind);
    }
    return out;
}

void bend(Document& document, const std::vector<glm::dmat4>& joints, const std::string& path, Primitive& primitive) {
    for (std::size_t i = 0; i < primitive.mesh.positions.size(); ++i) {
        glm::dmat4 sum(0.0);
        double total = 0.0;
        for (const Influence& influence : primitive.influences) {
            for (int k = 0; k < 4; ++k) {
                const auto weight = static_cast<double>(influence.weights[i][k]);
                if (weight == 0.0) continue;
                const auto joint = static_cast<std::size_t>(influence.joints[i][k]);
                if (joint >= joints.size()) {
                    document.faults.add(path, fmt::format("vertex {} follows joint {}; the skin has {}", i, joint, joints.size()));
                    return;
                }
                sum += weight * joints[joint];
                total += weight;
            }
        }
        if (!(std::abs(total) > 1e-6)) continue;  // bound to nothing: it stays
        sum /= total;
        primitive.mesh.positions[i] = glm::vec3(sum * glm::dvec4(glm::dvec3(primitive.mesh.positions[i]), 1.0));
        if (primitive.mesh.normals.empty()) continue;
        const glm::dmat3 linear(sum);
        const double determinant = glm::determinant(linear);
        if (!primitive.tangents.empty()) {
            glm::vec4& tangent = primitive.tangents[i];
            tangent = glm::vec4(glm::vec3(linear * glm::dvec3(tangent)), determinant < 0.0 ? -tangent.w : tangent.w);
        }
        if (std::abs(determinant) > 0.0)
            primitive.mesh.normals[i] = glm::vec3(glm::transpose(glm::inverse(linear)) * glm::dvec3(primitive.mesh.normals[i]));
    }
}

}  // namespace wavelobe::gltf
