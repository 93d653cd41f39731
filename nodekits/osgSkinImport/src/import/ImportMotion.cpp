// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportMotion>

#include "bvh/BvhFile.h"
#include "bvh/BvhMotion.h"
#include "files/FileFormat.h"
#include "files/FileText.h"
#include "import/ShareScenes.h"
#include "scene/ClipNames.h"
#include "scene/RootJoint.h"
#include "scene/SceneSkeleton.h"
#include "scene/SceneTracks.h"
#include "scene/SourceScene.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/Motion>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <osg/BoundingBox>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <new>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

/// The orientation of axes that negative scales may have mirrored: mirrored along x, then rotated,
/// as rotationOf() decomposes a matrix.
struct ReflectedRotation {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    bool isMirrored = false;

    /// The orientation of a child node with the given rotation and scale, whose negative signs
    /// mirror it along its own axes.
    ReflectedRotation below(const glm::dquat& turn, const glm::dvec3& scale) const {
        // If F mirrors along x, then F R F is a rotation. So is the rest of the scale's signs: half
        // a turn about an axis, or none.
        const glm::dquat own = isMirrored ? glm::dquat(turn.w, turn.x, -turn.y, -turn.z) : turn;
        const bool x = scale.x < 0.0, y = scale.y < 0.0, z = scale.z < 0.0;
        glm::dquat rest(1.0, 0.0, 0.0, 0.0);
        if (y && z) rest = {0.0, 1.0, 0.0, 0.0};
        if (y && !z) rest = {0.0, 0.0, 0.0, 1.0};
        if (!y && z) rest = {0.0, 0.0, 1.0, 0.0};
        return {rotation * own * rest, isMirrored != (x != (y != z))};
    }
};

constexpr double kMinRate = 29.9; ///< 30, and NTSC's 29.97
constexpr int kMaxRate = 240, kFreeRate = 120;
constexpr double kMaxSteps = 1e15; ///< far above any limit
constexpr double kOff = 0.05;      ///< fraction of a step: some formats round times to milliseconds

/// Whether all keys, in seconds after the first, are at samples.
bool fits(const std::vector<double>& keys, double rate) {
    return std::all_of(keys.begin(), keys.end(), [rate](double key) {
        return std::abs(key * rate - std::round(key * rate)) <= kOff;
    });
}

double rateOf(const std::vector<double>& keys) {
    const double own = static_cast<double>(keys.size() - 1) / keys.back(); // if keys are even
    const double multiple = own * std::max(1.0, std::ceil(kMinRate / own));
    if (fits(keys, multiple)) return multiple;
    for (int rate = 30; rate <= kMaxRate; ++rate)
        if (fits(keys, rate)) return rate;
    return kFreeRate;
}

/// Evenly spaced samples for tracks with keys at any times: 30 a second or more, with a sample at
/// every key if the keys fit some rate up to 240. If they fit none, 120 a second; each key is then
/// within half a step of a sample, which should take the key's value (see step()).
class SampleGrid {
public:
    /// \param times of all keys, in seconds; finite, at least one
    explicit SampleGrid(std::vector<double> times);

    std::size_t samples() const { return _samples; }
    double step() const { return _step; } ///< seconds between samples; 0 for a single one
    double time(std::size_t sample) const { return _first + _step * static_cast<double>(sample); }

private:
    double _first = 0.0, _step = 0.0;
    std::size_t _samples = 1;
};

SampleGrid::SampleGrid(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    _first = times.front();
    const double span = times.back() - _first;
    if (!(span > 0.0)) return;
    for (double& time : times) time -= _first;
    // Tracks share key times, except for rounding.
    const double same = 1e-6 * span;
    times.erase(std::unique(times.begin(), times.end(),
                            [same](double a, double b) { return b - a <= same; }),
                times.end());
    times.back() = span;
    const double steps = std::max(1.0, std::ceil(std::min(span * rateOf(times), kMaxSteps) - kOff));
    _samples = static_cast<std::size_t>(steps) + 1;
    _step = span / steps;
}

