// SPDX-License-Identifier: MIT
// How a clip poses the skeleton that plays it: its keys become the bones' matrices.
#include "nodes/PlayedSkeleton.h"

#include <osgSkin/GlmOsg>

#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace osgSkin {
namespace {

using osgAnimation::Bone;
using osgAnimation::Channel;
using osgAnimation::StackedMatrixElement;
using osgAnimation::StackedQuaternionElement;
using osgAnimation::StackedScaleElement;
using osgAnimation::StackedTranslateElement;
using QuatKeys = osgAnimation::TemplateKeyframeContainer<osg::Quat>;
using Vec3Keys = osgAnimation::TemplateKeyframeContainer<osg::Vec3>;

/// Keys that are tried linearly before a binary search.
constexpr std::size_t kNearKeys = 4;

/// Prefetches; any address is allowed.
void prefetch([[maybe_unused]] std::uintptr_t address) {
#ifdef __GNUC__
    __builtin_prefetch(reinterpret_cast<const void*>(address));
#endif
}

osg::Vec3 between(const osg::Vec3& a, const osg::Vec3& b, float share) {
    return a * (1.0f - share) + b * share;
}

osg::Quat between(const osg::Quat& a, const osg::Quat& b, float share) {
    osg::Quat result;
    result.slerp(static_cast<double>(share), a, b);
    return result;
}

// Named for OSG's row-vector order; glm's columns are OSG's rows.

void preTranslate(glm::dmat4& m, const osg::Vec3& v) {
    m[3] += double(v.x()) * m[0] + double(v.y()) * m[1] + double(v.z()) * m[2];
}

void preScale(glm::dmat4& m, const osg::Vec3& v) {
    m[0] *= double(v.x());
    m[1] *= double(v.y());
    m[2] *= double(v.z());
}

/// As osg::Matrixd::preMultRotate(): a quaternion that is not unit is normalised.
void preRotate(glm::dmat4& m, const osg::Quat& q) {
    const double length2 = q.length2();
    // As in OSG, a quaternion of zeros makes a singular matrix.
    const double twice = length2 <= std::numeric_limits<double>::min() ? 0.0 : 2.0 / length2;
    const double one = twice == 0.0 ? 0.0 : 1.0;
    const double x2 = q.x() * twice, y2 = q.y() * twice, z2 = q.z() * twice;
    const double xx = q.x() * x2, xy = q.x() * y2, xz = q.x() * z2;
    const double yy = q.y() * y2, yz = q.y() * z2, zz = q.z() * z2;
    const double wx = q.w() * x2, wy = q.w() * y2, wz = q.w() * z2;
    const glm::dvec4 a = m[0], b = m[1], c = m[2];
    m[0] = (one - (yy + zz)) * a + (xy + wz) * b + (xz - wy) * c;
    m[1] = (xy - wz) * a + (one - (xx + zz)) * b + (yz + wx) * c;
    m[2] = (xz + wy) * a + (yz - wx) * b + (one - (xx + yy)) * c;
}

/// The value of an element's keys at a time, as osgAnimation's channels compute it.
///
/// \param step expected advance in keys (a hint)
template <typename Value, typename Keys>
Value sample(PlayedElement& element, double time, std::ptrdiff_t step) {
    const auto& container = static_cast<const Keys&>(*element.keys);
    const auto* const keys = &container.front();
    const std::size_t count = container.size();
    const auto isAt = [&](std::size_t k) {
        return k < count - 1 && keys[k].getTime() < time && time <= keys[k + 1].getTime();
    };
    // The last key of all and the first are in other memory: they are looked at only if the time is
    // not near the last one's.
    std::size_t k = element.cursor + static_cast<std::size_t>(step);
    for (std::size_t tried = 0; tried < kNearKeys && !isAt(k); ++tried) ++k;
    if (!isAt(k)) {
        if (time >= keys[count - 1].getTime()) return keys[count - 1].getValue();
        if (time <= keys[0].getTime()) return keys[0].getValue();
        const auto* const after =
            std::lower_bound(keys, keys + count, time,
                             [](const auto& key, double wanted) { return key.getTime() < wanted; });
        k = static_cast<std::size_t>(after - keys) - 1;
    }
    element.cursor = k;
    element.lastKey = reinterpret_cast<std::uintptr_t>(keys + k);
    if (element.isStepped) {
        // On a key, osgAnimation takes the one before, but for the last.
        return keys[k + 2 == count && time >= keys[k + 1].getTime() ? k + 1 : k].getValue();
    }
    const double interval = keys[k + 1].getTime() - keys[k].getTime();
    const auto share = static_cast<float>((time - keys[k].getTime()) / interval);
    return between(keys[k].getValue(), keys[k + 1].getValue(), share);
}

template <typename Value, typename Get>
Value valueOf(const PlayedElement& element, const Get& get) {
    if (!element.target) return get();
    return static_cast<const osgAnimation::TemplateTarget<Value>*>(element.target)->getValue();
}

void apply(PlayedElement& e, double time, std::ptrdiff_t step, glm::dmat4& m) {
    switch (e.kind) {
    case PlayedElement::kTranslate:
        preTranslate(
            m, e.keys ? sample<osg::Vec3, Vec3Keys>(e, time, step) : valueOf<osg::Vec3>(e, [&] {
                return static_cast<StackedTranslateElement*>(e.element)->getTranslate();
            }));
        break;
    case PlayedElement::kRotate:
        preRotate(m,
                  e.keys ? sample<osg::Quat, QuatKeys>(e, time, step) : valueOf<osg::Quat>(e, [&] {
                      return static_cast<StackedQuaternionElement*>(e.element)->getQuaternion();
                  }));
        break;
    case PlayedElement::kScale:
        preScale(m,
                 e.keys ? sample<osg::Vec3, Vec3Keys>(e, time, step) : valueOf<osg::Vec3>(e, [&] {
                     return static_cast<StackedScaleElement*>(e.element)->getScale();
                 }));
        break;
    case PlayedElement::kMatrix:
        m = m * toGlm(static_cast<StackedMatrixElement*>(e.element)->getMatrix());
        break;
    case PlayedElement::kUnknown:
        break;
    }
}

/// A channel's keys, if they are of a kind that sample() knows.
template <typename Linear, typename Stepped>
bool takeKeys(const Channel& channel, PlayedElement& element) {
    const auto* linear = dynamic_cast<const Linear*>(&channel);
    const auto* stepped = dynamic_cast<const Stepped*>(&channel);
    if (linear && linear->getSamplerTyped())
        element.keys = linear->getSamplerTyped()->getKeyframeContainerTyped();
    else if (stepped && stepped->getSamplerTyped())
        element.keys = stepped->getSamplerTyped()->getKeyframeContainerTyped();
    element.isStepped = stepped != nullptr;
    element.cursor = 0;
    return element.keys && element.keys->size() > 0;
}

bool takeKeys(const Channel& channel, PlayedElement& element) {
    switch (element.kind) {
    case PlayedElement::kTranslate:
    case PlayedElement::kScale:
        return takeKeys<osgAnimation::Vec3LinearChannel, osgAnimation::Vec3StepChannel>(channel,
                                                                                        element);
    case PlayedElement::kRotate:
        return takeKeys<osgAnimation::QuatSphericalLinearChannel, osgAnimation::QuatStepChannel>(
            channel, element);
    default:
        return false;
    }
}

} // namespace

