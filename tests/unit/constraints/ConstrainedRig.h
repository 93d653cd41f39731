// SPDX-License-Identifier: MIT
// An arm, and nodes that follow it, in a glTF file with VRM 1's constraints; and where its nodes
// are by the specification's text, computed with quaternions alone.
#pragma once

#include "GltfBuilder.h"

#include <osgSkin/BoneReader>
#include <osgSkin/GlmOsg>

#include <osgAnimation/Skeleton>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <map>
#include <random>
#include <string>
#include <vector>

namespace test {

/// A constraint as the specification describes it.
struct NodeConstraint {
    std::string joint, source, kind; ///< "roll", "aim" or "rotation"
    std::string axis;                ///< "X", "NegativeZ", ...; empty for a rotation
    double weight = 1.0;
};

struct ConstrainedRig : GltfBuilder {
    struct Node {
        std::string name;
        int parent;
        glm::dvec3 place; ///< in its parent
        glm::dquat rest{1.0, 0.0, 0.0, 0.0};
        glm::dquat bind{1.0, 0.0, 0.0, 0.0}; ///< rotation in the bind pose, in its parent
        std::vector<glm::dquat> keys{};      ///< of the clip, at 0, 1 and 2 s
    };

    std::vector<Node> nodes = {{"root", -1, {0, 1, 0}},       {"upper", 0, {0.2, 0.4, 0}},
                               {"lower", 1, {0.1, 0.3, 0.1}}, {"hand", 2, {0, 0.3, 0}},
                               {"twist", 2, {0.02, 0.15, 0}}, {"sleeve", 0, {0.3, 0.2, 0.2}},
                               {"copy", 0, {-0.3, 0.4, -0.1}}};

    std::string rigid{}; ///< a node that carries a mesh of its own in place of a part of the skin

    /// \param seed of all rotations; 0: none at rest
    /// \param hasOtherBind whether the skin is bound in another pose than that of the nodes
    explicit ConstrainedRig(unsigned seed, bool hasOtherBind = false) {
        std::mt19937 random(seed + 1);
        std::normal_distribution<double> number;
        const auto rotation = [&] {
            return glm::normalize(
                glm::dquat(number(random), number(random), number(random), number(random)));
        };
        for (Node& node : nodes) {
            if (seed != 0) node.rest = rotation();
            node.bind = hasOtherBind && node.parent >= 0 ? rotation() : node.rest;
            if (node.name == "upper" || node.name == "lower" || node.name == "hand" ||
                node.name == "root")
                node.keys = {node.rest, rotation(), rotation()};
        }
    }

    glm::dquat rotationOf(std::size_t node, int key) const {
        const Node& n = nodes[node];
        return n.keys.empty() ? n.rest : n.keys[static_cast<std::size_t>(key)];
    }

    std::size_t indexOf(const std::string& name) const {
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (nodes[n].name == name) return n;
        ADD_FAILURE() << name;
        return 0;
    }

