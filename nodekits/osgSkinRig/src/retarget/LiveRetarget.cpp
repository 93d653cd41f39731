// SPDX-License-Identifier: MIT
#include <osgSkinRig/LiveRetarget>

#include "retarget/MakeReport.h"
#include "retarget/MotionSteps.h"
#include "retarget/PoseTransfer.h"
#include "retarget/Posture.h"
#include "retarget/RetargetTarget.h"

#include <osgSkin/GlmTypes>

#include <cmath>
#include <exception>
#include <optional>

namespace osgSkin {
namespace {

/// A skeleton that stays in its zero pose.
Motion atRest(const RestSkeleton& skeleton) {
    skeleton.validate();
    Motion motion;
    motion.skeleton = skeleton;
    motion.frameTime = 1.0;
    motion.addFrame(skeleton.joints.front().centre,
                    std::vector<glm::dquat>(skeleton.joints.size(), {1.0, 0.0, 0.0, 0.0}));
    return motion;
}

} // namespace

class LiveRetarget::Transfer {
public:
    Transfer(const Motion& calibration, const RestSkeleton& rigAtRest,
             const RetargetOptions& options, RetargetReport* report)
        : source(calibration.skeleton), rig(rigAtRest), _map(mapJoints(rig, source, options)),
          _pose(findStandingPose(calibration, rig, _map, options.up)), _local(rig.joints.size()) {
        if (_pose.copied)
            _copy.emplace(source, rig, _map.motionJoint, *_pose.copied);
        else
            _transfer.emplace(source, rig, _map, _pose);
        if (_transfer && options.collarsFollow && !_pose.isSame) _transfer->followArms(calibration);
        if (options.shareTwist && !_pose.copied) hinges.emplace(rig, _map.rig);
        if (report == nullptr) return;
        if (_copy)
            reportCopied(*_copy, calibration, rig, _map, _pose.copied->scale, *report);
        else
            reportAligned(*_transfer, calibration, rig, *report);
        addNotes(_pose, _map, calibration, rig, options, *report);
    }

    void apply(const glm::dquat* rotations, const glm::dvec3& root, JointSample* joints) {
        glm::dvec3 place;
        if (_copy) {
            place = _copy->pose(rotations, root, _local.data());
        } else {
            _transfer->drive(rotations, root);
            _transfer->getRotations(_local.data());
            place = _transfer->place();
        }
        if (hinges) hinges->shareNext(_local.data());
        for (std::size_t j = 0; j < _local.size(); ++j) joints[j] = {_local[j]};
        joints[0].translation = place - rig.joints[0].centre;
    }

    const RestSkeleton source, rig;
    std::optional<HingeTwist> hinges;

private:
    const JointPairs _map;
    const StandingPose _pose;
    std::optional<RotationCopy> _copy;
    std::optional<PoseTransfer> _transfer; ///< one of both is there
    std::vector<glm::dquat> _local;
};

LiveRetarget::LiveRetarget(const RestSkeleton& source, const RestSkeleton& rig,
                           const RetargetOptions& options, RetargetReport* report)
    : LiveRetarget(atRest(source), rig, options, report) {}

LiveRetarget::LiveRetarget(const Motion& calibration, const RestSkeleton& rig,
                           const RetargetOptions& options, RetargetReport* report) {
    calibration.validate();
    rig.validate();
    _transfer = std::make_unique<Transfer>(calibration, rig, options, report);
}

std::optional<LiveRetarget> LiveRetarget::create(const RestSkeleton& source,
                                                 const RestSkeleton& rig,
                                                 const RetargetOptions& options,
                                                 std::string* reason) {
    try {
        return LiveRetarget(source, rig, options);
    } catch (const std::exception& error) {
        if (reason) *reason = error.what();
        return std::nullopt;
    }
}

LiveRetarget::LiveRetarget(LiveRetarget&&) noexcept = default;
LiveRetarget& LiveRetarget::operator=(LiveRetarget&&) noexcept = default;
LiveRetarget::~LiveRetarget() = default;

const RestSkeleton& LiveRetarget::source() const {
    return _transfer->source;
}

const RestSkeleton& LiveRetarget::rig() const {
    return _transfer->rig;
}

bool LiveRetarget::apply(const glm::dquat* rotations, const glm::dvec3& root, JointSample* joints) {
    for (std::size_t j = 0; j < source().joints.size(); ++j)
        if (!(std::abs(glm::length(rotations[j]) - 1.0) < 1e-3)) return false; // for NaN, too
    if (!isInRange(root)) return false;
    _transfer->apply(rotations, root, joints);
    return true;
}

void LiveRetarget::restart() {
    if (_transfer->hinges) _transfer->hinges->restart();
}

} // namespace osgSkin
