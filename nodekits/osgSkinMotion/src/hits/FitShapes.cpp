// SPDX-License-Identifier: MIT
#include "hits/FitShapes.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/JointRoles>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

constexpr double kSureBend = 0.35; ///< radians: a limb that rests so shows how it bends
constexpr double kMaxBend = 2.6;   ///< radians from straight

using Points = std::vector<glm::dvec3>;
using Shape = HitBoxes::Shape;

constexpr double kThin = 1e-4;      ///< of the largest half length: the smallest one
constexpr double kMinSaving = 0.03; ///< of a division, as a share of the volume
constexpr int kCircleSteps = 20;
constexpr std::size_t kMinPoints = 8; ///< in a slice

/// How many points of a surface may stick out.
std::size_t lostOf(const Points& points, double inside) {
    return static_cast<std::size_t>((1.0 - inside) * double(points.size()));
}

/// A shape in axes of its own.
struct Fit {
    Shape::Kind kind = Shape::Kind::Box;
    glm::dmat3 axes{1.0}; ///< columns
    glm::dvec3 centre{0.0}, half{0.0};
    double volume = std::numeric_limits<double>::infinity();
};

double volumeOf(Shape::Kind kind, const glm::dvec3& half) {
    if (kind == Shape::Kind::Box) return 8.0 * half.x * half.y * half.z;
    return glm::pi<double>() * half.x * half.x * (2.0 * half.z + 4.0 / 3.0 * half.x);
}

Points inAxes(const Points& points, const glm::dmat3& axes) {
    Points result;
    result.reserve(points.size());
    for (const glm::dvec3& p : points) result.push_back(p * axes); // transposed
    return result;
}

/// From the lowest to the highest coordinate.
struct Range {
    double low, high;
};

/// For each face of a box around the points, low and high by axis: its outermost `kept` points,
/// from outside.
std::array<std::vector<std::uint32_t>, 6> outermost(const Points& local, std::size_t kept) {
    std::array<std::vector<std::uint32_t>, 6> ends;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double sign = face % 2 ? -1.0 : 1.0;
        std::vector<std::uint32_t>& order = ends[std::size_t(face)];
        order.resize(local.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
        std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(kept), order.end(),
                          [&](std::uint32_t a, std::uint32_t b) {
                              return sign * local[a][axis] < sign * local[b][axis];
                          });
        order.resize(kept);
    }
    return ends;
}

/// The smallest box of some of the points: those whose loss shrinks it the most are left out, one
/// or a few at a time.
///
/// \param local points
/// \param lost how many may be left out
std::array<Range, 3> smallBox(const Points& local, std::size_t lost) {
    const auto ends = outermost(local, std::min(local.size(), lost + 1)); // no others can matter
    std::vector<bool> isOut(local.size(), false);
    std::array<std::size_t, 6> first{}; // in `ends`, of those that are in
    const auto coordinate = [&](int face, std::size_t at) {
        return local[ends[std::size_t(face)][at]][face / 2];
    };
    for (;;) {
        double best = 0.0;
        int bestFace = -1;
        std::size_t bestCount = 0;
        for (int face = 0; face < 6; ++face) {
            const std::size_t other = std::size_t(face ^ 1), own = std::size_t(face);
            const double extent =
                std::abs(coordinate(face ^ 1, first[other]) - coordinate(face, first[own]));
            std::size_t removed = 0;
            for (std::size_t at = first[own]; at < ends[own].size() && removed <= lost; ++at) {
                if (isOut[ends[own][at]]) continue;
                const double shrunk = std::abs(coordinate(face, at) - coordinate(face, first[own]));
                if (removed > 0 && extent > 0.0) {
                    const double gain = shrunk / extent / double(removed);
                    if (gain > best) {
                        best = gain;
                        bestFace = face;
                        bestCount = removed;
                    }
                }
                ++removed;
            }
        }
        if (bestFace < 0) break;
        lost -= bestCount;
        for (std::size_t at = first[std::size_t(bestFace)]; bestCount > 0; ++at) {
            const std::uint32_t point = ends[std::size_t(bestFace)][at];
            if (!isOut[point]) --bestCount;
            isOut[point] = true;
        }
        for (std::size_t face = 0; face < 6; ++face)
            while (first[face] + 1 < ends[face].size() && isOut[ends[face][first[face]]])
                ++first[face];
    }
    std::array<Range, 3> result{};
    for (int axis = 0; axis < 3; ++axis) {
        const int low = 2 * axis, high = low + 1;
        result[std::size_t(axis)] = {coordinate(low, first[std::size_t(low)]),
                                     coordinate(high, first[std::size_t(high)])};
    }
    return result;
}