/// Moves nodes that are at their parents' origin to the constant position in their track. Some
/// exporters write bone lengths only there.
///
/// \param animation whose tracks are read
/// \param scene whose nodes may be changed
void takeTrackOffsets(const SourceAnimation& animation, SourceScene& scene) {
    std::unordered_map<std::string, SourceNode*> nodes;
    for (SourceNode& node : scene.nodes) nodes.emplace(node.name, &node);
    for (const SourceTrack& track : animation.tracks) {
        if (track.positions.empty()) continue;
        const auto found = nodes.find(track.node);
        if (found == nodes.end() || found->second->parent < 0) continue;
        glm::dmat4& matrix = found->second->matrix;
        if (glm::dvec3(matrix[3]) != glm::dvec3(0.0)) continue;
        const glm::vec3& first = track.positions.front().value;
        const bool moves =
            std::any_of(track.positions.begin(), track.positions.end(), [&first](const auto& key) {
                return glm::length(key.value - first) > 1e-3f * glm::length(first);
            });
        if (!moves) matrix[3] = glm::dvec4(first, 1.0);
    }
}

/// Adds the times of a track's keys, in seconds. A single key is constant, and readers add such
/// keys at 0.
template <typename Keys>
void addTimes(const Keys& keys, double rate, std::vector<double>& times) {
    if (keys.size() < 2) return;
    for (const auto& key : keys)
        if (std::isfinite(key.time)) times.push_back(key.time / rate);
}

std::vector<const SourceTrack*> tracksOf(const SourceAnimation& animation,
                                         const SceneSkeleton& skeleton) {
    std::map<std::string, const SourceTrack*> byName;
    for (const SourceTrack& track : animation.tracks) byName.emplace(track.node, &track);
    std::vector<const SourceTrack*> result;
    for (const RestJoint& joint : skeleton.rest.joints) {
        const auto found = byName.find(joint.name);
        result.push_back(found == byName.end() ? nullptr : found->second);
    }
    return result;
}

/// The scale that makes a skeleton's figure two units high or long.
double unitScale(const RestSkeleton& rest) {
    osg::BoundingBoxd box;
    for (const RestJoint& joint : rest.joints) box.expandBy(toOsg(joint.centre));
    return box.radius() > 0.0 ? 1.0 / box.radius() : 1.0;
}

/// For each joint, whether its track moves it from its node's position. The comparison is relative
/// to the figure's size, because nodes may have other units than the scene.
std::vector<bool> findMovedJoints(const std::vector<const SourceTrack*>& tracks,
                                  const SceneSkeleton& skeleton) {
    std::vector<bool> result(tracks.size(), false);
    const double figure = unitScale(skeleton.rest);
    for (std::size_t j = 0; j < tracks.size(); ++j) {
        if (tracks[j] == nullptr) continue;
        const int up = skeleton.rest.joints[j].parent;
        const glm::dmat4& above =
            up < 0 ? skeleton.aboveRoot : skeleton.bind[static_cast<std::size_t>(up)];
        const double unit = figure * std::cbrt(std::abs(glm::determinant(glm::dmat3(above))));
        const glm::dvec3 rest = unit * glm::dvec3(skeleton.nodes[j]->matrix[3]);
        const auto& keys = tracks[j]->positions;
        result[j] = std::any_of(keys.begin(), keys.end(), [&](const auto& key) {
            return isMoved(unit * glm::dvec3(key.value), rest);
        });
    }
    return result;
}

/// Whether a rotation within a scale that is uneven by more than 5 % shears.
bool shears(const glm::dmat3& above, const glm::dquat& rotation) {
    const glm::dmat3 moved = above * glm::mat3_cast(rotation) * glm::inverse(above);
    const glm::dmat3 even = glm::transpose(moved) * moved, one(1.0);
    return glm::length(even[0] - one[0]) + glm::length(even[1] - one[1]) +
               glm::length(even[2] - one[2]) >
           0.2;
}

