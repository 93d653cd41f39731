// SPDX-License-Identifier: MIT
#include "assimp/FbxMotion.h"

#include "assimp/FbxCurve.h"
#include "assimp/FbxDocument.h"
#include "files/FileText.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using Id = std::int64_t;

constexpr double kStep = 1.0 / 30.0;  ///< seconds between samples of curves
constexpr double kDense = 1.0 / 23.0; ///< keys that are closer are nearly straight between
constexpr double kHold = 2e-6;        ///< seconds before a step: the last sample of the old value
constexpr double kTolerance = 1e-6;

const char* const kChannels[] = {"Lcl Translation", "Lcl Rotation", "Lcl Scaling"};
enum Channel : std::size_t { Translation, Rotation, Scaling };

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

/// Translation, rotation in degrees, and scale, before all else.
using Local = std::array<glm::dvec3, 3>;

glm::dmat4 matrixOf(const glm::dvec3& translation, const glm::dquat& rotation,
                    const glm::dvec3& scale) {
    glm::dmat4 result = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
    result[3] = glm::dvec4(translation, 1.0);
    return result;
}

/// A model, FBX's node.
struct Model {
    explicit Model(const FbxRecord& object)
        : name(nameOf(object)), own{vectorOf(object, kChannels[Translation], glm::dvec3(0.0)),
                                    vectorOf(object, kChannels[Rotation], glm::dvec3(0.0)),
                                    vectorOf(object, kChannels[Scaling], glm::dvec3(1.0))},
          rotationOffset(vectorOf(object, "RotationOffset", glm::dvec3(0.0))),
          rotationPivot(vectorOf(object, "RotationPivot", glm::dvec3(0.0))),
          scalingOffset(vectorOf(object, "ScalingOffset", glm::dvec3(0.0))),
          scalingPivot(vectorOf(object, "ScalingPivot", glm::dvec3(0.0))),
          ignoresParentsScale(numberOf(object, "InheritType", 1) == 2),
          geometric(matrixOf(vectorOf(object, "GeometricTranslation", glm::dvec3(0.0)),
                             rotationBy(vectorOf(object, "GeometricRotation", glm::dvec3(0.0)), 0),
                             vectorOf(object, "GeometricScaling", glm::dvec3(1.0)))) {
        if (numberOf(object, "RotationActive", 0) == 0) return;
        order = numberOf(object, "RotationOrder", 0);
        before = rotationBy(vectorOf(object, "PreRotation", glm::dvec3(0.0)), 0);
        after = glm::conjugate(rotationBy(vectorOf(object, "PostRotation", glm::dvec3(0.0)), 0));
    }

    bool hasPivots() const {
        double sum = 0.0;
        for (const glm::dvec3& v : {rotationOffset, rotationPivot, scalingOffset, scalingPivot})
            sum += glm::length(v);
        return sum > kTolerance;
    }

    bool hasGeometric() const { return geometric != glm::dmat4(1.0); }

    /// From the model's frame to its parent's.
    /// \param parentsScale which the model does not inherit
    NodeTransform transform(const Local& local, const glm::dvec3& parentsScale) const {
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

    std::string name;
    Local own;
    glm::dvec3 rotationOffset, rotationPivot, scalingOffset, scalingPivot;
    bool ignoresParentsScale;
    glm::dmat4 geometric; ///< from a mesh to the model's frame
    int order = 0;
    glm::dquat before{1.0, 0.0, 0.0, 0.0}, after{1.0, 0.0, 0.0, 0.0};
    std::map<const Model*, glm::dmat4> binds; ///< of the joints of its mesh's skin, to the scene
    const Model* parent = nullptr;
    std::vector<Model*> children; ///< in the order of connections
    int node = -1;                ///< index in the scene
};

/// A property of a model in one animation.
struct Curves {
    std::array<const FbxCurve*, 3> axes{}; ///< null: constant
    glm::dvec3 constant{0.0};

