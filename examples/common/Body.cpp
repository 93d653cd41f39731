// SPDX-License-Identifier: MIT
#include "Body.h"

#include "Blending.h"
#include "ProgressLine.h"
#include "RatioWeights.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/ReadWeights>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace figures {
namespace {

using VertexWeights = std::vector<compare::JointWeight>;

void addNormalised(compare::SkinWeights& weights, VertexWeights vertex) {
    double sum = 0.0;
    for (const compare::JointWeight& entry : vertex) sum += entry.weight;
    if (sum <= 0.0)
        vertex = {{0, 1.0}}; // not painted: follows the root
    else
        for (compare::JointWeight& entry : vertex) entry.weight /= sum;
    weights.add(vertex);
}

compare::SkinWeights painted(const std::string& file, const osgSkin::Character& character) {
    compare::SkinWeights weights;
    for (const auto& list :
         osgSkin::readWeights(file, character.rest, character.body.mesh.positions.size())) {
        VertexWeights vertex;
        for (const osgSkin::JointWeight& entry : list)
            vertex.push_back({entry.joint, entry.weight});
        addNormalised(weights, vertex);
    }
    return weights;
}

osgSkin::Character requireBody(osgSkin::Character character) {
    if (character.hasBody()) return character;
    throw osgSkin::Error(character.file +
                         ": a saved character or several; the mesh is not known. " +
                         "Load the .skin file or the model that it was made of");
}

} // namespace

osgSkin::Character load(const std::string& file, osgSkin::LoadOptions options) {
    example::ProgressLine line(file);
    options.progress = line.progress();
    return osgSkin::loadCharacter(file, options);
}

Body::Body(osgSkin::Character loaded, const std::string& weights)
    : character(requireBody(std::move(loaded))), triangles(character.body.mesh.triangles()) {
    std::vector<std::uint32_t> source(rest().size());
    std::iota(source.begin(), source.end(), 0u);
    const auto modelOf = [&](const osgSkin::Binding& binding) {
        return osgSkin::SkinModel::create(
            binding, std::vector<glm::vec3>(rest().begin(), rest().end()),
            std::vector<glm::vec3>(rest().size(), glm::vec3(0.0f, 1.0f, 0.0f)), source);
    };
    _model = modelOf(character.binding);
    osgSkin::Binding plain = character.binding;
    plain.correctives = {};
    _plain = modelOf(plain);
    _weights =
        weights.empty() ? compare::weightsOf(character.binding) : painted(weights, character);
}

std::size_t Body::find(const std::string& name) const {
    const int named = character.rest.find(name);
    const int index = named < 0 ? character.roles.joint(name) : named;
    if (index < 0)
        throw osgSkin::Error(character.file + ": no joint is called \"" + name + '"' +
                             osgSkin::expectedNames(name, character.rest.byName()));
    return static_cast<std::size_t>(index);
}

std::vector<glm::dmat4> Body::turned(std::size_t joint, const glm::dvec3& axis,
                                     double degrees) const {
    const glm::dmat4 unit(1.0);
    const glm::dvec3& centre = character.binding.joints[joint].centre;
    const glm::dmat4 rotation = glm::translate(unit, centre) *
                                glm::rotate(unit, glm::radians(degrees), axis) *
                                glm::translate(unit, -centre);
    std::vector<glm::dmat4> skinning(character.rest.joints.size(), unit);
    for (std::size_t j = joint; j < skinning.size(); ++j)
        if (character.rest.isInSubtree(static_cast<int>(j), static_cast<int>(joint)))
            skinning[j] = rotation;
    return skinning;
}

namespace {

/// Removes scale and shear, which dual quaternions cannot represent; joint positions are unchanged.
std::vector<glm::dmat4> turnsAndMoves(const std::vector<osgSkin::BoundJoint>& joints,
                                      const std::vector<glm::dmat4>& skinning) {
    std::vector<glm::dmat4> result;
    for (std::size_t j = 0; j < skinning.size(); ++j) {
        const glm::dmat4& from = skinning[j];
        const glm::dvec3 x = glm::normalize(glm::dvec3(from[0])), y(from[1]);
        const glm::dvec3 across = glm::normalize(glm::cross(x, y));
        const glm::dmat3 turn(x, glm::cross(across, x), across);
        const glm::dvec3& centre = joints[j].centre;
        glm::dmat4& to = result.emplace_back(turn);
        to[3] = glm::dvec4(glm::dvec3(from * glm::dvec4(centre, 1.0)) - turn * centre, 1.0);
    }
    return result;
}

} // namespace

std::vector<glm::dvec3> Body::deform(Method method, const std::vector<glm::dmat4>& skinning) const {
    if (method == Method::Linear) return compare::linearBlend(rest(), _weights, skinning);
    if (method == Method::DualQuaternion)
        return compare::dualQuaternionBlend(rest(), _weights,
                                            turnsAndMoves(character.binding.joints, skinning));
    osgSkin::Pose pose(character.binding.joints, character.binding.correctives.inputs.size());
    for (std::size_t i = 0; i < character.binding.correctives.inputs.size(); ++i)
        pose.setInput(i, tension);
    if (!pose.set(skinning.data(), skinning.size()))
        throw std::runtime_error("a pose cannot be set");
    const osgSkin::SkinModel& model = method == Method::Plain ? *_plain : *_model;
    const std::vector<glm::vec3> posed = osgSkin::deform(model, pose).positions;
    return {posed.begin(), posed.end()};
}

glm::dvec3 Body::toWorld(const glm::dvec3& v) const {
    return osgSkin::toGlm(osgSkin::toOsg(v) * character.toWorld);
}

glm::dvec3 Body::fromWorld(const glm::dvec3& v) const {
    return osgSkin::toGlm(osgSkin::toOsg(v) * osg::Matrixd::inverse(character.toWorld));
}

osgSkin::Influence influenceOf(const osgSkin::Binding& binding, std::size_t vertex,
                               std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint) return binding.influences[i];
    return {};
}

} // namespace figures