Fit fitBox(const Points& points, const glm::dmat3& axes, std::size_t lost) {
    const std::array<Range, 3> box = smallBox(inAxes(points, axes), lost);
    Fit fit;
    fit.axes = axes;
    glm::dvec3 middle(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const Range& range = box[std::size_t(axis)];
        middle[axis] = 0.5 * (range.low + range.high);
        fit.half[axis] = 0.5 * (range.high - range.low);
    }
    const double thin = kThin * std::max({fit.half.x, fit.half.y, fit.half.z});
    fit.half = glm::max(fit.half, glm::dvec3(thin));
    fit.centre = axes * middle;
    fit.volume = volumeOf(fit.kind, fit.half);
    return fit;
}

/// Fits a capsule along the axes' z.
Fit fitCapsule(const Points& points, const glm::dmat3& axes, std::size_t lost) {
    const Points local = inAxes(points, axes);
    const std::size_t count = local.size();
    Fit best;
    // The middle of the smallest circle around all: steps towards the farthest point.
    glm::dvec2 middle(0.0);
    for (const glm::dvec3& p : local) middle += glm::dvec2(p) / double(count);
    std::vector<double> radii(count);
    for (int step = 1; step <= kCircleSteps; ++step) {
        std::size_t farthest = 0;
        for (std::size_t i = 0; i < count; ++i) {
            radii[i] = glm::distance(glm::dvec2(local[i]), middle);
            if (radii[i] > radii[farthest]) farthest = i;
        }
        middle += (glm::dvec2(local[farthest]) - middle) / double(step + 1);
    }
    for (std::size_t i = 0; i < count; ++i) radii[i] = glm::distance(glm::dvec2(local[i]), middle);
    std::vector<double> sorted = radii;
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> low, high;
    for (int third = 0; third <= 3; ++third) {
        const std::size_t beside = lost * std::size_t(third) / 3; // the others at the ends
        const double radius = sorted[count - 1 - beside];
        low.clear();
        high.clear();
        for (std::size_t i = 0; i < count; ++i) {
            if (radii[i] > radius) continue;
            const double cap = std::sqrt(radius * radius - radii[i] * radii[i]);
            low.push_back(local[i].z + cap);
            high.push_back(local[i].z - cap);
        }
        std::sort(low.begin(), low.end());
        std::sort(high.rbegin(), high.rend());
        std::size_t a = 0, b = 0;
        for (std::size_t left = lost - beside; left > 0 && low[a] < high[b]; --left)
            if (low[a + 1] - low[a] > high[b] - high[b + 1])
                ++a;
            else
                ++b;
        Fit fit;
        fit.kind = Shape::Kind::Capsule;
        fit.axes = axes;
        fit.half = {radius, radius, std::max(0.0, 0.5 * (high[b] - low[a]))};
        fit.centre = axes * glm::dvec3(middle, 0.5 * (high[b] + low[a]));
        fit.volume = volumeOf(fit.kind, fit.half);
        if (radius > 0.0 && fit.volume < best.volume) best = fit;
    }
    return best;
}

/// Principal axes, the longest last.
glm::dmat3 principalAxes(const Points& points) {
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& p : points) mean += p / double(points.size());
    glm::dmat3 spread(0.0);
    for (const glm::dvec3& p : points) spread += glm::outerProduct(p - mean, p - mean);
    glm::dvec3 main = spread[0];
    for (int i = 1; i < 3; ++i)
        if (spread[i][i] > glm::length(main)) main = spread[i];
    for (int i = 0; i < 50; ++i) {
        if (!(glm::length(main) > 0.0)) break;
        main = spread * glm::normalize(main);
    }
    main = glm::length(main) > 0.0 ? glm::normalize(main) : glm::dvec3(0, 0, 1);
    const glm::dvec3 x = anyPerpendicular(main), y = glm::cross(main, x);
    const double xx = glm::dot(x, spread * x), yy = glm::dot(y, spread * y);
    const double angle = 0.5 * std::atan2(2.0 * glm::dot(x, spread * y), xx - yy);
    const glm::dvec3 second = std::cos(angle) * x + std::sin(angle) * y;
    return {second, glm::cross(main, second), main};
}

glm::dmat3 rotated(const glm::dmat3& axes, int about, double angle) {
    return glm::mat3_cast(glm::angleAxis(angle, axes[about])) * axes;
}

