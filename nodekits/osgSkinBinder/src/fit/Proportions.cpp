// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/Proportions.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

namespace osgSkin {
namespace {

struct Range {
    double low, high; ///< in heights
};

/// Wide enough for toddlers and giants; other values are measured wrongly.
constexpr Range kShoulderHeight{0.66, 0.90};
constexpr Range kHipHeight{0.35, 0.65};
constexpr Range kUpperArm{0.09, 0.26};
constexpr Range kForeArm{0.07, 0.26};
constexpr Range kThigh{0.12, 0.33};
constexpr Range kShin{0.12, 0.33};

class Checker {
public:
    Checker(const PlacedJoints& placed, std::size_t side)
        : _placed(placed), _prefix(sidePrefix(side)) {}

    void height(const char* joint, const Range& range) const {
        check(_prefix + joint + " at a height", _placed.at(_prefix + joint).y, range,
              _prefix + joint);
    }

    void bone(const char* from, const char* to, const Range& range) const {
        const double length = glm::distance(_placed.at(_prefix + from), _placed.at(_prefix + to));
        check(_prefix + from + " to " + _prefix + to + " over", length, range,
              _prefix + from + " and " + _prefix + to);
    }

    /// Left limbs are on the left, unless a medial curve runs through two limbs that touch.
    void side(const char* joint, double sign) const {
        const double x = sign * _placed.at(_prefix + joint).x;
        check(_prefix + joint + " beside the middle by", x, {0.02, 0.5}, _prefix + joint);
    }

private:
    static void check(const std::string& what, double found, const Range& range,
                      const std::string& landmarks) {
        if (found >= range.low && found <= range.high) return;
        std::ostringstream message;
        message << "cannot fit a skeleton: expected " << what << " " << range.low << " to "
                << range.high << " of the body's, found " << std::setprecision(2) << found
                << "; give landmarks for " << landmarks;
        throw Error(message.str());
    }

    const PlacedJoints& _placed;
    std::string _prefix;
};

} // namespace

void checkProportions(const PlacedJoints& placed) {
    for (const std::size_t side : {0u, 1u}) {
        const Checker checker(placed, side);
        const double sign = side == 0 ? 1.0 : -1.0;
        checker.height("UpLeg", kHipHeight);
        checker.bone("UpLeg", "Leg", kThigh);
        checker.bone("Leg", "Foot", kShin);
        checker.height("Arm", kShoulderHeight);
        checker.side("Arm", sign);
        checker.bone("Arm", "ForeArm", kUpperArm);
        checker.bone("ForeArm", "Hand", kForeArm);
    }
}

double oddity(const PlacedJoints& placed) {
    namespace part = proportions;
    double sum = 0.0;
    const auto add = [&sum](double found, double expected) {
        sum += std::abs(std::log(std::max(found, 1e-3) / expected)) / 12.0;
    };
    for (const std::size_t side : {0u, 1u}) {
        const std::string& prefix = sidePrefix(side);
        const auto at = [&](const char* joint) { return placed.at(prefix + joint); };
        add(glm::distance(at("UpLeg"), at("Leg")), part::kThigh);
        add(glm::distance(at("Leg"), at("Foot")), part::kShin);
        add(glm::distance(at("Arm"), at("ForeArm")), part::kUpperArm);
        add(glm::distance(at("ForeArm"), at("Hand")), part::kForeArm);
        add(at("UpLeg").y, part::kHipHeight);
        add(at("Arm").y, part::kShoulderHeight);
    }
    return sum;
}

} // namespace osgSkin
