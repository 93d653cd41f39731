// SPDX-License-Identifier: MIT
#include "assimp/FbxModels.h"

#include "files/FileText.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

using Id = FbxModels::Id;

constexpr double kNoPivot = 1e-6; ///< sum of lengths

const char* const kChannels[] = {"Lcl Translation", "Lcl Rotation", "Lcl Scaling"};

glm::dvec3 vectorOf(const FbxRecord& object, const char* name, const glm::dvec3& otherwise) {
    const FbxRecord* const property = object.property(name);
    if (property == nullptr || property->values.size() < 7) return otherwise;
    const glm::dvec3 result(property->values[4].number, property->values[5].number,
                            property->values[6].number);
    return std::isfinite(glm::length(result)) ? result : otherwise;
}

int numberOf(const FbxRecord& object, const char* name, int otherwise) {
    const FbxRecord* const property = object.property(name);
    return property == nullptr || property->values.size() < 5
               ? otherwise
               : static_cast<int>(property->values[4].integer);
}

/// An object's name: "Model::Body" in text files, "Body", a zero byte and "Model" in binary ones.
std::string nameOf(const FbxRecord& object) {
    if (object.values.size() < 2) return {};
    const std::string& text = object.values[1].text;
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        return text.substr(0, zero);
    const std::size_t colons = text.find("::");
    return colons == std::string::npos ? text : text.substr(colons + 2);
}

Id idOf(const FbxRecord& object) {
    return object.values.empty() ? 0 : object.values.front().integer;
}

/// A rotation by Euler angles in degrees.
/// \param order FBX's number of it; 0: about x first, then y, then z
glm::dquat rotationBy(const glm::dvec3& degrees, int order) {
    static constexpr int kOrders[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0},
                                         {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};
    const int* const axes = kOrders[order >= 0 && order < 6 ? order : 0];
    glm::dquat result(1.0, 0.0, 0.0, 0.0);
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 axis(0.0);
        axis[axes[k]] = 1.0;
        result = glm::angleAxis(glm::radians(degrees[axes[k]]), axis) * result;
    }
    return result;
}

} // namespace

glm::dmat4 matrixOf(const glm::dvec3& translation, const glm::dquat& rotation,
                    const glm::dvec3& scale) {
    glm::dmat4 result = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
    result[3] = glm::dvec4(translation, 1.0);
    return result;
}

FbxModel::FbxModel(const FbxRecord& object)
    : name(nameOf(object)), own{vectorOf(object, kChannels[Translation], glm::dvec3(0.0)),
                                vectorOf(object, kChannels[Rotation], glm::dvec3(0.0)),
                                vectorOf(object, kChannels[Scaling], glm::dvec3(1.0))},
      rotationOffset(vectorOf(object, "RotationOffset", glm::dvec3(0.0))),
      rotationPivot(vectorOf(object, "RotationPivot", glm::dvec3(0.0))),
      scalingOffset(vectorOf(object, "ScalingOffset", glm::dvec3(0.0))),
      scalingPivot(vectorOf(object, "ScalingPivot", glm::dvec3(0.0))),
      ignoresParentsScale(numberOf(object, "InheritType", 1) == 2),
      inheritsAsNode(numberOf(object, "InheritType", 1) == 1),
      geometric(matrixOf(vectorOf(object, "GeometricTranslation", glm::dvec3(0.0)),
                         rotationBy(vectorOf(object, "GeometricRotation", glm::dvec3(0.0)), 0),
                         vectorOf(object, "GeometricScaling", glm::dvec3(1.0)))) {
    if (numberOf(object, "RotationActive", 0) == 0) return;
    order = numberOf(object, "RotationOrder", 0);
    before = rotationBy(vectorOf(object, "PreRotation", glm::dvec3(0.0)), 0);
    after = glm::conjugate(rotationBy(vectorOf(object, "PostRotation", glm::dvec3(0.0)), 0));
}

bool FbxModel::hasPivots() const {
    double sum = 0.0;
    for (const glm::dvec3& v : {rotationOffset, rotationPivot, scalingOffset, scalingPivot})
        sum += glm::length(v);
    return sum > kNoPivot;
}