/// Divides a clip's channels into those that move the bones and others.
void UpdatePlayedSkeleton::Playing::link(osgAnimation::Animation& animation) {
    clip = &animation;
    channelCount = animation.getChannels().size();
    driving.clear();
    others.clear();
    isLinked = true;
    std::unordered_map<const osgAnimation::Target*, PlayedElement*> byTarget;
    for (PlayedElement& element : elements) {
        element.keys = nullptr;
        element.target = element.element ? element.element->getTarget() : nullptr;
        if (element.target) byTarget.emplace(element.target, &element);
    }
    for (const osg::ref_ptr<Channel>& channel : animation.getChannels()) {
        const auto found = byTarget.find(channel->getTarget());
        if (found == byTarget.end()) {
            others.push_back(channel);
            continue;
        }
        driving.push_back(channel);
        // A second channel of one target would be blended.
        isLinked = isLinked && !found->second->keys && takeKeys(*channel, *found->second);
    }
}

/// Asks for the keys and elements that pose() needs. Among many characters they have left the
/// caches, and each would be waited for.
///
/// \return how many keys the time has gone on, by the first channel: clips mostly have keys of all
///         bones at the same times
std::ptrdiff_t UpdatePlayedSkeleton::Playing::prefetchKeys() {
    const auto first =
        std::find_if(elements.begin(), elements.end(),
                     [](const PlayedElement& element) { return element.keys.valid(); });
    if (first == elements.end()) return 0;
    const std::size_t before = first->cursor;
    glm::dmat4 unused(1.0);
    apply(*first, time, 0, unused);
    const auto step = static_cast<std::ptrdiff_t>(first->cursor - before);
    first->cursor = before;
    constexpr std::size_t kLine = 64;
    for (const PlayedElement& e : elements) {
        const auto at = reinterpret_cast<std::uintptr_t>(
            e.keys ? static_cast<const void*>(e.keys.get()) : e.element);
        prefetch(at);
        if (e.keys) {
            const std::size_t size = e.kind == PlayedElement::kRotate
                                         ? sizeof(osgAnimation::QuatKeyframe)
                                         : sizeof(osgAnimation::Vec3Keyframe);
            const std::uintptr_t key = e.lastKey + static_cast<std::size_t>(step) * size;
            prefetch(key);
            prefetch(key + kLine);
        } else if (e.target) {
            prefetch(reinterpret_cast<std::uintptr_t>(e.target));
        } else {
            prefetch(at + kLine);
        }
    }
    return step;
}

