// SPDX-License-Identifier: MIT
#include <osgSkinMotion/Gaits>

#include <osgSkin/Error>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgSkin {
namespace {

constexpr double kMinStride = 1e-9, kMaxStride = 1e12;

[[noreturn]] void failGaits(const std::string& what) {
    throw Error("gaits: " + what);
}

bool haveSameJoints(const SampledClip& a, const SampledClip& b) {
    return std::equal(a.joints().begin(), a.joints().end(), b.joints().begin(), b.joints().end(),
                      [](const SampledClip::Joint& x, const SampledClip::Joint& y) {
                          return x.name == y.name && x.parent == y.parent;
                      });
}

void requireUsable(const Gaits::Gait& gait, const SampledClip& standing) {
    if (!haveSameJoints(*gait.clip, standing))
        failGaits("clip \"" + gait.clip->name() + "\" has other joints than \"" + standing.name() +
                  "\"");
    if (!(gait.stride >= kMinStride && gait.stride <= kMaxStride))
        failGaits("the stride of clip \"" + gait.clip->name() + "\" is " +
                  std::to_string(gait.stride) + ", expected 1e-9 to 1e12");
    for (const Gaits::Contact& contact : gait.contacts)
        if (!(contact.begin >= 0.0 && contact.begin <= 1.0 && contact.end >= 0.0 &&
              contact.end <= 1.0))
            failGaits("a foot of clip \"" + gait.clip->name() +
                      "\" carries in a part of the cycle that is not within 0 to 1");
}

bool isBelow(const std::vector<SampledClip::Joint>& joints, std::size_t joint,
             std::size_t ancestor) {
    if (joint >= joints.size() || ancestor >= joint) return false;
    int above = joints[joint].parent;
    while (above > static_cast<int>(ancestor))
        above = joints[static_cast<std::size_t>(above)].parent;
    return above == static_cast<int>(ancestor);
}

/// Whether a matrix rotates, scales evenly and shifts.
bool isEven(const osg::Matrixd& matrix) {
    const osg::Vec3d x = osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), matrix);
    const osg::Vec3d y = osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), matrix);
    const osg::Vec3d z = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), matrix);
    const double length = x.length(), most = 1e-6 * length * length;
    const double wrong = std::max({std::abs(x * y), std::abs(y * z), std::abs(z * x),
                                   std::abs(y * y - x * x), std::abs(z * z - x * x)});
    return length > 0.0 && std::isfinite(length) && wrong <= most && (x ^ y) * z > 0.0 &&
           std::isfinite(matrix.getTrans().length());
}

} // namespace

void Gaits::set(const Set& set) {
    if (_set.standing) failGaits("they are set already");
    if (!set.standing || !set.walking.clip) failGaits("no clip to stand or to walk");
    const SampledClip& standing = *set.standing;
    requireUsable(set.walking, standing);
    if (set.running.clip) requireUsable(set.running, standing);
    for (const osg::ref_ptr<const SampledClip>& other : set.others)
        if (!other || !haveSameJoints(*other, standing))
            failGaits("another clip is missing, or has other joints");
    const std::vector<SampledClip::Joint>& joints = standing.joints();
    if (set.upperBody >= joints.size()) failGaits("there is no joint of the upper body");
    for (const Leg& leg : set.legs)
        if (!isBelow(joints, leg.knee, leg.hip) || !isBelow(joints, leg.ankle, leg.knee) ||
            (leg.toe != leg.ankle && !isBelow(joints, leg.toe, leg.ankle)))
            failGaits("the joints of a leg are not below each other");
        else if (!isInRange(leg.heel) || !isInRange(leg.ball) || !isInRange(leg.tip))
            failGaits("a sole is not within -1e18 to 1e18");
    if (!isEven(set.toWalker) || !std::isfinite(set.facing))
        failGaits("the way from rest space is not a rotation with an even scale and a shift");
    _set = set;
}

} // namespace osgSkin