NodeTransform FbxModel::transform(const FbxLocal& local, const glm::dvec3& parentsScale) const {
    const glm::dvec3& scale = local[Scaling];
    NodeTransform result;
    result.rotation = before * rotationBy(local[Rotation], order) * after;
    result.translation =
        local[Translation] + rotationOffset + rotationPivot +
        result.rotation * (scalingOffset + scalingPivot - rotationPivot - scale * scalingPivot);
    result.scale = scale;
    if (!ignoresParentsScale || parentsScale == glm::dvec3(1.0)) return result;
    if (parentsScale.x == parentsScale.y && parentsScale.y == parentsScale.z) {
        result.scale /= parentsScale.x;
        return result;
    }
    glm::dmat4 matrix = matrixOf({}, result.rotation, scale);
    for (int axis = 0; axis < 3; ++axis) matrix[axis] /= glm::dvec4(parentsScale, 1.0);
    const NodeTransform parts = decompose(matrix);
    result.rotation = parts.rotation;
    result.scale = parts.scale;
    return result;
}

glm::dvec3 FbxCurves::at(double time) const {
    glm::dvec3 result = constant;
    for (int axis = 0; axis < 3; ++axis)
        if (const FbxCurve* const curve = axes[static_cast<std::size_t>(axis)])
            result[axis] = curve->at(time);
    return result;
}

FbxModels::FbxModels(const FbxDocument& document) {
    for (const FbxRecord& object : document.objects) {
        const Id id = idOf(object);
        if (id == 0) continue;
        if (object.name == "Model") models.emplace(id, object);
        if (object.name == "AnimationCurve") {
            FbxCurve curve(object);
            if (!curve.keys().empty()) _curves.emplace(id, std::move(curve));
        }
        if (object.name == "AnimationStack") {
            _stackOf.emplace(id, stacks.size());
            FbxStack& stack = stacks.emplace_back();
            stack.name = nameOf(object);
            const auto time = [&object](const char* name) {
                const FbxRecord* const property = object.property(name);
                return property == nullptr || property->values.size() < 5
                           ? 0.0
                           : property->values[4].number / kFbxTicks;
            };
            stack.start = time("LocalStart");
            stack.stop = time("LocalStop");
        }
        if (object.name == "AnimationCurveNode") _curveNodes.emplace(id, &object);
        if (object.name == "Deformer") _deformers.emplace(id, &object);
        if (object.name == "Geometry") _geometries.insert(id);
    }
    connect(document.connections);
}

/// The curves of a node of curves, and the constants of its axes without one.
FbxCurves FbxModels::curvesOf(Id node, const std::array<const FbxCurve*, 3>& axes,
                              const glm::dvec3& own) const {
    FbxCurves curves;
    curves.axes = axes;
    curves.constant = own;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string name = std::string("d|") + char('X' + axis);
        const FbxRecord* const value = _curveNodes.at(node)->property(name);
        if (value != nullptr && value->values.size() > 4 && std::isfinite(value->values[4].number))
            curves.constant[axis] = value->values[4].number;
    }
    return curves;
}

/// Keeps where the joints of clusters were when their geometries were bound.
/// `deformed` has of a cluster its skin, and of a skin its geometry.
void FbxModels::addBinds(const std::map<Id, const FbxModel*>& joints,
                         const std::map<Id, Id>& deformed) {
    for (const auto& [cluster, joint] : joints) {
        const auto skin = deformed.find(cluster);
        const auto geometry = skin == deformed.end() ? skin : deformed.find(skin->second);
        const std::vector<double>& link = _deformers.at(cluster)->list("TransformLink");
        if (geometry == deformed.end() || link.size() != 16) continue;
        glm::dmat4 bind;
        for (int i = 0; i < 16; ++i) bind[i / 4][i % 4] = link[static_cast<std::size_t>(i)];
        const double volume = glm::determinant(bind);
        if (!std::isfinite(volume) || volume == 0.0) continue;
        _binds[geometry->second].emplace(joint, bind);
    }
}

