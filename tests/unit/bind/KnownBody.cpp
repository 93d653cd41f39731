// SPDX-License-Identifier: GPL-3.0-or-later
#include "KnownBody.h"

#include "SharedBody.h"
#include "mesh/SurfaceTree.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <fstream>

using namespace osgSkin;

namespace {

/// Joints of a BVH file's hierarchy, at their accumulated offsets.
RestSkeleton readBvhJoints(const std::filesystem::path& file) {
    RestSkeleton skeleton;
    std::vector<int> open; // -1 for an end site
    std::ifstream in(file);
    std::string word, name;
    while (in >> word && word != "MOTION") {
        if (word == "ROOT" || word == "JOINT") {
            in >> name;
            const int parent = open.empty() ? -1 : open.back();
            open.push_back(static_cast<int>(skeleton.joints.size()));
            skeleton.joints.push_back({name, parent, glm::dvec3(0.0), {}});
        } else if (word == "End") {
            open.push_back(-1);
        } else if (word == "OFFSET") {
            glm::dvec3 offset;
            in >> offset.x >> offset.y >> offset.z;
            if (open.back() < 0) continue;
            RestJoint& joint = skeleton.joints[static_cast<std::size_t>(open.back())];
            joint.centre = offset;
            if (joint.parent >= 0)
                joint.centre += skeleton.joints[static_cast<std::size_t>(joint.parent)].centre;
        } else if (word == "}") {
            open.pop_back();
        }
    }
    return skeleton;
}

} // namespace

KnownBody KnownBody::thrower() {
    return {shared::readObj(OSGSKIN_DATA "/thrower.obj"),
            readBvhJoints(OSGSKIN_DATA "/thrower.bvh")};
}

KnownBody KnownBody::shared(const std::string& mesh, const std::string& rig) {
    const auto meshFile = ::shared::makehuman() / "body" / (mesh + ".obj");
    const auto rigFile = ::shared::makehuman() / "rig" / ("joints_" + rig + ".json");
    if (!std::filesystem::exists(meshFile) || !std::filesystem::exists(rigFile)) return {};
    KnownBody body{::shared::readObj(meshFile), ::shared::readJoints(rigFile)};
    for (RestJoint& joint : body.truth.joints) {
        // The only joint with several names in CMU's files.
        const std::size_t at = joint.name.find("HandFinger1");
        if (at != std::string::npos) joint.name.replace(at, 11, "HandIndex1");
    }
    return body;
}

KnownBody KnownBody::mapped(const std::function<glm::dvec3(const glm::dvec3&)>& map) const {
    KnownBody result = *this;
    for (glm::dvec3& p : result.mesh.positions) p = map(p);
    for (RestJoint& joint : result.truth.joints) joint.centre = map(joint.centre);
    return result;
}

KnownBody KnownBody::posed(const std::map<std::string, glm::dquat>& turns) const {
    const Binding binding = bind(mesh, truth);
    std::map<std::string, glm::dmat4> world;
    for (const RestJoint& joint : truth.joints) {
        glm::dmat4 matrix(1.0);
        if (joint.parent >= 0)
            matrix = world.at(truth.joints[static_cast<std::size_t>(joint.parent)].name);
        const auto turn = turns.find(joint.name);
        if (turn != turns.end())
            matrix = matrix * glm::translate(glm::dmat4(1.0), joint.centre) *
                     glm::mat4_cast(turn->second) * glm::translate(glm::dmat4(1.0), -joint.centre);
        world[joint.name] = matrix;
    }
    std::vector<glm::dmat4> skinning;
    for (const BoundJoint& joint : binding.joints) skinning.push_back(world.at(joint.name));
    KnownBody result = *this;
    result.mesh.positions = deform(binding, mesh.positions, skinning);
    for (RestJoint& joint : result.truth.joints)
        joint.centre = glm::dvec3(world.at(joint.name) * glm::dvec4(joint.centre, 1.0));
    return result;
}

FitErrors fitErrors(const RestSkeleton& fitted, const KnownBody& body, bool zUp) {
    double low = body.mesh.positions.front()[zUp ? 2 : 1], high = low;
    for (const glm::dvec3& p : body.mesh.positions) {
        low = std::min(low, p[zUp ? 2 : 1]);
        high = std::max(high, p[zUp ? 2 : 1]);
    }
    const WeldedMesh welded(body.mesh);
    const WindingTree skin(welded.positions, welded.triangles);
    FitErrors errors;
    for (const RestJoint& joint : fitted.joints) {
        if (skin.inside(joint.centre)) ++errors.inside;
        const int known = body.truth.find(joint.name);
        if (known < 0) continue;
        ++errors.joints;
        const double error =
            glm::distance(body.truth.joints[static_cast<std::size_t>(known)].centre, joint.centre) /
            (high - low);
        errors.mean += error;
        if (error < errors.worst) continue;
        errors.worst = error;
        errors.worstJoint = joint.name;
    }
    errors.mean /= static_cast<double>(errors.joints);
    return errors;
}