    /// Writes the file: every node is a joint with a triangle of its own.
    std::string write(const std::string& file, const std::vector<NodeConstraint>& constraints) {
        std::vector<double> positions, weights, joints, inverse;
        std::vector<double> corners;
        const std::vector<glm::dmat4> bind = placesOf([&](std::size_t n) { return nodes[n].bind; });
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const Node& from = nodes[n];
            node({{"name", from.name},
                  {"translation", {from.place.x, from.place.y, from.place.z}},
                  {"rotation", {from.rest.x, from.rest.y, from.rest.z, from.rest.w}}});
            if (from.parent >= 0) json["nodes"][std::size_t(from.parent)]["children"].push_back(n);
            if (from.name == rigid) continue;
            const glm::dmat4 toBone = glm::inverse(bind[n]);
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 4; ++r) inverse.push_back(toBone[c][r]);
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3 at(bind[n][3] + 0.02 * bind[n][corner]);
                for (int axis = 0; axis < 3; ++axis) positions.push_back(at[axis]);
                for (int k = 0; k < 4; ++k) weights.push_back(k == 0 ? 1.0 : 0.0);
                for (int k = 0; k < 4; ++k) joints.push_back(k == 0 ? double(n) : 0.0);
                corners.push_back(double(corners.size()));
            }
            if (from.keys.empty()) continue;
            std::vector<double> keys;
            for (const glm::dquat& q : from.keys) keys.insert(keys.end(), {q.x, q.y, q.z, q.w});
            animate("move", n, "rotation", {0, 1, 2}, keys);
        }
        for (const NodeConstraint& constraint : constraints) {
            nlohmann::json members = {{"source", indexOf(constraint.source)},
                                      {"weight", constraint.weight}};
            if (!constraint.axis.empty()) members[constraint.kind + "Axis"] = constraint.axis;
            json["nodes"][indexOf(constraint.joint)]["extensions"]["VRMC_node_constraint"] = {
                {"specVersion", "1.0"}, {"constraint", {{constraint.kind, members}}}};
        }
        const std::size_t at = accessor("VEC3", positions), weight = accessor("VEC4", weights);
        const std::size_t joint = accessor("VEC4", joints, 5121);
        const std::size_t index = accessor("SCALAR", corners, 5125);
        json["meshes"].push_back(
            {{"primitives",
              {{{"attributes", {{"POSITION", at}, {"WEIGHTS_0", weight}, {"JOINTS_0", joint}}},
                {"indices", index}}}}});
        std::vector<std::size_t> all;
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (nodes[n].name != rigid) all.push_back(n);
        json["skins"] = {{{"joints", all}, {"inverseBindMatrices", accessor("MAT4", inverse)}}};
        const std::size_t mesh = node({{"name", "Body"}, {"mesh", 0}, {"skin", 0}});
        json["scenes"][0]["nodes"] = {0, mesh};
        json["extensionsUsed"] = {"VRMC_node_constraint"};
        return save(file);
    }

    /// The nodes' rotations in the scene at a key, with constraints in the order in which they are
    /// to be evaluated.
    std::vector<glm::dquat> expected(int key,
                                     const std::vector<NodeConstraint>& constraints) const {
        std::vector<glm::dquat> local;
        for (std::size_t n = 0; n < nodes.size(); ++n) local.push_back(rotationOf(n, key));
        for (const NodeConstraint& constraint : constraints) {
            const std::size_t d = indexOf(constraint.joint), s = indexOf(constraint.source);
            const glm::dquat &rest = nodes[d].rest, &before = nodes[s].rest;
            glm::dquat turn(1.0, 0.0, 0.0, 0.0); // of the node at rest, in its own axes
            if (constraint.kind == "rotation") turn = glm::inverse(before) * local[s];
            if (constraint.kind == "roll") {
                // From the source's parent to the axes of the node at rest; the part about the
                // axis.
                turn = glm::inverse(rest) * (local[s] * glm::inverse(before)) * rest;
                const glm::dvec3 axis = axisOf(constraint.axis);
                const glm::dvec3 about = axis * glm::dot(axis, glm::dvec3(turn.x, turn.y, turn.z));
                turn = glm::normalize(glm::dquat(turn.w, about));
            }
            if (constraint.kind == "aim") {
                const auto at = placesOf([&](std::size_t n) { return local[n]; });
                const glm::dquat scene =
                    glm::quat_cast(glm::dmat3(at[std::size_t(nodes[d].parent)])) * rest;
                const glm::dvec3 to =
                    glm::inverse(scene) * glm::normalize(glm::dvec3(at[s][3] - at[d][3]));
                const glm::dvec3 axis = axisOf(constraint.axis), normal = glm::cross(axis, to);
                turn = glm::angleAxis(std::atan2(glm::length(normal), glm::dot(axis, to)),
                                      glm::normalize(normal));
            }
            if (turn.w < 0.0) turn = -turn;
            const glm::dvec3 axis(turn.x, turn.y, turn.z);
            const double half = std::atan2(glm::length(axis), turn.w) * constraint.weight;
            if (glm::length(axis) > 0.0)
                turn = glm::dquat(std::cos(half), std::sin(half) * glm::normalize(axis));
            local[d] = rest * turn;
        }
        std::vector<glm::dquat> result;
        for (const glm::dmat4& place : placesOf([&](std::size_t n) { return local[n]; }))
            result.push_back(glm::quat_cast(glm::dmat3(place)));
        return result;
    }

    /// How far bones are rotated otherwise: the largest difference of matrices' elements.
    double error(osgAnimation::Skeleton& skeleton, const std::vector<glm::dquat>& expected) const {
        const osgAnimation::BoneMap bones = osgSkin::bonesOf(skeleton);
        const auto bind = placesOf([&](std::size_t n) { return nodes[n].bind; });
        double result = 0.0;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const osgAnimation::Bone& bone = *bones.at(nodes[n].name);
            const glm::dmat3 found(osgSkin::toGlm(osg::Matrixd(
                bone.getInvBindMatrixInSkeletonSpace() * bone.getMatrixInSkeletonSpace())));
            const glm::dmat3 wanted =
                glm::mat3_cast(expected[n]) * glm::inverse(glm::dmat3(bind[n]));
            for (int c = 0; c < 3; ++c)
                for (int r = 0; r < 3; ++r)
                    result = std::max(result, std::abs(found[c][r] - wanted[c][r]));
        }
        return result;
    }

    template <typename Rotation>
    std::vector<glm::dmat4> placesOf(const Rotation& local) const {
        std::vector<glm::dmat4> result;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            glm::dmat4 own = glm::mat4_cast(local(n));
            own[3] = glm::dvec4(nodes[n].place, 1.0);
            result.push_back(nodes[n].parent < 0 ? own
                                                 : result[std::size_t(nodes[n].parent)] * own);
        }
        return result;
    }

    static glm::dvec3 axisOf(const std::string& name) {
        glm::dvec3 result(0.0);
        result[name.back() - 'X'] = name.rfind("Negative", 0) == 0 ? -1.0 : 1.0;
        return result;
    }
};

} // namespace test
