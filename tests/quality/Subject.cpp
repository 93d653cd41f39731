// SPDX-License-Identifier: MIT
#include "Subject.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Deform>
#include <osgSkinBind/Bind>
#include <osgSkinCharacter/ReadWeights>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Retarget>

#include <Blending.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace quality {

PaintedBody loadBody(const std::string& body, const std::string& rig, const std::string& weights) {
    PaintedBody loaded;
    loaded.name = std::filesystem::path(body).stem().string();
    loaded.mesh = osgSkin::importMesh(body).mesh;
    loaded.rig = osgSkin::importSkeleton(rig);
    loaded.painted = osgSkin::readWeights(weights, loaded.rig, loaded.mesh.positions.size());
    return loaded;
}

namespace {

compare::SkinWeights normalised(const osgSkin::VertexWeights& painted) {
    compare::SkinWeights result;
    for (const auto& vertex : painted) {
        double sum = 0.0;
        for (const osgSkin::JointWeight& entry : vertex) sum += entry.weight;
        std::vector<compare::JointWeight> entries;
        for (const osgSkin::JointWeight& entry : vertex)
            if (sum > 0.0) entries.push_back({entry.joint, entry.weight / sum});
        if (entries.empty()) entries.push_back({0, 1.0}); // unpainted skin stays with the root
        result.add(entries);
    }
    return result;
}

/// Maps each vertex to the first one at the same position.
std::vector<std::uint32_t> firstCopies(const compare::Points& points) {
    std::map<std::array<double, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> result;
    for (std::uint32_t v = 0; v < points.size(); ++v)
        result.push_back(
            known.try_emplace({points[v].x, points[v].y, points[v].z}, v).first->second);
    return result;
}

} // namespace

Subject loadSubject(const SubjectFiles& files) {
    return makeSubject(loadBody(files.body, files.rig, files.weights), files.ratios);
}

Subject makeSubject(PaintedBody body, Ratios ratios) {
    Subject subject;
    subject.name = std::move(body.name);
    subject.mesh = std::move(body.mesh);
    subject.rig = std::move(body.rig);
    const osgSkin::SkinMesh& mesh = subject.mesh;
    subject.weights = normalised(body.painted);
    if (ratios != Ratios::Painted) subject.options.emplace();
    if (ratios == Ratios::AsPrinted) subject.options->method = osgSkin::BindOptions::Method::Paper;
    subject.binding =
        subject.options
            ? osgSkin::bind(mesh, subject.rig, *subject.options, &subject.report)
            : osgSkin::bindWeights(mesh, subject.rig, body.painted, {}, &subject.report);
    subject.rest = mesh.positions;

    const std::vector<std::uint32_t> first = firstCopies(subject.rest);
    std::vector<std::uint32_t> corners = mesh.faceVertices;
    for (std::uint32_t& corner : corners) corner = first[corner];
    subject.edges = compare::faceEdges(mesh.faceSizes, corners);
    subject.triangles = mesh.triangles();
    for (std::uint32_t& corner : subject.triangles) corner = first[corner];
    subject.normals = skinNormals(subject.rest, subject.triangles);
    subject.model = modelOf(subject);
    return subject;
}

osg::ref_ptr<const osgSkin::SkinModel> modelOf(const Subject& subject) {
    const compare::Points& rest = subject.rest;
    std::vector<std::uint32_t> source(rest.size());
    std::iota(source.begin(), source.end(), 0u);
    std::vector<glm::vec3> normals(subject.normals.begin(), subject.normals.end());
    normals.resize(rest.size(), glm::vec3(0.0f));
    for (glm::vec3& normal : normals)
        if (normal == glm::vec3(0.0f)) normal = glm::vec3(0, 1, 0); // never visible
    return osgSkin::SkinModel::create(subject.binding, {rest.begin(), rest.end()}, normals, source);
}

