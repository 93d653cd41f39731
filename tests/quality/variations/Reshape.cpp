// SPDX-License-Identifier: MIT
#include "Reshape.h"

#include "../Subject.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <functional>
#include <utility>

namespace quality {
namespace {

constexpr double kAtExtremities = 0.2;
constexpr int kSmoothings = 4;

/// What `side` ("Left", "Right" or neither) says of the joint, by its whole name or without side.
template <typename Value>
const Value* entryOf(const std::map<std::string, Value>& entries, const std::string& joint) {
    if (const auto found = entries.find(joint); found != entries.end()) return &found->second;
    for (const std::string side : {"Left", "Right"})
        if (joint.rfind(side, 0) == 0)
            if (const auto found = entries.find(joint.substr(side.size())); found != entries.end())
                return &found->second;
    return nullptr;
}

/// The painted mean over a vertex's joints of what `of` says of each.
template <typename Value>
Value paintedMean(const PaintedBody& body, std::size_t vertex,
                  const std::function<Value(std::size_t)>& of) {
    Value sum(0.0);
    double weights = 0.0;
    for (const osgSkin::JointWeight& entry : body.painted[vertex]) {
        sum += entry.weight * of(entry.joint);
        weights += entry.weight;
    }
    return weights > 0.0 ? sum / weights : of(0);
}

/// 1, and less on head, hands and feet.
std::vector<double> shares(const PaintedBody& body) {
    const auto ofJoint = [&](std::size_t joint) {
        for (const char* name : {"Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot"})
            if (const int part = body.rig.find(name);
                part >= 0 && body.rig.isInSubtree(static_cast<int>(joint), part))
                return kAtExtremities;
        return 1.0;
    };
    std::vector<double> result;
    for (std::size_t v = 0; v < body.painted.size(); ++v)
        result.push_back(paintedMean<double>(body, v, ofJoint));
    return result;
}

std::vector<glm::dvec3> smoothNormals(const osgSkin::SkinMesh& mesh) {
    const std::vector<std::uint32_t> triangles = mesh.triangles();
    compare::Points normals = skinNormals(mesh.positions, triangles);
    for (int i = 0; i < kSmoothings; ++i) {
        compare::Points sums = normals;
        for (std::size_t t = 0; t < triangles.size(); ++t)
            sums[triangles[t]] += normals[triangles[t % 3 == 2 ? t - 2 : t + 1]];
        for (std::size_t v = 0; v < sums.size(); ++v)
            if (const double length = glm::length(sums[v]); length > 0.0)
                normals[v] = sums[v] / length;
    }
    return normals;
}

/// Moves every point and joint by the joints' maps, skin by their painted mean.
PaintedBody moved(const PaintedBody& body,
                  const std::function<glm::dvec3(std::size_t, const glm::dvec3&)>& map) {
    PaintedBody result = body;
    for (std::size_t v = 0; v < body.mesh.positions.size(); ++v)
        result.mesh.positions[v] = paintedMean<glm::dvec3>(
            body, v, [&](std::size_t joint) { return map(joint, body.mesh.positions[v]); });
    for (std::size_t j = 0; j < body.rig.joints.size(); ++j) {
        osgSkin::RestJoint& joint = result.rig.joints[j];
        joint.centre = map(j, joint.centre);
        if (joint.tip) joint.tip = map(j, *joint.tip);
    }
    return result;
}

/// The end of a joint's bone: the child that lies farthest off, or its tip.
glm::dvec3 boneEnd(const osgSkin::RestSkeleton& rig, std::size_t joint) {
    glm::dvec3 end = rig.joints[joint].tip.value_or(rig.joints[joint].centre);
    for (const int child : rig.children(static_cast<int>(joint))) {
        const glm::dvec3& centre = rig.joints[static_cast<std::size_t>(child)].centre;
        if (glm::distance(centre, rig.joints[joint].centre) >
            glm::distance(end, rig.joints[joint].centre))
            end = centre;
    }
    return end;
}

} // namespace

PaintedBody blended(const PaintedBody& from, const PaintedBody& to, double t) {
    PaintedBody result = from;
    for (std::size_t v = 0; v < result.mesh.positions.size(); ++v)
        result.mesh.positions[v] = glm::mix(from.mesh.positions[v], to.mesh.positions[v], t);
    for (std::size_t j = 0; j < result.rig.joints.size(); ++j) {
        osgSkin::RestJoint& joint = result.rig.joints[j];
        joint.centre = glm::mix(joint.centre, to.rig.joints[j].centre, t);
        if (joint.tip) joint.tip = glm::mix(*joint.tip, *to.rig.joints[j].tip, t);
    }
    return result;
}

PaintedBody thickened(PaintedBody body, double distance) {
    const std::vector<glm::dvec3> normals = smoothNormals(body.mesh);
    const std::vector<double> share = shares(body);
    for (std::size_t v = 0; v < normals.size(); ++v)
        body.mesh.positions[v] += distance * share[v] * normals[v];
    return body;
}

PaintedBody uneven(PaintedBody body, double depth, double length) {
    const std::vector<glm::dvec3> normals = smoothNormals(body.mesh);
    const std::vector<double> share = shares(body);
    const double rate = 2.0 * 3.14159265358979 / length;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        glm::dvec3& p = body.mesh.positions[v];
        const double wave = std::sin(rate * p.x) * std::cos(0.8 * rate * p.y) +
                            std::sin(0.6 * rate * p.y + rate * p.z);
        p += 0.5 * depth * wave * share[v] * normals[v];
    }
    return body;
}

