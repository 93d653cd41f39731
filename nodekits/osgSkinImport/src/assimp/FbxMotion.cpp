// SPDX-License-Identifier: MIT
#include "assimp/FbxMotion.h"

#include "files/FileText.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kHold = FbxStack::kRounding; ///< before a step: the last sample of the old value
constexpr double kTolerance = 1e-6;
constexpr double kUneven = 1e-3; ///< of scale that is visible

/// Whether straight lines between the keys, and shortest rotations, are not what the file says.
bool isCurved(const FbxCurve& curve) {
    const std::vector<FbxCurve::Key>& keys = curve.keys();
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
        const bool isStep = keys[k].kind == FbxCurve::Key::Kind::Constant ||
                            keys[k].kind == FbxCurve::Key::Kind::ConstantNext;
        if (isStep && keys[k].value != keys[k + 1].value) return true;
        if (keys[k + 1].time - keys[k].time > kDenseKeys && curve.isCurved(k)) return true;
    }
    return false;
}

bool isFarApart(const FbxCurves& rotation) {
    constexpr double kSmall = 2.0, kHalfTurn = 179.0; // degrees
    std::set<double> times;
    for (const FbxCurve* curve : rotation.axes)
        if (curve != nullptr)
            for (const FbxCurve::Key& key : curve->keys()) times.insert(key.time);
    if (times.empty()) return false;
    for (auto time = times.begin(); std::next(time) != times.end(); ++time) {
        const double next = *std::next(time);
        if (next - *time <= kDenseKeys) continue;
        const glm::dvec3 change = glm::abs(rotation.at(next) - rotation.at(*time));
        int axes = 0;
        for (int axis = 0; axis < 3; ++axis) axes += change[axis] > kSmall;
        if (axes > 1 || std::max({change.x, change.y, change.z}) > kHalfTurn) return true;
    }
    return false;
}

class Corrector {
public:
    Corrector(FbxModels& document, const std::string& path, const ReadLimits& limits,
              SourceScene& scene)
        : _document(document), _path(path), _scene(scene), _samples(limits.samplesOf(scene.bytes)) {
    }

    void run() {
        for (std::size_t a = 0; a < _scene.animations.size(); ++a)
            _unused.emplace(_scene.animations[a]->name, a);
        _isFound.resize(_scene.nodes.size(), false);
        findNodes(_document.roots, 0, false);
        if (!_apart.empty())
            warn(_path,
                 "the uneven scale above " + inQuotes(_apart.front()) +
                     (_apart.size() > 1 ? " and " + std::to_string(_apart.size() - 1) + " more"
                                        : "") +
                     " is inherited by another rule in the file (InheritType RrSs or Rrs) "
                     "than here, where it shears: apply the scale in the program that made "
                     "the file");
        for (FbxStack& stack : _document.stacks) correct(stack);
        correctRest();
    }

private:
    /// Finds the models' nodes: Assimp appends a counter to names that are not unique.
    /// \param isUneven whether what is above is scaled unevenly
    void findNodes(const std::vector<FbxModel*>& models, int above, bool isUneven) {
        constexpr std::size_t kMaxDigits = 10; // of a counter
        struct Nodes {
            std::vector<int> all; ///< in the order of the file
            std::size_t next = 0;
        };
        std::unordered_map<std::string_view, Nodes> byName; // with none or some of its last digits
        for (const int n : _scene.nodes[static_cast<std::size_t>(above)].children) {
            std::string_view name = _scene.nodes[static_cast<std::size_t>(n)].name;
            for (std::size_t digits = 0; digits <= kMaxDigits; ++digits) {
                byName[name].all.push_back(n);
                if (name.empty() || name.back() < '0' || name.back() > '9') break;
                name.remove_suffix(1);
            }
        }
        for (FbxModel* const model : models) {
            Nodes& nodes = byName[model->name];
            while (nodes.next < nodes.all.size() &&
                   _isFound[static_cast<std::size_t>(nodes.all[nodes.next])])
                ++nodes.next;
            if (nodes.next == nodes.all.size()) continue;
            model->node = nodes.all[nodes.next];
            _isFound[static_cast<std::size_t>(model->node)] = true;
            if (isUneven && !model->inheritsAsNode) _apart.push_back(model->name);
            const glm::dvec3& scale = model->own[Scaling];
            findNodes(model->children, model->node,
                      isUneven || std::max({scale.x, scale.y, scale.z}) -
                                          std::min({scale.x, scale.y, scale.z}) >
                                      kUneven);
        }
    }

    SourceNode& nodeOf(const FbxModel& model) {
        return _scene.nodes[static_cast<std::size_t>(model.node)];
    }

    static glm::dvec3 parentsScaleAt(const FbxModel& model, const FbxStack* stack, double time) {
        if (model.parent == nullptr) return glm::dvec3(1.0);
        if (stack != nullptr)
            if (const auto moves = stack->moves.find(model.parent); moves != stack->moves.end())
                if (const auto scale = moves->second.find(Scaling); scale != moves->second.end())
                    return scale->second.at(time);
        return model.parent->own[Scaling];
    }

