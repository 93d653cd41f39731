// SPDX-License-Identifier: GPL-3.0-or-later
#include "Anthropometry.h"
#include "BodyParts.h"

#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/convex_hull_2.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <ostream>

namespace mannequin {
namespace {

constexpr double kStatureRatio = 1.80 / 1.756;

/// The plane of a measurement. `across` is the direction of a breadth, or zero for a girth.
struct Site {
    std::string name;
    double published; ///< metres, unscaled
    glm::dvec3 centre, normal, across;
};

glm::dvec3 onBone(const char* from, const char* to, double fraction) {
    return glm::mix(jointCentre(from), jointCentre(to), fraction);
}

std::vector<Site> sites() {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), girth(0);
    const glm::dvec3 upperArm = jointCentre("LeftForeArm") - jointCentre("LeftArm");
    const glm::dvec3 forearm = jointCentre("LeftHand") - jointCentre("LeftForeArm");
    const glm::dvec3 hand = jointCentre("LeftFingerBase") - jointCentre("LeftHand");
    const glm::dvec3 foot = jointCentre("LeftToeBase") - jointCentre("LeftFoot");
    const glm::dvec3 sole = glm::normalize(glm::dvec3(foot.x, 0, foot.z));
    return {
        {"head girth", 0.57, {0, 1.722, 0}, {0, 1, -0.1}, girth},
        {"head length", 0.197, {0, 1.715, 0}, y, z},
        {"head breadth", 0.152, {0, 1.715, 0}, y, x},
        {"neck girth", 0.38, {0, 1.542, -0.025}, {0, 0.175, 0.060}, girth},
        {"chest girth", 0.99, {0, 1.310, -0.01}, y, girth},
        {"chest breadth", 0.32, {0, 1.310, -0.01}, y, x},
        {"chest depth", 0.243, {0, 1.310, -0.01}, y, z},
        {"waist girth", 0.86, {0, 1.083, 0}, y, girth},
        {"hip girth", 0.98, {0, 0.910, 0}, y, girth},
        {"hip breadth", 0.34, {0, 0.910, 0}, y, x},
        {"thigh girth", 0.597, {0.095, 0.820, 0}, y, girth},
        {"calf girth", 0.38, onBone("LeftLeg", "LeftFoot", 0.28), y, girth},
        {"ankle girth", 0.22, onBone("LeftLeg", "LeftFoot", 0.88), y, girth},
        {"biceps girth", 0.33, onBone("LeftArm", "LeftForeArm", 0.50), upperArm, girth},
        {"forearm girth", 0.29, onBone("LeftForeArm", "LeftHand", 0.20), forearm, girth},
        {"wrist girth", 0.17, onBone("LeftForeArm", "LeftHand", 0.95), forearm, girth},
        {"hand breadth", 0.090, onBone("LeftHand", "LeftFingerBase", 0.90), hand,
         glm::normalize(z - glm::normalize(hand) * glm::dot(z, glm::normalize(hand)))},
        {"foot breadth", 0.100, jointCentre("LeftToeBase"), sole, glm::cross(y, sole)},
    };
}

using Polyline = std::vector<Kernel::Point_3>;

glm::dvec3 middle(const Polyline& polyline) {
    glm::dvec3 sum(0);
    for (const auto& p : polyline) sum += toGlm(p);
    return sum / static_cast<double>(polyline.size());
}

double measure(const Site& site, const std::vector<Polyline>& sections) {
    const auto nearest = std::min_element(
        sections.begin(), sections.end(), [&site](const Polyline& a, const Polyline& b) {
            return glm::distance(middle(a), site.centre) < glm::distance(middle(b), site.centre);
        });
    if (nearest == sections.end()) return 0;
    const LoftFrame frame =
        LoftFrame::make(site.centre, site.normal,
                        site.across == glm::dvec3(0) ? glm::dvec3(0, 0.3, 1) : site.across);
    std::vector<Kernel::Point_2> flat, hull;
    for (const auto& p : *nearest)
        flat.emplace_back(glm::dot(toGlm(p), frame.u), glm::dot(toGlm(p), frame.v));
    if (site.across != glm::dvec3(0)) {
        const auto [least, most] = std::minmax_element(flat.begin(), flat.end());
        return most->x() - least->x();
    }
    CGAL::convex_hull_2(flat.begin(), flat.end(), std::back_inserter(hull));
    double girth = 0;
    for (std::size_t i = 0; i < hull.size(); ++i)
        girth += std::sqrt(CGAL::squared_distance(hull[i], hull[(i + 1) % hull.size()]));
    return girth;
}

} // namespace

std::vector<BodyMeasure> measureBody(const SkinMesh& mesh) {
    const CGAL::Polygon_mesh_slicer<SkinMesh, Kernel> slicer(mesh);
    std::vector<BodyMeasure> measures;
    for (const Site& site : sites()) {
        std::vector<Polyline> sections;
        const Kernel::Vector_3 normal(site.normal.x, site.normal.y, site.normal.z);
        slicer(Kernel::Plane_3(toCgal(site.centre), normal), std::back_inserter(sections));
        measures.push_back({site.name, site.published * kStatureRatio, measure(site, sections)});
    }
    return measures;
}

void printMeasures(std::ostream& out, const std::vector<BodyMeasure>& measures) {
    out << std::fixed << std::setprecision(3);
    for (const BodyMeasure& m : measures)
        out << std::left << std::setw(16) << m.name << std::right << " published " << m.published
            << "  achieved " << m.achieved << "  " << std::showpos << std::setprecision(1)
            << 100 * (m.achieved / m.published - 1) << std::noshowpos << std::setprecision(3)
            << " %\n";
}

} // namespace mannequin