/// The axes with another one as z.
glm::dmat3 withZ(const glm::dmat3& axes, int z) {
    return {axes[(z + 1) % 3], axes[(z + 2) % 3], axes[z]};
}

/// Turns a fit by smaller and smaller angles as long as it shrinks.
void refine(const Points& points, double inside, Fit& fit) {
    const std::size_t lost = lostOf(points, inside);
    for (double angle = glm::radians(10.0); angle > glm::radians(1.0); angle *= 0.5)
        for (int about = 0; about < 3; ++about)
            for (const double way : {angle, -angle})
                for (;;) {
                    const glm::dmat3 axes = rotated(fit.axes, about, way);
                    const Fit turned = fit.kind == Shape::Kind::Box
                                           ? fitBox(points, axes, lost)
                                           : fitCapsule(points, axes, lost);
                    if (!(turned.volume < 0.999 * fit.volume)) break;
                    fit = turned;
                }
}

/// The smaller of box and capsule.
Fit fit(const Points& points, double inside, const glm::dmat3* like = nullptr) {
    const std::size_t lost = lostOf(points, inside);
    const glm::dmat3 principal = principalAxes(points);
    Fit best;
    const auto take = [&](const Fit& other) {
        if (other.volume < best.volume) best = other;
    };
    if (like) take(fitBox(points, *like, lost));
    for (int z = 0; z < 3; ++z) take(fitCapsule(points, withZ(principal, z), lost));
    for (const double angle : {0.0, 30.0, 60.0})
        take(fitBox(points, rotated(principal, 2, glm::radians(angle)), lost));
    return best;
}

/// A part of a limb and its shape.
struct Piece {
    std::size_t limb = 0;
    LimbSurface surface;
    Fit fit;
    glm::dvec3 across{0.0}; ///< normal of the planes that divide the limb; 0: it is whole
};

/// The two sides of a plane. Edges that cross it are cut, so that both sides end at it.
std::array<LimbSurface, 2> cut(const LimbSurface& surface, const glm::dvec3& normal,
                               double offset) {
    std::array<LimbSurface, 2> sides;
    std::vector<std::uint32_t> index(surface.points.size());
    std::vector<double> above(surface.points.size());
    for (std::size_t i = 0; i < index.size(); ++i) {
        above[i] = glm::dot(surface.points[i], normal) - offset;
        LimbSurface& side = sides[above[i] > 0.0];
        index[i] = static_cast<std::uint32_t>(side.points.size());
        side.points.push_back(surface.points[i]);
    }
    for (const auto& [a, b] : surface.edges) {
        if ((above[a] > 0.0) == (above[b] > 0.0)) {
            sides[above[a] > 0.0].edges.push_back({index[a], index[b]});
            continue;
        }
        const glm::dvec3 point =
            glm::mix(surface.points[a], surface.points[b], above[a] / (above[a] - above[b]));
        for (const std::uint32_t end : {a, b}) {
            LimbSurface& side = sides[above[end] > 0.0];
            side.edges.push_back({index[end], static_cast<std::uint32_t>(side.points.size())});
            side.points.push_back(point);
        }
    }
    return sides;
}

/// The division of a piece that saves the most; none where it saves too little.
struct Division {
    std::vector<Piece> parts;
    double saving = 0.0;
};

/// All planes that divide a limb are parallel: its parts are solid slices. Panels around a hollow
/// would have less volume.
Division divide(const Piece& piece, double inside) {
    Division best;
    best.saving = kMinSaving * piece.fit.volume;
    std::vector<glm::dvec3> normals{piece.across};
    if (piece.across == glm::dvec3(0.0))
        normals = {piece.fit.axes[0], piece.fit.axes[1], piece.fit.axes[2]};
    for (const glm::dvec3& normal : normals) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& point : piece.surface.points) {
            low = std::min(low, glm::dot(point, normal));
            high = std::max(high, glm::dot(point, normal));
        }
        for (const double at : {0.25, 0.5, 0.75}) {
            std::array<LimbSurface, 2> sides = cut(piece.surface, normal, glm::mix(low, high, at));
            if (std::min(sides[0].points.size(), sides[1].points.size()) < kMinPoints) continue;
            std::array<Fit, 2> fits;
            for (std::size_t i = 0; i < 2; ++i)
                fits[i] = fit(sides[i].points, inside, &piece.fit.axes);
            const double saving = piece.fit.volume - fits[0].volume - fits[1].volume;
            if (!(saving > best.saving)) continue;
            best.saving = saving;
            best.parts.clear();
            for (std::size_t i = 0; i < 2; ++i)
                best.parts.push_back({piece.limb, std::move(sides[i]), fits[i], normal});
        }
    }
    return best;
}

