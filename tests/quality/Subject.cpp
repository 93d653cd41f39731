// SPDX-License-Identifier: MIT
#include "Subject.h"

#include <WeightsFile.h>
#include <osgSkinBind/Bind>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/Motion>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numeric>

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
    Subject subject;
    subject.name = std::filesystem::path(files.body).stem().string();
    subject.mesh = osgSkin::importMesh(files.body).mesh;
    subject.rig = osgSkin::importSkeleton(files.rig);
    const osgSkin::SkinMesh& mesh = subject.mesh;
    const osgSkin::VertexWeights painted =
        osgSkin::readWeights(files.weights, subject.rig, mesh.positions.size());
    subject.weights = normalised(painted);
    osgSkin::BindOptions options;
    if (files.bindAsPrinted) options.method = osgSkin::BindOptions::Method::Paper;
    subject.binding = files.bindByWeights
                          ? osgSkin::bindWeights(mesh, subject.rig, painted, {}, &subject.report)
                          : osgSkin::bind(mesh, subject.rig, options, &subject.report);
    subject.rest = mesh.positions;
    subject.model = modelOf(subject.binding, subject.rest);

    const std::vector<std::uint32_t> first = firstCopies(subject.rest);
    std::vector<std::uint32_t> corners = mesh.faceVertices;
    for (std::uint32_t& corner : corners) corner = first[corner];
    subject.edges = compare::faceEdges(mesh.faceSizes, corners);
    subject.triangles = mesh.triangles();
    for (std::uint32_t& corner : subject.triangles) corner = first[corner];
    return subject;
}

std::shared_ptr<const osgSkin::SkinModel> modelOf(const osgSkin::Binding& binding,
                                                  const compare::Points& rest) {
    std::vector<std::uint32_t> source(rest.size());
    std::iota(source.begin(), source.end(), 0u);
    const std::vector<glm::vec3> normals(rest.size(), glm::vec3(0, 1, 0));
    return osgSkin::SkinModel::create(binding, {rest.begin(), rest.end()}, normals, source);
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