void FbxModels::connect(const std::vector<FbxRecord>& connections) {
    std::map<Id, Id> layerOfNode, stackOfLayer, deformed;   // deformed: see addBinds()
    std::map<Id, std::pair<FbxModel*, std::size_t>> target; // of a curve node
    std::map<Id, std::array<const FbxCurve*, 3>> axes;
    std::vector<Id> order;                // of curve nodes
    std::map<Id, const FbxModel*> joints; // of a cluster
    std::multimap<Id, FbxModel*> shown;   // of a geometry
    for (const FbxRecord& c : connections) {
        if (c.values.size() < 3) continue;
        const Id from = c.values[1].integer, to = c.values[2].integer;
        const std::string property = c.values.size() > 3 ? c.values[3].text : std::string();
        const auto child = models.find(from), model = models.find(to);
        if (child != models.end() && property.empty()) {
            if (model != models.end()) {
                child->second.parent = &model->second;
                model->second.children.push_back(&child->second);
            } else if (to == 0) {
                roots.push_back(&child->second);
            } else if (_deformers.count(to) != 0) {
                joints.emplace(to, &child->second);
            }
        } else if (_deformers.count(from) != 0) {
            deformed.emplace(from, to);
        } else if (_geometries.count(from) != 0 && model != models.end()) {
            shown.emplace(from, &model->second);
        } else if (_curveNodes.count(from) != 0 && model != models.end()) {
            for (std::size_t channel = 0; channel < 3; ++channel)
                if (property == kChannels[channel]) {
                    target[from] = {&model->second, channel};
                    order.push_back(from);
                }
        } else if (_curveNodes.count(from) != 0) {
            layerOfNode.emplace(from, to);
        } else if (const auto curve = _curves.find(from); curve != _curves.end()) {
            if (property.size() == 3 && property[2] >= 'X' && property[2] <= 'Z')
                axes[to][static_cast<std::size_t>(property[2] - 'X')] = &curve->second;
        } else if (_stackOf.count(to) != 0) {
            stackOfLayer.emplace(from, to);
        }
    }
    std::map<std::size_t, std::set<Id>> unused; // layers
    for (const Id id : order) {
        const auto layer = layerOfNode.find(id);
        if (layer == layerOfNode.end() || axes.count(id) == 0) continue;
        const auto stack = stackOfLayer.find(layer->second);
        if (stack == stackOfLayer.end()) continue;
        const auto [model, channel] = target.at(id);
        const std::size_t s = _stackOf.at(stack->second);
        const FbxCurves curves = curvesOf(id, axes.at(id), model->own[channel]);
        if (!stacks[s].moves[model].emplace(channel, curves).second)
            unused[s].insert(layer->second);
    }
    for (const auto& [s, layers] : unused) stacks[s].unusedLayers = layers.size();
    addBinds(joints, deformed);
    for (const auto& [geometry, model] : shown)
        if (const auto binds = _binds.find(geometry); binds != _binds.end())
            model->binds = &binds->second;
    _curveNodes.clear();
    _deformers.clear();
}

void FbxModels::checkNodes(const std::string& path, const ReadLimits& limits) const {
    struct Open {
        const FbxModel* model;
        std::size_t depth;
    };
    std::vector<Open> open;
    std::size_t nodes = 0;
    const auto add = [&](const std::vector<FbxModel*>& below, std::size_t depth) {
        nodes += below.size();
        if (nodes > limits.joints)
            failFile(path, "has more than " + std::to_string(limits.joints) +
                               " models, each counted once for each connection to one above "
                               "(option maxJoints)");
        for (const FbxModel* const model : below) open.push_back({model, depth});
    };
    add(roots, 1);
    while (!open.empty()) {
        const auto [model, depth] = open.back();
        open.pop_back();
        if (depth > limits.depth)
            failFile(path, "model " + inQuotes(model->name) + " is nested more than " +
                               std::to_string(limits.depth) + " deep (option maxDepth)");
        add(model->children, depth + 1);
    }
}

} // namespace osgSkin
