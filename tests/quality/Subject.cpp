// SPDX-License-Identifier: MIT
#include "Subject.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace quality {
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

/// For each vertex the first one of its position.
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
        if (normal == glm::vec3(0.0f)) normal = glm::vec3(0, 1, 0); // nobody looks at it
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

} // namespace quality