Shape shapeOf(const Fit& fit) {
    Shape shape;
    shape.kind = fit.kind;
    shape.half.set(fit.half.x, fit.half.y, fit.half.z);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) shape.frame(row, column) = fit.axes[row][column];
    shape.frame.setTrans(fit.centre.x, fit.centre.y, fit.centre.z);
    return shape;
}

} // namespace

Shape fitShape(const LimbSurface& surface, double inside) {
    return shapeOf(fit(surface.points, inside));
}

std::vector<std::vector<Shape>> fitShapes(const std::vector<LimbSurface>& limbs, double bodyVolume,
                                          const HitBoxes::Options& options) {
    std::vector<Piece> pieces;
    std::vector<Division> divisions; // [piece]
    std::vector<std::size_t> counts(limbs.size(), 1);
    double sum = 0.0;
    const auto add = [&](Piece piece) {
        refine(piece.surface.points, options.inside, piece.fit);
        sum += piece.fit.volume;
        divisions.push_back(options.maxShapes > 1 ? divide(piece, options.inside) : Division());
        pieces.push_back(std::move(piece));
    };
    for (std::size_t i = 0; i < limbs.size(); ++i)
        add({i, limbs[i], fit(limbs[i].points, options.inside), glm::dvec3(0.0)});
    while (sum > options.volume * bodyVolume) {
        std::size_t best = pieces.size();
        for (std::size_t i = 0; i < pieces.size(); ++i)
            if (counts[pieces[i].limb] < options.maxShapes && !divisions[i].parts.empty() &&
                (best == pieces.size() || divisions[i].saving > divisions[best].saving))
                best = i;
        if (best == pieces.size()) break;
        std::vector<Piece> parts = std::move(divisions[best].parts);
        ++counts[pieces[best].limb];
        sum -= pieces[best].fit.volume;
        pieces.erase(pieces.begin() + std::ptrdiff_t(best));
        divisions.erase(divisions.begin() + std::ptrdiff_t(best));
        for (Piece& part : parts) add(std::move(part));
    }
    std::vector<std::vector<Shape>> result(limbs.size());
    for (const Piece& piece : pieces) result[piece.limb].push_back(shapeOf(piece.fit));
    return result;
}

void findHinges(const RestSkeleton& rest, const osg::Matrixd& toFigure,
                std::vector<HitBoxes::Limb>& limbs) {
    const JointRoles roles = recogniseJoints(rest);
    const auto between = [&](const std::string& from, const std::string& to) {
        const int a = roles.joint(from), b = roles.joint(to);
        if (a < 0 || b < 0) return osg::Vec3d();
        const auto centre = [&](int joint) {
            return toOsg(rest.joints[std::size_t(joint)].centre) * toFigure;
        };
        osg::Vec3d direction = centre(b) - centre(a);
        direction.normalize();
        return direction;
    };
    const osg::Vec3d ahead = between("Hips", "Head") ^ between("LeftUpperLeg", "RightUpperLeg");
    for (const std::string side : {"Left", "Right"})
        for (const bool isArm : {true, false}) {
            const std::string lower = side + (isArm ? "LowerArm" : "LowerLeg");
            const osg::Vec3d above = between(side + (isArm ? "UpperArm" : "UpperLeg"), lower),
                             below = between(lower, side + (isArm ? "Hand" : "Foot"));
            const int joint = roles.joint(lower);
            if (joint < 0 || !(above * above > 0.0) || !(below * below > 0.0)) continue;
            const double bend = std::acos(std::clamp(above * below, -1.0, 1.0));
            // Elbows bend forwards, knees backwards.
            osg::Vec3d axis = bend > kSureBend ? above ^ below : below ^ (isArm ? ahead : -ahead);
            if (!(axis.normalize() > 0.1)) continue;
            const double sign = bend > kSureBend || (above ^ below) * axis >= 0.0 ? 1.0 : -1.0;
            for (HitBoxes::Limb& limb : limbs) {
                if (limb.joint != rest.joints[std::size_t(joint)].name) continue;
                limb.hinge = axis;
                limb.straight = -sign * bend;
                limb.bent = limb.straight + kMaxBend;
            }
        }
}

} // namespace osgSkin