    glm::dvec3 at(double time) const {
        glm::dvec3 result = constant;
        for (int axis = 0; axis < 3; ++axis)
            if (const FbxCurve* const curve = axes[static_cast<std::size_t>(axis)])
                result[axis] = curve->at(time);
        return result;
    }
};

/// One animation of one model.
using Moves = std::map<std::size_t, Curves>; ///< by Channel

struct Stack {
    std::string name;
    double start = 0.0, stop = 0.0; ///< seconds; equal if not given
    std::map<const Model*, Moves> moves;
    std::size_t unusedLayers = 0;
};

/// The models and animations of a file, connected.
class Document {
public:
    explicit Document(const FbxDocument& document) {
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
                Stack& stack = stacks.emplace_back();
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

    std::map<Id, Model> models;
    std::vector<Model*> roots;
    std::vector<Stack> stacks;

private:
    void connect(const std::vector<FbxRecord>& connections) {
        std::map<Id, Id> layerOfNode, stackOfLayer;
        std::map<Id, std::pair<Model*, std::size_t>> target; // of a curve node
        std::map<Id, std::array<const FbxCurve*, 3>> axes;
        std::vector<Id> order;             // of curve nodes
        std::map<Id, Id> deformed;         // of a cluster its skin, and of a skin its geometry
        std::map<Id, const Model*> joints; // of a cluster
        std::multimap<Id, Model*> shown;   // of a geometry
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
            Curves curves;
            curves.axes = axes.at(id);
            curves.constant = model->own[channel];
            for (int axis = 0; axis < 3; ++axis) {
                const std::string name = std::string("d|") + char('X' + axis);
                const FbxRecord* const value = _curveNodes.at(id)->property(name);
                if (value != nullptr && value->values.size() > 4 &&
                    std::isfinite(value->values[4].number))
                    curves.constant[axis] = value->values[4].number;
            }
            if (!stacks[s].moves[model].emplace(channel, curves).second)
                unused[s].insert(layer->second);
        }
        for (const auto& [s, layers] : unused) stacks[s].unusedLayers = layers.size();
        for (const auto& [cluster, joint] : joints) {
            const auto skin = deformed.find(cluster);
            const auto geometry = skin == deformed.end() ? skin : deformed.find(skin->second);
            const std::vector<double>& link = _deformers.at(cluster)->list("TransformLink");
            if (geometry == deformed.end() || link.size() != 16) continue;
            glm::dmat4 bind;
            for (int i = 0; i < 16; ++i) bind[i / 4][i % 4] = link[static_cast<std::size_t>(i)];
            const double volume = glm::determinant(bind);
            if (!std::isfinite(volume) || volume == 0.0) continue;
            const auto [first, last] = shown.equal_range(geometry->second);
            for (auto model = first; model != last; ++model)
                model->second->binds.emplace(joint, bind);
        }
    }

    std::map<Id, FbxCurve> _curves;
    std::map<Id, const FbxRecord*> _curveNodes;
    std::map<Id, std::size_t> _stackOf;
    std::map<Id, const FbxRecord*> _deformers;
    std::set<Id> _geometries;
};

/// Whether straight lines between the keys, and shortest rotations, are not what the file says.
bool isCurved(const FbxCurve& curve) {
    const std::vector<FbxCurve::Key>& keys = curve.keys();
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
        const bool isStep = keys[k].kind == FbxCurve::Key::Kind::Constant ||
                            keys[k].kind == FbxCurve::Key::Kind::ConstantNext;
        if (isStep && keys[k].value != keys[k + 1].value) return true;
        if (keys[k + 1].time - keys[k].time > kDense && curve.isCurved(k)) return true;
    }
    return false;
}

bool isFarApart(const Curves& rotation) {
    constexpr double kSmall = 2.0, kHalfTurn = 179.0; // degrees
    std::set<double> times;
    for (const FbxCurve* curve : rotation.axes)
        if (curve != nullptr)
            for (const FbxCurve::Key& key : curve->keys()) times.insert(key.time);
    if (times.empty()) return false;
    for (auto time = times.begin(); std::next(time) != times.end(); ++time) {
        const double next = *std::next(time);
        if (next - *time <= kDense) continue;
        const glm::dvec3 change = glm::abs(rotation.at(next) - rotation.at(*time));
        int axes = 0;
        for (int axis = 0; axis < 3; ++axis) axes += change[axis] > kSmall;
        if (axes > 1 || std::max({change.x, change.y, change.z}) > kHalfTurn) return true;
    }
    return false;
}

