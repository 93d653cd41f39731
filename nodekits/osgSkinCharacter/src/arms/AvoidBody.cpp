// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/AvoidBody>

#include "arms/ArmTurns.h"
#include "arms/BodyAvoider.h"

#include <osgSkin/Error>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <sstream>

namespace osgSkin {
namespace {

constexpr double kSampleTime = 1.0 / 30; ///< between the splines' coefficients
constexpr double kWindow = 0.3;          ///< seconds about a cut in which arms may be turned
constexpr int kRounds = 2;               ///< in which margins are widened where skin still cuts

// In arm lengths.
constexpr double kPressed = -0.035, kOutside = 0.014; ///< margins of upper arms, of the rest
constexpr double kWiden = 0.012;                      ///< of the margins of points near a cut
constexpr double kOfCut = 0.2;                        ///< how near to a cut
constexpr double kRestGap = 0.02; ///< arms may come closer by so much than they are at rest
constexpr double kWide = 0.03;    ///< skin is looked at where points are so near to their margins
constexpr double kReach = 0.05;   ///< points farther from the body do not count, but for turns
constexpr double kHandsNear = 0.38, kHandsTouch = 0.25; ///< distances of the palms

/// The margin of an arm's point. An upper arm may be in the trunk at first, since its skin and the
/// armpit's give way: how far depends on the body and the pose, and shows in the skin.
double marginOf(const ArmPiece::Point& point) {
    return glm::mix(kPressed, kOutside, glm::clamp((point.along - 0.3) / 0.4, 0.0, 1.0));
}

} // namespace

std::string AvoidBodyReport::text() const {
    std::ostringstream text;
    text.precision(3);
    text << turned << " of " << samples << " samples of arms turned, by " << meanDegrees
         << " degrees in the mean of all, " << largestDegrees << " at most";
    return text.str();
}

BodyAvoider::BodyAvoider(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
                         const Binding& binding)
    : _rest(rest) {
    if (roles.roles.size() != rest.joints.size())
        throw Error("avoid body: expected roles of the skeleton's joints");
    if (binding.joints.size() != rest.joints.size() ||
        binding.regions.size() != mesh.positions.size())
        throw Error("avoid body: expected a binding of the mesh to the skeleton");
    binding.validate();
    _pieces.emplace(rest, roles, mesh, binding);
    if (_pieces->arms.empty()) return;
    _fields.emplace(rest, roles, *_pieces, mesh, binding);
    _cuts.emplace(rest, *_pieces, mesh, binding);
    const std::vector<BodyFields::ToRest> maps = _fields->maps(PosedJoints(rest));
    for (std::size_t s = 0; s < 2; ++s)
        for (std::size_t field = 0; field < BodyFields::kFields; ++field)
            for (const ArmPiece::Point& point : _pieces->arms[s].points)
                _most[s][field].push_back(_fields->at(field, maps, point.place).distance -
                                          kRestGap * _pieces->armLength());
}

/// Finds where the arms are near the body in a sample. Returns which of them cut it.
std::array<bool, 2> BodyAvoider::look(const PosedJoints& pose, ArmSample& sample) {
    const double length = _pieces->armLength();
    const double largest = glm::radians(AvoidBodyReport::kMaxDegrees);
    std::array<bool, 2> meets{};
    sample.maps = _fields->maps(pose);
    for (std::size_t s = 0; s < 2; ++s) {
        const ArmPiece& arm = _pieces->arms[s];
        if (arm.points.empty()) continue;
        ArmSample::Arm& posed = sample.arms[s];
        posed.shoulder = pose.centres[arm.upper];
        posed.palm = pose.place(arm.palm.place, arm.palm.joint);
        posed.above = glm::mat3_cast(
            pose.rotations[static_cast<std::size_t>(_rest.joints[arm.upper].parent)]);
        posed.axis = glm::normalize((pose.centres[arm.lower] - posed.shoulder) * posed.above);
        for (std::size_t field = 0; field < BodyFields::kFields; ++field)
            for (std::size_t i = 0; i < arm.points.size(); ++i) {
                const glm::dvec3 place = pose.place(arm.points[i].place, arm.points[i].joint);
                const double distance = _fields->at(field, sample.maps, place).distance;
                const double margin =
                    std::min(marginOf(arm.points[i]) * length, _most[s][field][i]);
                meets[s] = meets[s] || distance < margin + kWide * length;
                if (distance < kReach * length + largest * glm::distance(place, posed.shoulder))
                    posed.near.push_back({field, i, place, margin});
            }
    }
    if (meets[0] || meets[1]) _cuts->pose(pose);
    for (std::size_t s = 0; s < 2; ++s) meets[s] = meets[s] && !_cuts->find(s, 1).empty();
    if (_pieces->arms[0].points.empty() || _pieces->arms[1].points.empty()) return meets;
    const double apart = glm::distance(sample.arms[0].palm, sample.arms[1].palm) / length;
    sample.touch = glm::clamp((kHandsNear - apart) / (kHandsNear - kHandsTouch), 0.0, 1.0);
    return meets;
}

std::vector<ArmSample> BodyAvoider::sample(const Clip& clip, std::size_t stride,
                                           std::size_t window) {
    std::vector<ArmSample> samples((clip.frames + stride - 2) / stride + 1);
    PosedJoints pose(_rest);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        pose.set(_rest, clip, std::min(k * stride, clip.frames - 1));
        const std::array<bool, 2> meets = look(pose, samples[k]);
        for (std::size_t s = 0; s < 2; ++s)
            for (std::size_t i = k - std::min(k, window);
                 meets[s] && i <= std::min(samples.size() - 1, k + window); ++i)
                samples[i].arms[s].isFree = true;
    }
    for (ArmSample& sample : samples) // a hand goes with the other that it touches
        if (sample.touch > 0.0)
            sample.arms[0].isFree = sample.arms[1].isFree =
                sample.arms[0].isFree || sample.arms[1].isFree;
    return samples;
}