/// Reports the first joint whose track scales it, or rotates it within an uneven scale: motions
/// have no scale.
void warnScales(const std::vector<const SourceTrack*>& tracks, const SceneSkeleton& skeleton,
                const std::string& path) {
    constexpr double kSame = 0.01;
    for (std::size_t j = 0; j < tracks.size(); ++j) {
        if (tracks[j] == nullptr) continue;
        const NodeTransform rest = decompose(skeleton.nodes[j]->matrix);
        const int up = skeleton.rest.joints[j].parent;
        const glm::dmat3 above(up < 0 ? skeleton.aboveRoot
                                      : skeleton.bind[static_cast<std::size_t>(up)]);
        const auto isOther = [&](const auto& key) {
            const glm::dvec3 off = glm::abs(glm::dvec3(key.value)) - glm::abs(rest.scale);
            return glm::length(off) > kSame * glm::length(rest.scale);
        };
        const auto isSheared = [&](const auto& key) {
            return shears(above, glm::dquat(key.value) * glm::conjugate(rest.rotation));
        };
        const auto& scales = tracks[j]->scales;
        const auto& turns = tracks[j]->rotations;
        const bool isScaled = std::any_of(scales.begin(), scales.end(), isOther);
        if (!isScaled && std::none_of(turns.begin(), turns.end(), isSheared)) continue;
        warn(path, (isScaled ? "joint " : "an object or joint above ") +
                       inQuotes(skeleton.rest.joints[j].name) + " is scaled" +
                       (isScaled ? "" : " unevenly") + "; motions have no scales");
        return;
    }
}

glm::dquat localRotation(const SourceTrack* track, const SourceNode& node, const Moment& moment) {
    if (track == nullptr || track->rotations.empty()) return decompose(node.matrix).rotation;
    return glm::normalize(valueAt<glm::dquat>(track->rotations, moment));
}

glm::dvec3 localPosition(const SourceTrack* track, const SourceNode& node, const Moment& moment) {
    if (track == nullptr || track->positions.empty()) return glm::dvec3(node.matrix[3]);
    return valueAt<glm::dvec3>(track->positions, moment);
}

/// A node's scale to combine with localRotation(), with its signs.
glm::dvec3 localScale(const SourceTrack* track, const SourceNode& node) {
    glm::dvec3 result = decompose(node.matrix).scale;
    if (track == nullptr || track->rotations.empty() || track->scales.empty()) return result;
    const glm::dvec3 signs = glm::dvec3(track->scales.front().value);
    for (int axis = 0; axis < 3; ++axis) result[axis] = std::copysign(result[axis], signs[axis]);
    return result;
}

/// A node's matrix from its track, with the node's own scale.
glm::dmat4 localMatrix(const SourceTrack* track, const SourceNode& node, const Moment& moment) {
    const glm::dvec3 scale = localScale(track, node);
    glm::dmat4 result = glm::mat4_cast(localRotation(track, node, moment));
    for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
    result[3] = glm::dvec4(localPosition(track, node, moment), 1.0);
    return result;
}

/// Drops translation tracks that are constant.
void dropStill(Motion& motion) {
    const double figure = unitScale(motion.skeleton);
    for (auto move = motion.moves.begin(); move != motion.moves.end();) {
        const glm::dvec3 first = figure * move->second.front();
        const bool moves =
            std::any_of(move->second.begin(), move->second.end(), [&](const glm::dvec3& position) {
                return isMoved(figure * position, first);
            });
        move = moves ? std::next(move) : motion.moves.erase(move);
    }
}