class Corrector {
public:
    Corrector(Document& document, const std::string& path, const ReadLimits& limits,
              SourceScene& scene)
        : _document(document), _path(path), _scene(scene), _samples(limits.samplesOf(scene.bytes)) {
    }

    void run() {
        findNodes(_document.roots, 0);
        for (Stack& stack : _document.stacks) correct(stack);
        correctRest();
    }

private:
    /// Finds the models' nodes: Assimp appends a counter to names that are not unique.
    void findNodes(const std::vector<Model*>& models, int above) {
        const std::vector<int>& nodes = _scene.nodes[static_cast<std::size_t>(above)].children;
        std::set<int> known;
        for (Model* const model : models) {
            const auto found = std::find_if(nodes.begin(), nodes.end(), [&](int n) {
                const std::string& name = _scene.nodes[static_cast<std::size_t>(n)].name;
                return known.count(n) == 0 && name.rfind(model->name, 0) == 0 &&
                       name.find_first_not_of("0123456789", model->name.size()) ==
                           std::string::npos;
            });
            if (found == nodes.end()) continue;
            known.insert(*found);
            model->node = *found;
            findNodes(model->children, *found);
        }
    }

    SourceNode& nodeOf(const Model& model) {
        return _scene.nodes[static_cast<std::size_t>(model.node)];
    }

    static glm::dvec3 parentsScaleAt(const Model& model, const Stack* stack, double time) {
        if (model.parent == nullptr) return glm::dvec3(1.0);
        if (stack != nullptr)
            if (const auto moves = stack->moves.find(model.parent); moves != stack->moves.end())
                if (const auto scale = moves->second.find(Scaling); scale != moves->second.end())
                    return scale->second.at(time);
        return model.parent->own[Scaling];
    }

    /// Whether an animation scales the parent of a model that does not inherit its scale.
    static bool isCompensated(const Model& model, const Stack& stack) {
        if (!model.ignoresParentsScale || model.parent == nullptr) return false;
        const auto above = stack.moves.find(model.parent);
        if (above == stack.moves.end() || above->second.count(Scaling) == 0) return false;
        const Curves& scale = above->second.at(Scaling);
        const auto isOther = [](double value) { return std::abs(value - 1.0) > kTolerance; };
        for (int axis = 0; axis < 3; ++axis) {
            const FbxCurve* const curve = scale.axes[static_cast<std::size_t>(axis)];
            if (curve == nullptr && isOther(scale.constant[axis])) return true;
            if (curve != nullptr &&
                std::any_of(curve->keys().begin(), curve->keys().end(),
                            [&](const FbxCurve::Key& key) { return isOther(key.value); }))
                return true;
        }
        return false;
    }

    /// Whether Assimp's tracks of a model are to be replaced.
    static bool isWrong(const Model& model, const Moves& moves, const Stack& stack) {
        if (model.hasPivots() || model.hasGeometric()) return true;
        if (isCompensated(model, stack)) return true;
        if (model.ignoresParentsScale && parentsScaleAt(model, nullptr, 0.0) != glm::dvec3(1.0))
            return true;
        for (const auto& [channel, curves] : moves) {
            for (const FbxCurve* curve : curves.axes)
                if (curve != nullptr && osgSkin::isCurved(*curve)) return true;
            if (channel == Rotation && isFarApart(curves)) return true;
        }
        return false;
    }

    /// The scene's animation that Assimp made of a stack; a new one if it made none.
    SourceAnimation& animationOf(const Stack& stack) {
        for (std::size_t a = 0; a < _scene.animations.size(); ++a)
            if (_scene.animations[a]->name == stack.name && _known.count(a) == 0) {
                _known.insert(a);
                const auto copy = std::make_shared<SourceAnimation>(*_scene.animations[a]);
                _scene.animations[a] = copy;
                return *copy;
            }
        _known.insert(_scene.animations.size());
        const auto added = std::make_shared<SourceAnimation>();
        added->name = stack.name;
        added->ticksPerSecond = 1000.0;
        _scene.animations.push_back(added);
        return *added;
    }