/// Widens the margins of points near which the skin of turned arms still cuts the body. Returns
/// whether there are any.
bool BodyAvoider::widenMargins(const Clip& clip, std::size_t stride, const ArmTurns& turns,
                               std::vector<ArmSample>& samples) {
    Clip turned = clip;
    AvoidBodyReport unused;
    PosedJoints pose(_rest);
    bool any = false;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        if (!samples[k].arms[0].isFree && !samples[k].arms[1].isFree) continue;
        const std::size_t frame = std::min(k * stride, clip.frames - 1);
        turnArms(turns.at(double(k)), frame, turned, unused);
        pose.set(_rest, turned, frame);
        _cuts->pose(pose);
        for (std::size_t s = 0; s < 2; ++s) {
            const std::vector<ArmPiece::Point>& points = _pieces->arms[s].points;
            std::vector<bool> cuts(points.size(), false);
            for (const glm::dvec3& cut : _cuts->find(s)) {
                double least = kOfCut * _pieces->armLength();
                std::size_t nearest = points.size();
                for (std::size_t i = 0; i < points.size(); ++i)
                    if (const double d = glm::distance(points[i].place, cut); d < least) {
                        least = d;
                        nearest = i;
                    }
                if (nearest < points.size()) cuts[nearest] = any = true;
            }
            for (ArmSample::Near& near : samples[k].arms[s].near) {
                if (!cuts[near.point]) continue;
                const ArmPiece::Point& point = points[near.point];
                const double distance =
                    _fields->at(near.field, samples[k].maps, pose.place(point.place, point.joint))
                        .distance;
                if (distance < 0.04 * _pieces->armLength()) // else it cuts another piece
                    near.margin =
                        std::min(std::max(near.margin, distance) + kWiden * _pieces->armLength(),
                                 _most[s][near.field][near.point]);
            }
        }
    }
    return any;
}

void BodyAvoider::turnArms(const ArmPair& vectors, std::size_t frame, Clip& clip,
                           AvoidBodyReport& report) const {
    for (std::size_t s = 0; s < 2; ++s) {
        ++report.samples;
        const double angle = glm::length(vectors[s]);
        if (!(angle > 0.0)) continue; // leaves the sample unchanged
        glm::dquat& rotation = clip.rotations[frame * clip.joints + _pieces->arms[s].upper];
        rotation = glm::normalize(glm::angleAxis(angle, vectors[s] / angle) * rotation);
        ++report.turned;
        report.meanDegrees += glm::degrees(angle);
        report.largestDegrees = std::max(report.largestDegrees, glm::degrees(angle));
    }
}

AvoidBodyReport BodyAvoider::apply(Clip& clip) {
    if (clip.joints != _rest.joints.size() || clip.rotations.size() != clip.frames * clip.joints ||
        clip.rootPositions.size() != clip.frames)
        throw Error("avoid body: expected a clip of the skeleton's " +
                    std::to_string(_rest.joints.size()) + " joints, found one of " +
                    std::to_string(clip.joints));
    AvoidBodyReport result;
    if (!_fields || clip.frames == 0) return result;
    const double frameTime = clip.frameTime > 0.0 ? clip.frameTime : kSampleTime;
    // At least 16 samples, if there are as many frames.
    const double frames = std::min(kSampleTime / frameTime + 0.01, double(clip.frames) / 16.0);
    const auto stride = static_cast<std::size_t>(std::max(1.0, frames));
    const double interval = double(stride) * frameTime;
    // A coefficient reaches two samples far.
    const auto window =
        static_cast<std::size_t>(std::max(0.0, std::floor(kWindow / interval + 0.01) - 2.0));
    std::vector<ArmSample> samples = sample(clip, stride, window);
    ArmTurns turns(*_fields, samples, _pieces->armLength(), interval);
    turns.solve();
    for (int k = 0; k < kRounds && widenMargins(clip, stride, turns, samples); ++k) turns.solve();
    for (std::size_t frame = 0; frame < clip.frames; ++frame)
        turnArms(turns.at(double(frame) / double(stride)), frame, clip, result);
    result.meanDegrees /= double(result.samples);
    return result;
}

AvoidBodyReport avoidBody(Clip& clip, const RestSkeleton& rest, const JointRoles& roles,
                          const SkinMesh& mesh, const Binding& binding) {
    return BodyAvoider(rest, roles, mesh, binding).apply(clip);
}

} // namespace osgSkin
