// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENE_SCENETRACKS_H
#define OSGSKINIMPORT_SCENE_SCENETRACKS_H

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <vector>

namespace osgSkin {

/// A sample's time, in ticks, and the distance within which a key counts as being at the sample.
struct Moment {
    double time, reach;
};

inline glm::dquat blend(const glm::dquat& a, const glm::dquat& b, double t) {
    return glm::slerp(a, b, t);
}
inline glm::dvec3 blend(const glm::dvec3& a, const glm::dvec3& b, double t) {
    return glm::mix(a, b, t);
}

inline float blend(float a, float b, double t) {
    return a + float(t) * (b - a);
}

/// The track's value: a key's exact value if it is at the sample, or else interpolated.
/// \param keys at least one
template <typename Result, typename Key>
Result valueAt(const std::vector<Key>& keys, const Moment& moment) {
    const double time = moment.time;
    const auto next = std::lower_bound(keys.begin(), keys.end(), time,
                                       [](const Key& key, double t) { return key.time < t; });
    if (next == keys.end()) return Result(keys.back().value);
    if (next == keys.begin()) return Result(next->value);
    const auto before = next - 1;
    const double since = time - before->time, until = next->time - time;
    if (std::min(since, until) <= moment.reach)
        return Result(since < until ? before->value : next->value);
    return blend(Result(before->value), Result(next->value), since / (since + until));
}

} // namespace osgSkin

#endif