    void correct(Stack& stack) {
        // Models that a moving parent's scale affects move, too.
        for (auto& [id, model] : _document.models)
            if (isCompensated(model, stack)) stack.moves[&model];
        if (stack.moves.empty()) return;
        SourceAnimation& animation = animationOf(stack);
        if (stack.unusedLayers > 0)
            warn(_path, "clip " + inQuotes(stack.name) + ": " + std::to_string(stack.unusedLayers) +
                            " of its layers move what others move, too; they are not read");
        const bool hasRange = stack.start != stack.stop;
        double first = stack.start;
        if (!hasRange) {
            first = std::numeric_limits<double>::infinity();
            for (const auto& [model, moves] : stack.moves)
                for (const auto& [channel, curves] : moves)
                    for (const FbxCurve* curve : curves.axes)
                        if (curve != nullptr) first = std::min(first, curve->keys().front().time);
        }
        for (const auto& [model, moves] : stack.moves) {
            if (model->node < 0 || !isWrong(*model, moves, stack)) continue;
            SourceTrack track = sampled(*model, moves, stack, first, animation.ticksPerSecond);
            const auto old = std::find_if(
                animation.tracks.begin(), animation.tracks.end(),
                [&track](const SourceTrack& known) { return known.node == track.node; });
            if (old != animation.tracks.end())
                *old = std::move(track);
            else
                animation.tracks.push_back(std::move(track));
        }
    }