PaintedBody proportioned(const PaintedBody& body, const std::map<std::string, BoneScale>& bones) {
    const osgSkin::RestSkeleton& rig = body.rig;
    std::vector<glm::dvec3> centres(rig.joints.size());
    const auto scaled = [&](std::size_t joint, const glm::dvec3& offset) {
        const BoneScale* scale = entryOf(bones, rig.joints[joint].name);
        const glm::dvec3 bone = boneEnd(rig, joint) - rig.joints[joint].centre;
        if (!scale || !(glm::length(bone) > 0.0)) return offset;
        const glm::dvec3 axis = glm::normalize(bone);
        const glm::dvec3 along = axis * glm::dot(axis, offset);
        return scale->length * along + scale->girth * (offset - along);
    };
    for (std::size_t j = 0; j < centres.size(); ++j) {
        const glm::dvec3& centre = rig.joints[j].centre;
        if (rig.joints[j].parent < 0) {
            centres[j] = centre;
            continue;
        }
        const auto parent = static_cast<std::size_t>(rig.joints[j].parent);
        centres[j] = centres[parent] + scaled(parent, centre - rig.joints[parent].centre);
    }
    return moved(body, [&](std::size_t joint, const glm::dvec3& p) {
        return centres[joint] + scaled(joint, p - rig.joints[joint].centre);
    });
}

PaintedBody standing(const PaintedBody& body, const std::map<std::string, glm::dvec3>& turns) {
    const osgSkin::RestSkeleton& rig = body.rig;
    std::vector<glm::dmat4> matrices(rig.joints.size(), glm::dmat4(1.0));
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        const osgSkin::RestJoint& joint = rig.joints[j];
        if (joint.parent >= 0) matrices[j] = matrices[static_cast<std::size_t>(joint.parent)];
        const glm::dvec3* turn = entryOf(turns, joint.name);
        if (!turn) continue;
        const double side = joint.name.rfind("Right", 0) == 0 ? -1.0 : 1.0;
        const glm::dvec3 angles = glm::radians(*turn) * glm::dvec3(1.0, side, side);
        glm::dmat4 rotation(1.0);
        for (const int axis : {2, 1, 0}) {
            glm::dvec3 about(0.0);
            about[axis] = 1.0;
            rotation = glm::rotate(rotation, angles[axis], about);
        }
        matrices[j] *= glm::translate(glm::dmat4(1.0), joint.centre) * rotation *
                       glm::translate(glm::dmat4(1.0), -joint.centre);
    }
    return moved(body, [&](std::size_t joint, const glm::dvec3& p) {
        return glm::dvec3(matrices[joint] * glm::dvec4(p, 1.0));
    });
}

PaintedBody subdivided(const PaintedBody& body) {
    PaintedBody result = body;
    result.mesh.faceSizes.clear();
    result.mesh.faceVertices.clear();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(result.mesh.positions.size());
        const auto [entry, added] = middles.try_emplace(std::minmax(a, b), next);
        if (added) {
            result.mesh.positions.push_back(0.5 *
                                            (body.mesh.positions[a] + body.mesh.positions[b]));
            std::map<std::uint32_t, double> sums;
            for (const std::uint32_t end : {a, b})
                for (const osgSkin::JointWeight& weight : body.painted[end])
                    sums[weight.joint] += 0.5 * weight.weight;
            auto& painted = result.painted.emplace_back();
            for (const auto& [joint, weight] : sums) painted.push_back({joint, weight});
        }
        return entry->second;
    };
    const std::vector<std::uint32_t> corners = body.mesh.triangles();
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
        const std::uint32_t a = corners[t], b = corners[t + 1], c = corners[t + 2];
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const std::uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
            result.mesh.faceVertices.push_back(v);
        result.mesh.faceSizes.insert(result.mesh.faceSizes.end(), 4, 3);
    }
    return result;
}

} // namespace quality