void UpdatePlayedSkeleton::Playing::pose() {
    const std::ptrdiff_t step = prefetchKeys();
    for (std::size_t b = 0; b < bones.size(); ++b) {
        const PlayedBone& bone = bones[b];
        glm::dmat4 own(1.0);
        for (std::size_t e = 0; e < bone.elementCount; ++e)
            apply(elements[bone.firstElement + e], time, step, own);
        glm::dmat4& m = inSkeleton[b];
        m = bone.parent < 0 ? own : inSkeleton[static_cast<std::size_t>(bone.parent)] * own;
        skinning[b] = m * bone.inverseBind;
        // Costs little: no bound above is marked as old, since nobody asks for the bones' bounds.
        bone.bone->setMatrix(toOsg(own));
        bone.bone->setMatrixInSkeletonSpace(toOsg(m));
    }
    for (PlayedPart& part : parts) part.toSkeleton = toOsg(inSkeleton[part.bone]);
}

/// Sets bones to the last pose, as their callbacks would have; also bones whose callback was
/// removed.
void UpdatePlayedSkeleton::Playing::poseBones(osg::Group& parent) const {
    const auto* const parentBone = dynamic_cast<const Bone*>(&parent);
    const osg::Matrixd above = parentBone ? parentBone->getMatrixInSkeletonSpace() : osg::Matrixd();
    for (unsigned int i = 0; i < parent.getNumChildren(); ++i) {
        auto* bone = dynamic_cast<Bone*>(parent.getChild(i));
        if (!bone) continue;
        const auto was = std::find_if(bones.begin(), bones.end(),
                                      [&](const PlayedBone& b) { return b.bone == bone; });
        if (auto* update = dynamic_cast<osgAnimation::UpdateBone*>(bone->getUpdateCallback())) {
            update->getStackedTransforms().update();
            bone->setMatrix(update->getStackedTransforms().getMatrix());
            bone->setMatrixInSkeletonSpace(bone->getMatrix() * above);
        } else if (was != bones.end()) {
            const osg::Matrixd m = toOsg(inSkeleton[static_cast<std::size_t>(was - bones.begin())]);
            bone->setMatrixInSkeletonSpace(m);
            bone->setMatrix(was->parent < 0
                                ? m
                                : m * osg::Matrixd::inverse(toOsg(
                                          inSkeleton[static_cast<std::size_t>(was->parent)])));
        }
        poseBones(*bone);
    }
}

} // namespace osgSkin
