// SPDX-License-Identifier: MIT
#include "gltf/GltfDocument.h"

#include "files/FileText.h"

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>
#include <memory>

namespace osgSkin {
namespace {

using Path = GltfAnimation::Path;
using Interpolation = GltfAnimation::Interpolation;

constexpr double kLatest = 1e35;        ///< seconds; times are stored as float milliseconds
constexpr double kStep = 1.0 / 30.0;    ///< maximum seconds between samples of a spline
constexpr double kTicksPerSecond = 1e3; ///< like Assimp's glTF reader

/// Keys of one track: `width` numbers per key.
struct Keys {
    std::size_t width = 0;
    std::vector<float> times, values;

    void add(double time, const float* value) {
        times.push_back(static_cast<float>(time));
        values.insert(values.end(), value, value + width);
    }
};

/// Returns `time` moved back by a number of floats. Steps change kHolds to kChanges floats before a
/// key's time: a sample meant to be at the key may be off by a float or two, and would otherwise be
/// a blend with the old value.
constexpr int kHolds = 4, kChanges = 3;
float earlier(float time, int floats) {
    for (; floats > 0; --floats) time = std::nextafter(time, -HUGE_VALF);
    return time;
}

/// Converts steps: a value holds until the next key.
Keys fromSteps(const Keys& track) {
    Keys result{track.width, {}, {}};
    for (std::size_t k = 0; k < track.times.size(); ++k) {
        const float* value = &track.values[k * track.width];
        const float time = track.times[k];
        const bool hasRoom = k > 0 && earlier(time, kHolds) > track.times[k - 1];
        if (hasRoom) {
            result.add(double(earlier(time, kHolds)), value - track.width);
            result.add(double(earlier(time, kChanges)), value);
        }
        if (!hasRoom || k + 1 == track.times.size()) result.add(double(time), value);
    }
    return result;
}

/// Separates keys that share a time: the first is the value before it, and the last the value
/// after.
Keys apart(const Keys& track) {
    Keys result{track.width, {}, {}};
    const std::vector<float>& times = track.times;
    for (std::size_t k = 0; k < times.size(); ++k) {
        const bool isFirst = k == 0 || times[k - 1] < times[k];
        const bool isLast = k + 1 == times.size() || times[k] < times[k + 1];
        float time = times[k];
        if (isFirst && !isLast) time = earlier(time, kHolds);
        if (isLast && !isFirst && !result.times.empty()) time = earlier(time, kChanges);
        const bool isNeeded = isFirst ? isLast || k > 0 : isLast;
        if (isNeeded && (result.times.empty() || time > result.times.back()))
            result.add(double(time), &track.values[k * track.width]);
    }
    return result;
}

/// The number of pieces a spline is split into between two times, in any order.
double piecesOf(double from, double to) {
    return std::max(1.0, std::ceil((to - from) / kStep)); // 1 for NaN
}

/// Samples cubic Hermite splines (appendix C of the specification). Each key has an in-tangent, a
/// value, and an out-tangent.
Keys fromSplines(const Keys& track, bool isRotation) {
    Keys result{track.width, {}, {}};
    const std::size_t width = track.width, last = track.times.size() - 1;
    const auto part = [&](std::size_t key, std::size_t which) {
        return &track.values[(3 * key + which) * width];
    };
    std::vector<double> value(width);
    std::vector<float> stored(width);
    for (std::size_t k = 0; k < last; ++k) {
        const double begin = double(track.times[k]), end = double(track.times[k + 1]);
        const double duration = end - begin, pieces = piecesOf(begin, end);
        for (double piece = 0.0; piece < pieces; piece += 1.0) {
            const double t = piece / pieces, t2 = t * t, t3 = t2 * t;
            double length = 0.0;
            for (std::size_t i = 0; i < width; ++i) {
                value[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * double(part(k, 1)[i]) +
                           duration * (t3 - 2.0 * t2 + t) * double(part(k, 2)[i]) +
                           (3.0 * t2 - 2.0 * t3) * double(part(k + 1, 1)[i]) +
                           duration * (t3 - t2) * double(part(k + 1, 0)[i]);
                length += value[i] * value[i];
            }
            if (isRotation && length > 0.0)
                for (double& number : value) number /= std::sqrt(length);
            std::transform(value.begin(), value.end(), stored.begin(),
                           [](double number) { return static_cast<float>(number); });
            result.add(begin + t * duration, stored.data());
        }
    }
    result.add(double(track.times[last]), part(last, 1));
    return result;
}

/// Whether keys share a time, which exporters use for steps.
bool hasTwins(const std::vector<float>& times) {
    return std::adjacent_find(times.begin(), times.end()) != times.end();
}

void checkTimes(const std::vector<float>& times, std::size_t accessor, const std::string& where) {
    for (std::size_t k = 0; k < times.size(); ++k)
        if (!(std::abs(double(times[k])) <= kLatest) || (k > 0 && times[k] < times[k - 1]))
            failFile(where, "accessors[" + std::to_string(accessor) + "]: key " +
                                std::to_string(k) + " is at " + std::to_string(times[k]) +
                                " seconds, expected times in order");
}

/// Throws unless all values are finite, tangents of splines included, and rotations are not zero.
void checkKeys(const Keys& track, std::size_t accessor, const std::string& where, bool isRotation,
               bool isSpline) {
    const std::vector<float>& values = track.values;
    const auto which = [accessor](std::size_t k) {
        return "accessors[" + std::to_string(accessor) + "]: element " + std::to_string(k);
    };
    for (std::size_t k = 0; k * track.width < values.size(); ++k) {
        bool isZero = true;
        for (std::size_t i = k * track.width; i < (k + 1) * track.width; ++i) {
            if (!(std::abs(double(values[i])) <= kLargestCoordinate)) // nor NaN
                failFile(where, which(k) + " has " + std::to_string(values[i]) +
                                    ", expected -1e18 to 1e18");
            isZero = isZero && values[i] == 0.0f;
        }
        const bool isTangent = isSpline && k % 3 != 1;
        if (isRotation && isZero && !isTangent)
            failFile(where, which(k) + " is zero, expected a rotation");
    }
}

class AnimationBuilder {
public:
    AnimationBuilder(const GltfDocument& document, const std::vector<int>& indexOf,
                     SourceScene& scene)
        : _document(document), _accessors(document.accessors), _indexOf(indexOf), _scene(scene),
          _vrm(vrmAnimationNodes(document)),
          _pieces(4.0 * double(document.file.limits.samplesOf(document.file.ownBytes))) {}

    void run() {
        bool moves = false;
        for (std::size_t a = 0; a < _document.animations.size(); ++a) {
            _scene.animations.push_back(build(_document.animations[a], a));
            const SourceAnimation& built = *_scene.animations.back();
            moves = moves || !built.tracks.empty() || !built.morphs.empty() || !built.gaze.empty();
        }
        // Keep clips without tracks if another has some: clips can be selected by their number in
        // the file.
        if (!moves) _scene.animations.clear();
    }

private:
    /// Channels of one node: the last one of each kind.
    struct NodeChannels {
        const GltfAnimation::Channel *translation = nullptr, *rotation = nullptr, *scale = nullptr,
                                     *weights = nullptr;
    };

    struct Rest {
        std::optional<glm::vec3> translation, scale;
        std::optional<glm::quat> rotation;
    };

    std::shared_ptr<const SourceAnimation> build(const GltfAnimation& from, std::size_t index) {
        const auto result = std::make_shared<SourceAnimation>();
        result->name = from.name;
        result->ticksPerSecond = kTicksPerSecond;
        _where = _document.file.path + ": animation " +
                 inQuotes(from.isNamed ? from.name : std::to_string(index)) + ": sampler ";
        _known.clear();
        std::map<std::size_t, NodeChannels> nodes;
        for (const GltfAnimation::Channel& channel : from.channels) {
            if (!channel.node || widthOf(channel) == 0) continue;
            keysOf(from, channel); // checked even if a later channel overrides it
            NodeChannels& node = nodes[*channel.node];
            (channel.path == Path::Translation ? node.translation
             : channel.path == Path::Rotation  ? node.rotation
             : channel.path == Path::Scale     ? node.scale
                                               : node.weights) = &channel;
        }
        result->tracks.reserve(nodes.size());
        for (const auto& [n, channels] : nodes) {
            if (channels.weights != nullptr) addWeights(from, *channels.weights, *result);
            if (addExpression(from, n, channels, *result)) continue;
            if (!channels.translation && !channels.rotation && !channels.scale) continue;
            SourceTrack& track = result->tracks.emplace_back();
            track.node = _document.nodes[n].name;
            const Rest rest = restOf(n);
            addVectors(from, channels.translation, rest.translation, track.positions);
            addVectors(from, channels.scale, rest.scale, track.scales);
            if (channels.rotation != nullptr) {
                addRotations(keysOf(from, *channels.rotation), track.rotations);
            } else if (rest.rotation) {
                track.rotations.push_back({0.0, *rest.rotation});
            }
        }
        return result;
    }

    /// Adds what a node of a VRM animation stands for that is no joint.
    bool addExpression(const GltfAnimation& from, std::size_t n, const NodeChannels& channels,
                       SourceAnimation& result) {
        const auto named = _vrm.expressions.find(n);
        if (named != _vrm.expressions.end() && channels.translation) {
            const Keys& keys = keysOf(from, *channels.translation);
            SourceMorphTrack& track = result.morphs.emplace_back();
            track.morph = named->second;
            for (std::size_t k = 0; k < keys.times.size(); ++k)
                track.weights.push_back({ticks(keys.times[k]), keys.values[3 * k]});
        }
        if (_vrm.gaze == n && channels.rotation)
            addRotations(keysOf(from, *channels.rotation), result.gaze);
        return named != _vrm.expressions.end() || _vrm.gaze == n;
    }

    static void addRotations(const Keys& keys, std::vector<SourceKey<glm::quat>>& result) {
        result.reserve(keys.times.size());
        for (std::size_t k = 0; k < keys.times.size(); ++k) {
            const float* q = &keys.values[4 * k];
            result.push_back({ticks(keys.times[k]), {q[3], q[0], q[1], q[2]}});
        }
    }

    /// In single precision, like Assimp's reader.
    static double ticks(float seconds) { return double(seconds * float(kTicksPerSecond)); }

    /// The transform of a node that no channel moves. For a node outside the scene, only the parts
    /// that the file gives.
    Rest restOf(std::size_t n) const {
        const GltfNode& node = _document.nodes[n];
        Rest result;
        if (_indexOf[n] >= 0) {
            if (node.hasMatrix) {
                const NodeTransform parts = decompose(node.matrix);
                return {parts.translation, parts.scale, glm::quat(parts.rotation)};
            }
            result = {glm::vec3(0.0f), glm::vec3(1.0f), glm::quat(1.0f, 0.0f, 0.0f, 0.0f)};
        }
        const std::vector<double>&t = node.translation, &r = node.rotation, &s = node.scale;
        if (!t.empty()) result.translation = glm::vec3(glm::dvec3(t[0], t[1], t[2]));
        if (!s.empty()) result.scale = glm::vec3(glm::dvec3(s[0], s[1], s[2]));
        if (!r.empty()) result.rotation = glm::quat(glm::dquat(r[3], r[0], r[1], r[2]));
        return result;
    }

    /// Adds a channel's keys; without a channel, the node's own transform.
    void addVectors(const GltfAnimation& from, const GltfAnimation::Channel* channel,
                    const std::optional<glm::vec3>& rest,
                    std::vector<SourceKey<glm::vec3>>& result) {
        if (channel != nullptr) {
            const Keys& keys = keysOf(from, *channel);
            result.reserve(keys.times.size());
            for (std::size_t k = 0; k < keys.times.size(); ++k) {
                const float* v = &keys.values[3 * k];
                result.push_back({ticks(keys.times[k]), {v[0], v[1], v[2]}});
            }
        } else if (rest) {
            result.push_back({0.0, *rest});
        }
    }

    /// Adds a track for each morph target of a node's mesh.
    void addWeights(const GltfAnimation& from, const GltfAnimation::Channel& channel,
                    SourceAnimation& result) {
        if (_indexOf[*channel.node] < 0) return; // not in the scene
        const Keys& keys = keysOf(from, channel);
        const auto& shown = _scene.nodes[std::size_t(_indexOf[*channel.node])].meshes;
        const std::vector<MorphTarget>* targets = nullptr;
        for (const std::size_t mesh : shown) {
            const std::vector<MorphTarget>& morphs = _scene.meshes[mesh]->morphs;
            if (!targets || targets->size() < morphs.size()) targets = &morphs;
        }
        if (!targets) return;
        for (std::size_t t = 0; t < std::min(keys.width, targets->size()); ++t) {
            SourceMorphTrack& track = result.morphs.emplace_back();
            track.morph = (*targets)[t].name;
            track.node = _indexOf[*channel.node];
            const auto weight = [&](std::size_t k) { return keys.values[k * keys.width + t]; };
            bool isConstant = true;
            for (std::size_t k = 1; k < keys.times.size(); ++k)
                isConstant = isConstant && weight(k) == weight(0);
            const std::size_t count = isConstant ? 1 : keys.times.size();
            track.weights.reserve(count);
            for (std::size_t k = 0; k < count; ++k)
                track.weights.push_back({ticks(keys.times[k]), weight(k)});
        }
    }

    /// Numbers in a channel's value; 0 for the weights of a mesh without morph targets.
    std::size_t widthOf(const GltfAnimation::Channel& channel) const {
        if (channel.path == Path::Rotation) return 4;
        if (channel.path != Path::Weights) return 3;
        const GltfIndex& mesh = _document.nodes[*channel.node].mesh;
        return mesh ? _document.meshes[*mesh].targetNames.size() : 0;
    }

    /// A sampler's keys, converted to linear. Channels may share a sampler.
    const Keys& keysOf(const GltfAnimation& from, const GltfAnimation::Channel& channel) {
        const auto [known, isNew] = _known.emplace(channel.sampler, Keys());
        if (isNew)
            known->second = read(from, channel, _where + std::to_string(channel.sampler));
        else if (known->second.width != widthOf(channel))
            failFile(_where + std::to_string(channel.sampler),
                     "rotations and others, expected a sampler of one kind");
        return known->second;
    }

    Keys read(const GltfAnimation& from, const GltfAnimation::Channel& channel,
              const std::string& where) {
        const GltfAnimation::Sampler& sampler = from.samplers[channel.sampler];
        const bool isRotation = channel.path == Path::Rotation;
        const bool isSpline = sampler.interpolation == Interpolation::CubicSpline;
        const std::size_t keys = _accessors[sampler.input].count, width = widthOf(channel);
        const GltfAccessor& output = _accessors[sampler.output];
        // Weights are single numbers, all of a key in a row.
        const std::size_t wide = channel.path == Path::Weights ? 1 : width;
        if (_accessors[sampler.input].width != 1 || output.width != wide ||
            output.count * wide != keys * width * (isSpline ? 3 : 1) || keys == 0)
            failFile(where, std::to_string(keys) + " keys and " + std::to_string(output.count) +
                                " values, expected " + std::to_string(width) + " numbers a key");
        Keys track{width, _accessors.floats(sampler.input), {}};
        checkTimes(track.times, sampler.input, where);
        track.values = _accessors.floats(sampler.output);
        checkKeys(track, sampler.output, where, isRotation, isSpline);
        if (sampler.interpolation == Interpolation::Step) track = fromSteps(track);
        if (isSpline) {
            takePieces(track, where);
            track = fromSplines(track, isRotation);
        }
        return hasTwins(track.times) ? apart(track) : track;
    }

    /// Counts a spline's pieces against the limit for all clips together.
    void takePieces(const Keys& track, const std::string& where) {
        const std::vector<float>& times = track.times;
        double pieces = 1.0;
        for (std::size_t k = 1; k < times.size(); ++k)
            pieces += piecesOf(double(times[k - 1]), double(times[k]));
        if (track.width > 4) pieces *= double(track.width) / 4.0;
        if (!(pieces <= _pieces))
            failFile(where, "a spline of " + std::to_string(times.back() - times.front()) +
                                " seconds, expected no more pieces than the file has room for "
                                "(option maxSamples)");
        _pieces -= pieces;
    }

    const GltfDocument& _document;
    const GltfAccessors& _accessors;
    const std::vector<int>& _indexOf;
    SourceScene& _scene;
    VrmAnimationNodes _vrm;
    double _pieces;                     ///< how many more pieces splines may have
    std::map<std::size_t, Keys> _known; ///< by sampler of the current animation
    std::string _where;
};

} // namespace

void addAnimations(const GltfDocument& document, const std::vector<int>& indexOf,
                   SourceScene& scene) {
    AnimationBuilder(document, indexOf, scene).run();
}

} // namespace osgSkin