/// Samples the weights of expressions and morph targets, and how the eyes look.
void sampleMorphs(const SourceAnimation& animation, const SampleGrid& grid, Motion& motion) {
    const double rate = animation.ticksPerSecond;
    const auto sample = [&](const auto& add) {
        for (std::size_t f = 0; f < motion.frames; ++f)
            add(Moment{grid.time(f) * rate, 0.5001 * grid.step() * rate});
    };
    for (const SourceMorphTrack& track : animation.morphs) {
        // Several meshes may have weights of one target: the first one's are used.
        std::vector<float>& weights = motion.morphs[track.morph];
        if (!weights.empty() || track.weights.empty()) continue;
        sample([&](const Moment& at) { weights.push_back(valueAt<float>(track.weights, at)); });
    }
    if (animation.gaze.empty()) return;
    for (const char* look : {"lookLeft", "lookRight", "lookUp", "lookDown"})
        motion.morphs[look].clear(); // of expressions: the gaze counts
    sample([&](const Moment& at) {
        const glm::dquat q = glm::normalize(valueAt<glm::dquat>(animation.gaze, at));
        const glm::dvec3 ahead = q * glm::dvec3(0.0, 0.0, 1.0);
        const double aside = std::atan2(ahead.x, ahead.z),
                     up = std::asin(glm::clamp(ahead.y, -1.0, 1.0));
        const auto add = [&](const char* name, double angle) {
            motion.morphs[name].push_back(
                float(glm::clamp(angle / glm::half_pi<double>(), 0.0, 1.0)));
        };
        add("lookLeft", aside);
        add("lookRight", -aside);
        add("lookUp", up);
        add("lookDown", -up);
    });
}

/// The times of samples for an animation's keys.
/// \throw osgSkin::Error as sampleTracks()
SampleGrid sampleTimes(const SourceAnimation& animation,
                       const std::vector<const SourceTrack*>& tracks, std::size_t maxSamples,
                       const std::string& path) {
    const double rate = animation.ticksPerSecond;
    std::vector<double> times;
    bool any = false;
    for (const SourceTrack* track : tracks) {
        if (track == nullptr) continue;
        addTimes(track->rotations, rate, times);
        addTimes(track->positions, rate, times);
        any = any || !track->rotations.empty() || !track->positions.empty();
    }
    for (const SourceMorphTrack& track : animation.morphs) addTimes(track.weights, rate, times);
    addTimes(animation.gaze, rate, times);
    any = any || !animation.morphs.empty() || !animation.gaze.empty();
    if (times.empty() && any) times.push_back(0.0); // a pose
    if (times.empty()) failFile(path, "no key in its animation, expected at least one");
    const SampleGrid grid(std::move(times));
    const double each = static_cast<double>(tracks.size() + animation.morphs.size());
    if (!(static_cast<double>(grid.samples()) * each <= static_cast<double>(maxSamples)))
        failFile(path, "its animation lasts " +
                           std::to_string(grid.step() * double(grid.samples())) + " s, " +
                           std::to_string(grid.samples()) + " frames of " +
                           std::to_string(tracks.size()) + " joints, expected at most " +
                           std::to_string(maxSamples) + " rotations (option maxSamples)");
    return grid;
}

/// The joints of the carried skeleton that move against their parents: those that the animation
/// moves, and those that another joint carries than in the file.
std::vector<std::size_t> movingJoints(const RestSkeleton& rest, const RestSkeleton& reduced,
                                      const std::vector<std::size_t>& joints,
                                      const std::vector<bool>& moved) {
    std::vector<std::size_t> moving;
    for (std::size_t k = 1; k < joints.size(); ++k) {
        const auto up = static_cast<std::size_t>(reduced.joints[k].parent);
        const bool isCut = rest.joints[joints[k]].parent != static_cast<int>(joints[up]);
        if (moved[joints[k]] || isCut) moving.push_back(k);
    }
    return moving;
}

/// The position of the motion's root in the scene, below the joints `above`; that at rest where
/// nothing moves it.
glm::dvec3 rootPosition(const std::vector<const SourceTrack*>& tracks,
                        const SceneSkeleton& skeleton, const std::vector<std::size_t>& above,
                        std::size_t root, const Moment& moment) {
    if (root == 0 && (tracks[0] == nullptr || tracks[0]->positions.empty()))
        return skeleton.rest.joints[0].centre;
    glm::dmat4 place = skeleton.aboveRoot;
    for (const std::size_t j : above) place *= localMatrix(tracks[j], *skeleton.nodes[j], moment);
    return glm::dvec3(place *
                      glm::dvec4(localPosition(tracks[root], *skeleton.nodes[root], moment), 1.0));
}

