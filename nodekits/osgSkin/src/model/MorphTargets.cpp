// SPDX-License-Identifier: MIT
#include <osgSkin/MorphTargets>

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace osgSkin {
namespace {

/// Describes the first error of a target; empty if there is none.
std::string findError(const MorphTarget& target, std::size_t vertexCount) {
    const std::size_t count = target.vertices.size();
    const auto fits = [count](const std::vector<glm::vec3>& offsets) {
        return offsets.empty() || offsets.size() == count;
    };
    if (target.positions.size() != count || !fits(target.normals) || !fits(target.tangents))
        return "as many offsets as vertices";
    for (std::size_t i = 0; i < count; ++i)
        if (target.vertices[i] >= vertexCount ||
            (i > 0 && target.vertices[i] <= target.vertices[i - 1]))
            return "increasing vertices below " + std::to_string(vertexCount);
    for (const auto* offsets : {&target.positions, &target.normals, &target.tangents})
        for (const glm::vec3& offset : *offsets)
            if (!isInRange(offset)) return "offsets from -1e18 to 1e18";
    return std::isfinite(target.initial) ? "" : "a finite initial weight";
}

} // namespace

MorphTargets::MorphTargets(const MorphTargets& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), _targets(other._targets), _reach(other._reach),
      _vertexCount(other._vertexCount) {}

MorphTargets::~MorphTargets() = default;

osg::ref_ptr<const MorphTargets> MorphTargets::create(std::vector<MorphTarget> targets,
                                                      std::size_t vertexCount) {
    const osg::ref_ptr<MorphTargets> result = new MorphTargets;
    result->set(std::move(targets), vertexCount);
    return result;
}

void MorphTargets::set(std::vector<MorphTarget> targets, std::size_t vertexCount) {
    std::set<std::string> names;
    std::vector<double> reaches;
    for (const MorphTarget& target : targets) {
        const std::string where = "morph target \"" + target.name + "\": expected ";
        if (target.name.empty()) throw Error(where + "a name");
        if (!names.insert(target.name).second) throw Error(where + "a name of its own");
        const std::string wrong = findError(target, vertexCount);
        if (!wrong.empty()) throw Error(where + wrong);
        double reach = 0.0;
        for (const glm::vec3& offset : target.positions)
            reach = std::max(reach, glm::length(glm::dvec3(offset)));
        reaches.push_back(reach);
    }
    _targets = std::move(targets);
    _reach = std::move(reaches);
    _vertexCount = vertexCount;
}

std::size_t MorphTargets::find(const std::string& name) const {
    std::size_t i = 0;
    while (i < _targets.size() && _targets[i].name != name) ++i;
    return i;
}

std::vector<float> MorphTargets::initialWeights() const {
    std::vector<float> result;
    result.reserve(_targets.size());
    for (const MorphTarget& target : _targets) result.push_back(target.initial);
    return result;
}

void MorphTargets::applyRules(const std::vector<float>& weights, std::vector<float>& shown) const {
    using Override = ExpressionRules::Override;
    using Part = ExpressionRules::Part;
    shown = weights;
    float blink = 1.0f, lookAt = 1.0f, mouth = 1.0f;
    const auto override = [](Override kind, float weight, float& left) {
        if (kind == Override::Blend) left -= weight;
        if (kind == Override::Block && weight > 0.0f) left = 0.0f;
        left = std::max(left, 0.0f);
    };
    for (std::size_t i = 0; i < _targets.size(); ++i) {
        const ExpressionRules& rules = _targets[i].rules;
        if (rules.isBinary) shown[i] = shown[i] > 0.5f ? 1.0f : 0.0f;
        override(rules.blink, shown[i], blink);
        override(rules.lookAt, shown[i], lookAt);
        override(rules.mouth, shown[i], mouth);
    }
    for (std::size_t i = 0; i < _targets.size(); ++i) {
        const ExpressionRules& rules = _targets[i].rules;
        if (rules.part == Part::None) continue;
        const float left = rules.part == Part::Blink    ? blink
                           : rules.part == Part::LookAt ? lookAt
                                                        : mouth;
        if (left < 1.0f) shown[i] *= rules.isBinary ? 0.0f : left;
    }
}

double MorphTargets::reach(const std::vector<float>& weights) const {
    double result = 0.0;
    for (std::size_t i = 0; i < _targets.size(); ++i)
        result += std::abs(double(weights[i]) - double(_targets[i].initial)) * _reach[i];
    return result;
}

} // namespace osgSkin
