// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place/PlaceTrunk.h"

#include "fit/place/Proportions.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

namespace part = proportions;

const glm::dvec3 kUp(0.0, 1.0, 0.0);

class Trunk {
public:
    explicit Trunk(const FitBody& body) : _body(body) {}

    /// The trunk's section at a height, neck and head included.
    std::optional<Section> at(double height) const {
        return _body.surface.sectionAt(middle(height), kUp, 0.05);
    }

    /// A point in the middle plane, at a fraction of the depth from back to front.
    glm::dvec3 point(double height, double depth) const {
        const glm::dvec3 point = middle(height);
        const auto section = _body.surface.sectionAt(point, kUp, 0.05);
        if (!section) return point;
        // Depth where the spine is: shoulders and arms of the same section stand farther back.
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& p : section->points)
            if (std::abs(p.x - point.x) < 0.05) {
                low = std::min(low, p.z);
                high = std::max(high, p.z);
            }
        return low < high ? glm::dvec3(point.x, height, glm::mix(low, high, depth)) : point;
    }

private:
    glm::dvec3 middle(double height) const {
        const BodyBranches::Path& path = _body.branches.trunk;
        for (std::size_t i = 1; i < path.size(); ++i)
            if (path[i - 1].y >= height && path[i].y < height) {
                glm::dvec3 p = glm::mix(path[i - 1], path[i],
                                        (path[i - 1].y - height) / (path[i - 1].y - path[i].y));
                return _body.isSymmetric() ? glm::dvec3(0.0, height, p.z) : p;
            }
        const glm::dvec3 end = height > 0.7 ? path.front() : path.back();
        return {_body.isSymmetric() ? 0.0 : end.x, height, end.z};
    }

    const FitBody& _body;
};

/// Height of the thinnest section under the head.
double neckHeight(const Trunk& trunk) {
    double best = part::kNeckHeight, least = std::numeric_limits<double>::infinity();
    for (double y = 0.72; y <= 0.93; y += 0.004) {
        const auto section = trunk.at(y);
        if (!section || section->area >= least) continue;
        least = section->area;
        best = y;
    }
    return best;
}

} // namespace

void placeTrunk(const FitBody& body, PlacedJoints& placed) {
    const Trunk trunk(body);
    const glm::dvec3 hip = 0.5 * (placed.at("LeftUpLeg") + placed.at("RightUpLeg"));
    glm::dvec3 hips = trunk.point(hip.y + part::kHipsAboveHip, part::kHipsDepth);
    hips.x = hip.x;
    hips = placed.place("Hips", hips, "between the hip joints");
    placed.place("LHipJoint", hips, "at Hips");
    placed.place("RHipJoint", hips, "at Hips");

    const double thinnest = neckHeight(trunk);
    const glm::dvec3 neck =
        placed.place("Neck", trunk.point(thinnest - part::kNeckBelowThinnest, part::kNeckDepth),
                     "below the thinnest section");
    const glm::dvec3 head =
        placed.place("Head", trunk.point(thinnest + part::kHeadAboveThinnest, part::kHeadDepth),
                     "above the thinnest section");
    if (!(head.y > neck.y && neck.y > hips.y))
        throw Error("cannot fit a skeleton: expected Head above Neck above Hips, found them at "
                    "heights " +
                    std::to_string(head.y) + ", " + std::to_string(neck.y) + " and " +
                    std::to_string(hips.y) + " of the body's");
    placed.setTip("Head", {head.x, body.top(), head.z});
    placed.place("Neck1", 0.5 * (neck + head), "between Neck and Head");

    const auto spine = [&](const char* name, double up, double depth) {
        const double height = glm::mix(hips.y, neck.y, up);
        placed.place(name, trunk.point(height, depth), "share of the trunk");
    };
    spine("LowerBack", part::kLowerBackUp, part::kLowerBackDepth);
    spine("Spine", part::kSpineUp, part::kSpineDepth);
    spine("Spine1", part::kSpine1Up, part::kSpine1Depth);
}

} // namespace osgSkin