/// Samples an animation at equal steps, 30 a second or more, and at every key (see SampleGrid).
/// Converts rotations to frames that are aligned with the world at rest, as Motion stores them.
///
/// The motion's root is that joint, or the one that rootMotionJoint() finds; other joints that
/// move against their parents are in Motion::moves.
/// \throw osgSkin::Error with `path` if no track has a key, the key times are invalid, or joints
///        times frames are more than `maxSamples`.
Motion sampleTracks(const SourceAnimation& animation, const SceneSkeleton& skeleton,
                    std::size_t maxSamples, const std::string& path) {
    const std::vector<const SourceTrack*> tracks = tracksOf(animation, skeleton);
    const double rate = animation.ticksPerSecond;
    const SampleGrid grid = sampleTimes(animation, tracks, maxSamples, path);
    Motion motion;
    const std::vector<bool> moved = findMovedJoints(tracks, skeleton);
    const std::size_t root = rootMotionJoint(skeleton.rest, moved);
    ReducedSkeleton carried(skeleton.rest, root);
    motion.skeleton = std::move(carried.rest);
    motion.frames = grid.samples();
    motion.frameTime = grid.samples() > 1 ? grid.step() : 1.0 / rate;
    if (!std::isfinite(motion.frameTime) || !(motion.frameTime > 0.0))
        failFile(path, "the time between its samples is not positive");
    warnScales(tracks, skeleton, path);

    const std::size_t joints = tracks.size();
    const ReflectedRotation aboveRoot{rotationOf(skeleton.aboveRoot),
                                      glm::determinant(glm::dmat3(skeleton.aboveRoot)) < 0.0};
    std::vector<ReflectedRotation> world(joints); // in the nodes' own frames
    std::vector<glm::dquat> aligned(joints);      // the same, as rotations from rest
    const std::vector<std::size_t> moving =
        movingJoints(skeleton.rest, motion.skeleton, carried.joints, moved);
    std::vector<glm::dmat4> places(moving.empty() ? 0 : joints); // of the nodes, in the scene
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const Moment moment{grid.time(f) * rate, 0.5001 * grid.step() * rate};
        for (std::size_t j = 0; j < joints; ++j) {
            const int up = skeleton.rest.joints[j].parent;
            const auto p = static_cast<std::size_t>(std::max(up, 0));
            world[j] = (up < 0 ? aboveRoot : world[p])
                           .below(localRotation(tracks[j], *skeleton.nodes[j], moment),
                                  localScale(tracks[j], *skeleton.nodes[j]));
            aligned[j] = world[j].rotation * glm::conjugate(skeleton.worldRotations[j]);
        }
        for (std::size_t j = 0; j < places.size(); ++j) {
            const int up = skeleton.rest.joints[j].parent;
            places[j] = (up < 0 ? skeleton.aboveRoot : places[static_cast<std::size_t>(up)]) *
                        localMatrix(tracks[j], *skeleton.nodes[j], moment);
        }
        for (const std::size_t k : moving) {
            const auto parent = static_cast<std::size_t>(motion.skeleton.joints[k].parent);
            const std::size_t j = carried.joints[k], up = carried.joints[parent];
            motion.moves[k].push_back(glm::conjugate(aligned[up]) *
                                      glm::dvec3(places[j][3] - places[up][3]));
        }
        for (std::size_t k = 0; k < carried.joints.size(); ++k) {
            const glm::dquat& own = aligned[carried.joints[k]];
            const int up = motion.skeleton.joints[k].parent;
            motion.rotations.push_back(glm::normalize(
                up < 0
                    ? own
                    : glm::conjugate(aligned[carried.joints[static_cast<std::size_t>(up)]]) * own));
        }
        motion.rootPositions.push_back(rootPosition(tracks, skeleton, carried.above, root, moment));
    }
    dropStill(motion);
    sampleMorphs(animation, grid, motion);
    return motion;
}

/// Throws for errors that Assimp does not detect: numbers that overflow, and broken binary files.
void validate(const Motion& motion, const std::string& path) {
    const std::size_t joints = motion.skeleton.joints.size();
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const std::string where = "frame " + std::to_string(f) + ": ";
        if (!isInRange(motion.rootPositions[f]))
            failFile(path, where + "the root's position is not finite, or beyond -1e18 to 1e18");
        for (const auto& [joint, positions] : motion.moves)
            if (!isInRange(positions[f]))
                failFile(path, where + "joint " + inQuotes(motion.skeleton.joints[joint].name) +
                                   " has a position that is not finite, or beyond -1e18 to 1e18");
        for (std::size_t j = 0; j < joints; ++j)
            if (!isFinite(motion.rotation(f, j)))
                failFile(path, where + "joint " + inQuotes(motion.skeleton.joints[j].name) +
                                   " has a rotation that is not finite");
    }
}