    /// When to sample a model, and the time whose values to take: at a step, both of its values.
    std::map<double, double> timesOf(const Model& model, const Moves& moves, const Stack& stack) {
        std::vector<const FbxCurve*> all;
        bool isCurved = false;
        for (const auto& [channel, curves] : moves)
            for (const FbxCurve* curve : curves.axes) {
                if (curve == nullptr) continue;
                all.push_back(curve);
                isCurved = isCurved || channel == Rotation || osgSkin::isCurved(*curve);
            }
        if (model.ignoresParentsScale && model.parent != nullptr)
            if (const auto above = stack.moves.find(model.parent); above != stack.moves.end())
                if (const auto scale = above->second.find(Scaling); scale != above->second.end())
                    for (const FbxCurve* curve : scale->second.axes)
                        if (curve != nullptr) {
                            all.push_back(curve);
                            isCurved = true;
                        }
        const bool hasRange = stack.start != stack.stop;
        std::map<double, double> result;
        const auto add = [&](double time, double source) {
            if (!hasRange || (time >= stack.start - kHold && time <= stack.stop + kHold))
                result.emplace(time, source);
        };
        double begin = std::numeric_limits<double>::infinity(), end = -begin;
        for (const FbxCurve* curve : all)
            for (std::size_t k = 0; k < curve->keys().size(); ++k) {
                const FbxCurve::Key& key = curve->keys()[k];
                add(key.time, key.time);
                begin = std::min(begin, key.time);
                end = std::max(end, key.time);
                const bool isStep =
                    k > 0 && curve->keys()[k - 1].kind == FbxCurve::Key::Kind::Constant;
                if (!isStep || key.time - curve->keys()[k - 1].time <= 4.0 * kHold) continue;
                add(key.time - kHold, key.time - kHold);
                add(key.time - 0.5 * kHold, key.time);
            }
        if (hasRange && begin < stack.start) add(stack.start, stack.start);
        if (hasRange && end > stack.stop) add(stack.stop, stack.stop);
        if (!isCurved || result.empty()) return result;
        std::vector<double> keys;
        keys.reserve(result.size());
        for (const auto& [time, source] : result) keys.push_back(time);
        for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
            const double pieces = std::ceil((keys[k + 1] - keys[k]) / kStep - 1e-6);
            if (!(pieces < double(_samples)))
                failFile(_path, "clip " + inQuotes(stack.name) + " lasts " +
                                    std::to_string(keys[k + 1] - keys[k]) +
                                    " s between two keys, expected fewer samples (option "
                                    "maxSamples)");
            for (double piece = 1.0; piece < pieces; piece += 1.0) {
                const double time = keys[k] + piece / pieces * (keys[k + 1] - keys[k]);
                result.emplace(time, time);
            }
            if (pieces > 1.0) _samples -= static_cast<std::size_t>(pieces);
        }
        return result;
    }

    SourceTrack sampled(const Model& model, const Moves& moves, const Stack& stack, double first,
                        double ticksPerSecond) {
        SourceTrack track;
        track.node = nodeOf(model).name;
        std::map<double, double> times = timesOf(model, moves, stack);
        if (times.empty()) times.emplace(first, first);
        for (const auto& [time, source] : times) {
            Local local = model.own;
            for (const auto& [channel, curves] : moves) local[channel] = curves.at(source);
            const NodeTransform at = model.transform(local, parentsScaleAt(model, &stack, source));
            const double ticks = (time - first) * ticksPerSecond;
            glm::quat rotation(at.rotation);
            if (!track.rotations.empty() && glm::dot(track.rotations.back().value, rotation) < 0.0f)
                rotation = -rotation;
            track.positions.push_back({ticks, glm::vec3(at.translation)});
            track.rotations.push_back({ticks, rotation});
            track.scales.push_back({ticks, glm::vec3(at.scale)});
        }
        return track;
    }

    std::vector<glm::dmat4> worlds() const {
        std::vector<glm::dmat4> result; // parents come first
        for (const SourceNode& node : _scene.nodes)
            result.push_back(node.parent < 0
                                 ? node.matrix
                                 : result[static_cast<std::size_t>(node.parent)] * node.matrix);
        return result;
    }

    /// Corrects the nodes' own transforms, and their meshes.
    void correctRest() {
        const std::vector<glm::dmat4> before = worlds();
        for (const auto& [id, model] : _document.models) {
            const glm::dvec3 above = parentsScaleAt(model, nullptr, 0.0);
            if (model.node < 0 || !(model.hasPivots() || model.hasGeometric() ||
                                    (model.ignoresParentsScale && above != glm::dvec3(1.0))))
                continue;
            const NodeTransform rest = model.transform(model.own, above);
            nodeOf(model).matrix = matrixOf(rest.translation, rest.rotation, rest.scale);
        }
        const std::vector<glm::dmat4> after = worlds();
        for (const auto& [id, model] : _document.models) {
            if (model.node < 0) continue;
            const auto n = static_cast<std::size_t>(model.node);
            if (before[n] != after[n] || model.hasGeometric())
                moveMeshes(model, after[n] * model.geometric);
        }
    }

    /// Moves a model's meshes.
    /// \param toScene from the mesh to the scene
    void moveMeshes(const Model& model, const glm::dmat4& toScene) {
        std::map<std::string, glm::dmat4> binds;
        for (const auto& [joint, bind] : model.binds)
            if (joint->node >= 0) binds.emplace(nodeOf(*joint).name, bind);
        std::vector<std::size_t> still;
        for (std::size_t& index : nodeOf(model).meshes) {
            if (_scene.meshes[index]->bones.empty()) {
                still.push_back(index);
                continue;
            }
            const auto mesh = std::make_shared<SourceMesh>(*_scene.meshes[index]);
            for (SourceBone& bone : mesh->bones)
                if (const auto bind = binds.find(bone.name); bind != binds.end())
                    bone.offset = glm::inverse(bind->second) * toScene;
            _scene.meshes.push_back(mesh);
            index = _scene.meshes.size() - 1;
        }
        if (still.empty() || !model.hasGeometric()) return;
        const int node =
            _scene.addNode(nodeOf(model).name + "_geometry", model.node, model.geometric);
        auto& meshes = nodeOf(model).meshes;
        meshes.erase(
            std::remove_if(meshes.begin(), meshes.end(),
                           [&](std::size_t index) { return _scene.meshes[index]->bones.empty(); }),
            meshes.end());
        _scene.nodes[static_cast<std::size_t>(node)].meshes = still;
    }

    Document& _document;
    const std::string& _path;
    SourceScene& _scene;
    std::size_t _samples;         ///< how many more may be added
    std::set<std::size_t> _known; ///< animations with a stack
};

} // namespace

void correctFbx(const std::string& bytes, const std::string& path, const ReadLimits& limits,
                SourceScene& scene) {
    const FbxDocument document = FbxDocument::read(bytes);
    if (document.objects.empty()) return;
    Document connected(document);
    Corrector(connected, path, limits, scene).run();
}

} // namespace osgSkin
