// SPDX-License-Identifier: GPL-3.0-or-later
#include "bind/CheckOptions.h"

#include <osgSkin/Error>
#include <osgSkin/SkinModel>

#include <cmath>

namespace osgSkin {
namespace {

void checkBoundaries(const std::string& joint, const char* what, const std::optional<double>& upper,
                     const std::optional<double>& lower) {
    const std::string where =
        "bind: " + std::string(what) + " boundaries of joint \"" + joint + "\"";
    if ((upper && !std::isfinite(*upper)) || (lower && !std::isfinite(*lower)))
        throw Error(where + " are not finite, expected numbers in units of the bone's length");
    if (upper && lower && !(*upper < *lower))
        throw Error(where + " are out of order, expected upper < lower (towards the child)");
}

} // namespace

void checkOptions(const RestSkeleton& skeleton, const BindOptions& options) {
    if (!(options.smoothing > 0.0) || !std::isfinite(options.smoothing))
        throw Error("bind: smoothing is " + std::to_string(options.smoothing) +
                    ", expected a finite number above 0");
    if (!(options.cutOff >= 0.0 && options.cutOff < 0.5))
        throw Error("bind: cutOff is " + std::to_string(options.cutOff) +
                    ", expected 0 <= cutOff < 0.5");
    if (options.maxPartialInfluences < 1 ||
        options.maxPartialInfluences > SkinModel::kMaxPartialInfluences)
        throw Error("bind: maxPartialInfluences is " +
                    std::to_string(options.maxPartialInfluences) + ", expected 1 to " +
                    std::to_string(SkinModel::kMaxPartialInfluences));
    for (const auto& [name, joint] : options.joints) {
        if (skeleton.find(name) < 0)
            throw Error("bind: joint \"" + name +
                        "\" is not in the skeleton, expected one of its joints");
        checkBoundaries(name, "bend", joint.bendUpper, joint.bendLower);
        checkBoundaries(name, "twist", joint.twistUpper, joint.twistLower);
    }
}

} // namespace osgSkin