Motion readBvhMotion(const std::string& path, const std::string& clip, const ReadLimits& limits) {
    if (!clip.empty()) findClip({osgDB::getStrippedName(path)}, clip, path); // the only clip
    const BvhFile file = readBvh(path, limits);
    if (file.frames == 0) failFile(path, "no frame, expected at least one");
    return makeMotion(file, path);
}

/// The first animation that moves joints. Reports that others do, too.
std::size_t firstClip(const SourceScene& scene, const std::vector<std::string>& names,
                      const std::string& path) {
    std::size_t first = 0, count = 0;
    for (std::size_t a = 0; a < names.size(); ++a) {
        if (scene.animations[a]->tracks.empty()) continue; // a face alone, where there are others
        if (count++ == 0) first = a;
    }
    if (count > 1)
        warn(path, std::to_string(count) + " animations, of which the first, \"" + names[first] +
                       "\", is read");
    return first;
}

Motion readSceneMotion(const std::string& path, const std::string& clip, const ReadLimits& limits,
                       const osgDB::Options* options) {
    const FileFormat format = formatOf(path);
    if (format.hasMesh && !format.hasSkeleton)
        refuse(path, limits,
               "files of this format have no animation; name a motion file of another format");
    SourceScene scene = *readSourceScene(path, options); // a copy, whose nodes may change
    if (scene.animations.empty()) failFile(path, "no animation, expected at least one");
    const std::vector<std::string> names = clipNames(scene);
    const std::size_t chosen =
        clip.empty() ? firstClip(scene, names, path) : findClip(names, clip, path);
    const SourceAnimation& animation = *scene.animations[chosen];
    if (animation.tracks.empty() && animation.morphs.empty() && animation.gaze.empty())
        failFile(path, "clip " + inQuotes(names[chosen]) +
                           " moves no joint and no expression, expected one that does");
    takeTrackOffsets(animation, scene);
    Motion motion = sampleTracks(animation, readSceneSkeleton(scene, path, limits),
                                 limits.samplesOf(scene.bytes), path);
    validate(motion, path);
    motion.name = names[chosen];
    motion.yIsUp = format.reader == FileFormat::Gltf;
    return motion;
}

void dropFirst(Motion& motion, std::size_t count) {
    const auto rotations = static_cast<std::ptrdiff_t>(count * motion.skeleton.joints.size());
    motion.rotations.erase(motion.rotations.begin(), motion.rotations.begin() + rotations);
    motion.rootPositions.erase(motion.rootPositions.begin(),
                               motion.rootPositions.begin() + static_cast<std::ptrdiff_t>(count));
    for (auto& [joint, positions] : motion.moves)
        positions.erase(positions.begin(), positions.begin() + static_cast<std::ptrdiff_t>(count));
    for (auto& [morph, weights] : motion.morphs)
        weights.erase(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(count));
    motion.frames -= count;
}

} // namespace

Motion importMotion(const std::string& path, std::size_t skipFrames, const std::string& clip,
                    const osgDB::Options* options) try {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const bool isBvh = formatOf(path).reader == FileFormat::Bvh;
    Motion motion =
        isBvh ? readBvhMotion(path, clip, limits) : readSceneMotion(path, clip, limits, options);
    if (isBvh || clip.empty()) motion.name = osgDB::getStrippedName(path);
    if (skipFrames >= motion.frames)
        failFile(path, std::to_string(motion.frames) + " frame(s), expected more than the " +
                           std::to_string(skipFrames) + " to skip");
    dropFirst(motion, skipFrames);
    return motion;
} catch (const std::bad_alloc&) {
    failFile(path, "out of memory");
}

} // namespace osgSkin