compare::Points skinNormals(const compare::Points& points,
                            const std::vector<std::uint32_t>& triangles) {
    compare::Points normals(points.size(), glm::dvec3(0.0));
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const glm::dvec3& a = points[triangles[t]];
        const glm::dvec3 area =
            glm::cross(points[triangles[t + 1]] - a, points[triangles[t + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[triangles[t + k]] += area;
    }
    for (glm::dvec3& normal : normals)
        if (const double length = glm::length(normal); length > 0.0) normal /= length;
    return normals;
}

int Subject::joint(const std::string& wanted) const {
    static const std::map<std::string, std::string> kElsewhere = {
        {"Arm", "upperarm"}, {"ForeArm", "lowerarm"}, {"Hand", "hand"},
        {"UpLeg", "thigh"},  {"Leg", "calf"},         {"Foot", "foot"}};
    if (const int found = rig.find(wanted); found >= 0) return found;
    const bool left = wanted.rfind("Left", 0) == 0;
    const auto other = kElsewhere.find(wanted.substr(left ? 4 : 5));
    return other == kElsewhere.end() ? -1 : rig.find(other->second + (left ? "_l" : "_r"));
}

std::uint32_t Subject::dominantJoint(std::size_t vertex) const {
    const auto begin = weights.entries.begin() + weights.first[vertex];
    const auto end = weights.entries.begin() + weights.first[vertex + 1];
    return std::max_element(begin, end,
                            [](const auto& a, const auto& b) { return a.weight < b.weight; })
        ->joint;
}

namespace {

/// Samples first, first + step, ... below `end`, numbered as in the file: a calibration pose, if
/// any, is frame 0.
struct Clip {
    const char* name;
    const char* file;
    std::size_t first, end, step;
};

constexpr Clip kClips[] = {{"12_01", "12_01_walk_pybvh.bvh", 10, 519, 60},
                           {"124_01", "124_01_pitch_excerpt_120hz.bvh", 1, 28, 3},
                           {"01_03", "01_03.bvh", 400, 4399, 400},
                           {"01_01", "01_01.bvh", 300, 2699, 300}};

/// Maps the motions' joints to those of a game engine's rig; empty for a rig with the motions'
/// names.
std::map<std::string, std::string> jointMap(const osgSkin::RestSkeleton& rig) {
    static const std::map<std::string, std::string> kMiddle = {
        {"pelvis", "Hips"},     {"spine_01", "LowerBack"}, {"spine_02", "Spine"},
        {"spine_03", "Spine1"}, {"neck_01", "Neck"},       {"head", "Head"}};
    static const std::map<std::string, std::string> kBothSides = {
        {"clavicle", "Shoulder"}, {"upperarm", "Arm"}, {"lowerarm", "ForeArm"},
        {"hand", "Hand"},         {"thigh", "UpLeg"},  {"calf", "Leg"},
        {"foot", "Foot"},         {"ball", "ToeBase"}};
    std::map<std::string, std::string> map = kMiddle;
    for (const auto& [name, motion] : kBothSides) {
        map[name + "_l"] = "Left" + motion;
        map[name + "_r"] = "Right" + motion;
    }
    for (auto entry = map.begin(); entry != map.end();)
        entry = rig.find(entry->first) < 0 ? map.erase(entry) : std::next(entry);
    return map;
}

} // namespace

std::vector<NamedPose> standardPoses(const std::string& folder, const Subject& subject) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(subject.rig);
    osgSkin::BoneReader bones(subject.binding.joints, *skeleton);
    std::vector<NamedPose> poses;
    for (const Clip& entry : kClips) {
        const osgSkin::Clip clip = osgSkin::retarget(
            osgSkin::importMotion(folder + "/" + entry.file), subject.rig, {jointMap(subject.rig)});
        for (std::size_t frame = entry.first; frame < entry.end; frame += entry.step) {
            osgSkin::applyFrame(clip, subject.rig, frame, *skeleton);
            poses.push_back({entry.name + (":" + std::to_string(frame)), bones.read()});
        }
    }
    return poses;
}

namespace {

PosedSkin deformOurs(const Subject& subject, const std::vector<glm::dmat4>& skinning,
                     bool withNormals) {
    osgSkin::DeformOptions options;
    options.normals = withNormals;
    const auto [posed, normals, tangents] = osgSkin::deform(*subject.model, skinning, options);
    return {{posed.begin(), posed.end()}, {normals.begin(), normals.end()}};
}

/// Moves points and rotates normals, with one matrix per vertex.
PosedSkin deformBy(const std::vector<glm::dmat4>& matrices, const Subject& subject) {
    PosedSkin posed{compare::transformPoints(matrices, subject.rest), {}};
    for (std::size_t v = 0; v < matrices.size(); ++v) {
        const glm::dvec3 turned = glm::dmat3(matrices[v]) * subject.normals[v];
        const double length = glm::length(turned);
        posed.normals.push_back(length > 0.0 ? turned / length : turned);
    }
    return posed;
}

} // namespace

const char* nameOf(Method method) {
    constexpr std::array<const char*, 3> kNames{"LBS", "DQS", "ours"};
    return kNames[static_cast<std::size_t>(method)];
}

compare::Points deform(const Subject& subject, Method method,
                       const std::vector<glm::dmat4>& skinning) {
    switch (method) {
    case Method::Linear:
        return compare::linearBlend(subject.rest, subject.weights, skinning);
    case Method::DualQuaternion:
        return compare::dualQuaternionBlend(subject.rest, subject.weights, skinning);
    case Method::Ours:
        break;
    }
    return deformOurs(subject, skinning, false).points;
}

PosedSkin deformWithNormals(const Subject& subject, Method method,
                            const std::vector<glm::dmat4>& skinning) {
    switch (method) {
    case Method::Linear:
        return deformBy(compare::linearBlendMatrices(subject.weights, skinning), subject);
    case Method::DualQuaternion:
        return deformBy(compare::dualQuaternionBlendMatrices(subject.weights, skinning), subject);
    case Method::Ours:
        break;
    }
    return deformOurs(subject, skinning, true);
}

std::vector<glm::dmat4> singleTurn(const Subject& subject, std::size_t joint,
                                   const glm::dvec3& axis, double angle) {
    const glm::dmat4 unit(1.0);
    const glm::dvec3& centre = subject.binding.joints[joint].centre;
    const glm::dmat4 turn = glm::translate(unit, centre) * glm::rotate(unit, angle, axis) *
                            glm::translate(unit, -centre);
    std::vector<glm::dmat4> skinning(subject.rig.joints.size(), unit);
    for (std::size_t j = joint; j < skinning.size(); ++j)
        if (subject.rig.isInSubtree(static_cast<int>(j), static_cast<int>(joint)))
            skinning[j] = turn;
    return skinning;
}

} // namespace quality