    /// Whether an animation scales the parent of a model that does not inherit its scale.
    static bool isCompensated(const FbxModel& model, const FbxStack& stack) {
        if (!model.ignoresParentsScale || model.parent == nullptr) return false;
        const auto above = stack.moves.find(model.parent);
        if (above == stack.moves.end() || above->second.count(Scaling) == 0) return false;
        const FbxCurves& scale = above->second.at(Scaling);
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
    static bool isWrong(const FbxModel& model, const FbxMoves& moves, const FbxStack& stack) {
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

    /// Whether Assimp's track has fewer keys than the file: Assimp 5.4 loses keys of rotations.
    static bool lacksKeys(const SourceTrack& track, const FbxMoves& moves, const FbxStack& stack) {
        for (const auto& [channel, curves] : moves) {
            std::set<double> times;
            for (const FbxCurve* curve : curves.axes)
                if (curve != nullptr)
                    for (const FbxCurve::Key& key : curve->keys())
                        if (stack.isInRange(key.time)) times.insert(key.time);
            const std::size_t keys = channel == Rotation      ? track.rotations.size()
                                     : channel == Translation ? track.positions.size()
                                                              : track.scales.size();
            if (keys < times.size()) return true;
        }
        return false;
    }

    /// The scene's animation that Assimp made of a stack; a new one if it made none.
    SourceAnimation& animationOf(const FbxStack& stack) {
        const auto found = _unused.lower_bound(stack.name); // of several, the first
        if (found != _unused.end() && found->first == stack.name) {
            auto& animation = _scene.animations[found->second];
            const auto copy = std::make_shared<SourceAnimation>(*animation);
            _unused.erase(found);
            animation = copy;
            return *copy;
        }
        const auto added = std::make_shared<SourceAnimation>();
        added->name = stack.name;
        added->ticksPerSecond = 1000.0;
        _scene.animations.push_back(added);
        return *added;
    }

    void correct(FbxStack& stack) {
        // Models that a moving parent's scale affects move, too.
        for (const auto& [model, moves] : stack.moves)
            if (moves.count(Scaling) != 0)
                for (const FbxModel* const child : model->children)
                    if (isCompensated(*child, stack)) stack.moves[child];
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
        std::map<std::string, std::size_t> tracks; // by node
        for (std::size_t t = 0; t < animation.tracks.size(); ++t)
            tracks.emplace(animation.tracks[t].node, t);
        for (const auto& [model, moves] : stack.moves) {
            if (model->node < 0) continue;
            const auto old = tracks.find(nodeOf(*model).name);
            const bool isKnown = old != tracks.end();
            if (!isWrong(*model, moves, stack) &&
                !(isKnown && lacksKeys(animation.tracks[old->second], moves, stack)))
                continue;
            SourceTrack track = sampled(*model, moves, stack, first, animation.ticksPerSecond);
            if (isKnown)
                animation.tracks[old->second] = std::move(track);
            else
                animation.tracks.push_back(std::move(track));
        }
    }

    /// When to sample a model, and the time whose values to take: at a step, both of its values.
    std::map<double, double> timesOf(const FbxModel& model, const FbxMoves& moves,
                                     const FbxStack& stack) {
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
            if (stack.isInRange(time)) result.emplace(time, source);
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
            const double pieces = std::ceil((keys[k + 1] - keys[k]) / kSampleStep - 1e-6);
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

    SourceTrack sampled(const FbxModel& model, const FbxMoves& moves, const FbxStack& stack,
                        double first, double ticksPerSecond) {
        SourceTrack track;
        track.node = nodeOf(model).name;
        std::map<double, double> times = timesOf(model, moves, stack);
        if (times.empty()) times.emplace(first, first);
        for (const auto& [time, source] : times) {
            FbxLocal local = model.own;
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
    void moveMeshes(const FbxModel& model, const glm::dmat4& toScene) {
        std::map<std::string, glm::dmat4> binds;
        if (model.binds != nullptr) {
            use(model.binds->size());
            for (const auto& [joint, bind] : *model.binds)
                if (joint->node >= 0) binds.emplace(nodeOf(*joint).name, bind);
        }
        std::vector<std::size_t> still;
        for (std::size_t& index : nodeOf(model).meshes) {
            if (_scene.meshes[index]->bones.empty()) {
                still.push_back(index);
                continue;
            }
            use(_scene.meshes[index]->positions.size());
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

    void use(std::size_t samples) {
        if (samples > _samples)
            failFile(_path, "skins are shown by too many models for a file of its size (option "
                            "maxSamples)");
        _samples -= samples;
    }

    FbxModels& _document;
    const std::string& _path;
    SourceScene& _scene;
    std::vector<bool> _isFound;                      ///< [node]
    std::vector<std::string> _apart;                 ///< models that inherit uneven scale otherwise
    std::size_t _samples;                            ///< how many more may be added
    std::multimap<std::string, std::size_t> _unused; ///< animations without a stack, by name
};

} // namespace

void correctFbx(FbxModels& models, const std::string& path, const ReadLimits& limits,
                SourceScene& scene) {
    if (!models.models.empty()) Corrector(models, path, limits, scene).run();
}

} // namespace osgSkin
