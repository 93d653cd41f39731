// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ratios' gradients, which determine the normals of the deformed surface.
#include "PeakMemory.h"
#include "Ratios.h"
#include "Shapes.h"
#include "mesh/SkinSmoother.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

using namespace osgSkin;

namespace {

/// Bend ratio of `joint` on the cylinder's ring at the given height; its vertices must agree.
float ringBend(const SkinMesh& mesh, const Binding& binding, std::size_t joint, double height) {
    float low = 2.0f, high = -1.0f;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (std::abs(mesh.positions[v].y - height) < 1e-9) {
            low = std::fmin(low, ratiosOf(binding, v, joint).bend);
            high = std::fmax(high, ratiosOf(binding, v, joint).bend);
        }
    EXPECT_LE(low, high) << "no ring at " << height;
    EXPECT_NEAR(low, high, 0.15) << "ring at " << height; // the fans' diagonals all lean one way
    return 0.5f * (low + high);
}

} // namespace

TEST(Ratios, RiseFromZeroToOneOverTheJoint) {
    const SkinMesh mesh = shapes::cylinder();
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.0));
    expectSound(binding);
    EXPECT_EQ(ringBend(mesh, binding, 1, 0.0), 0.0f);
    EXPECT_EQ(ringBend(mesh, binding, 1, 2.0), 0.0f);
    EXPECT_NEAR(ringBend(mesh, binding, 1, 4.0), 0.45, 0.1);
    EXPECT_NEAR(ringBend(mesh, binding, 1, 4.25), 0.55, 0.1);
    EXPECT_EQ(ringBend(mesh, binding, 1, 6.25), 1.0f);
    EXPECT_EQ(ringBend(mesh, binding, 1, 8.0), 1.0f);
    float last = 0.0f;
    for (double height = 0.0; height <= 8.0; height += 0.25) {
        const float here = ringBend(mesh, binding, 1, height);
        EXPECT_GE(here, last - 1e-3f) << "at " << height;
        last = here;
    }
}

TEST(Ratios, DoNotDependOnTheUnitOrThePlace) {
    const SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    const Binding near = bind(mesh, skeleton);
    const glm::dvec3 offset(3000.0, -500.0, 200.0);
    for (RestJoint& joint : skeleton.joints) {
        joint.centre = 100.0 * joint.centre + offset;
        if (joint.tip) joint.tip = 100.0 * *joint.tip + offset;
    }
    const Binding far = bind(shapes::moved(mesh, offset, 100.0), skeleton);
    for (std::size_t v = 0; v < near.vertexCount(); ++v)
        ASSERT_NEAR(ratiosOf(near, v, 1).bend, ratiosOf(far, v, 1).bend, 1e-4) << "vertex " << v;
}

TEST(Ratios, SmoothingWidensTheBend) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    BindOptions narrow, wide;
    narrow.smoothing = 0.4;
    wide.smoothing = 1.2;
    const Binding tight = bind(mesh, skeleton, narrow);
    const Binding soft = bind(mesh, skeleton, wide);
    EXPECT_EQ(ringBend(mesh, tight, 1, 3.0), 0.0f);
    EXPECT_GT(ringBend(mesh, soft, 1, 3.0), 0.03f);
    EXPECT_EQ(ringBend(mesh, tight, 1, 5.25), 1.0f);
    EXPECT_LT(ringBend(mesh, soft, 1, 5.25), 0.97f);
}

TEST(Ratios, CutOffStiffensTheLimb) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    BindOptions none, much;
    none.smoothing = much.smoothing = 0.5;
    none.cutOff = 0.0;
    much.cutOff = 0.2;
    EXPECT_LT(ringBend(mesh, bind(mesh, skeleton, none), 1, 5.0), 0.97f);
    EXPECT_EQ(ringBend(mesh, bind(mesh, skeleton, much), 1, 5.0), 1.0f);
}

TEST(Ratios, AuthorsBoundariesAreKept) {
    const SkinMesh mesh = shapes::cylinder();
    BindOptions options;
    options.joints["joint1"].bendUpper = -0.5; // the bone is 3 long: from 2.6 to 5.6
    options.joints["joint1"].bendLower = 0.5;
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.1), options);
    expectSound(binding);
    EXPECT_EQ(ringBend(mesh, binding, 1, 2.25), 0.0f);
    EXPECT_GT(ringBend(mesh, binding, 1, 3.25), 0.02f);
    EXPECT_LT(ringBend(mesh, binding, 1, 3.25), 0.25f);
    EXPECT_NEAR(ringBend(mesh, binding, 1, 4.0), 0.45, 0.05);
    EXPECT_EQ(ringBend(mesh, binding, 1, 6.0), 1.0f);
}

TEST(Ratios, OneBoundaryOfTheAuthorsPlacesTheOther) {
    // The boundary that the author omits is as far behind his own as it would be behind the joint,
    // or at its default.
    const SkinMesh mesh = shapes::cylinder();
    for (const double upper : {-0.5, 0.2}) {
        BindOptions options;
        options.joints["joint1"].bendUpper = upper; // the bone is 3 long
        const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.1), options);
        expectSound(binding);
        const double begins = 4.1 + 3.0 * upper;
        EXPECT_LT(ringBend(mesh, binding, 1, std::floor(4.0 * begins - 1.0) / 4.0), 0.05f) << upper;
        EXPECT_EQ(ringBend(mesh, binding, 1, 6.5), 1.0f) << upper;
        EXPECT_LT(ringBend(mesh, binding, 1, 4.25), 0.9f) << upper;
    }
}

TEST(Ratios, SkippedJointTurnsWhatItsChildTurns) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 3.1, 5.1}, 7.0);
    BindOptions options;
    options.joints["joint1"].skip = true;
    const Binding binding = bind(mesh, skeleton, options);
    expectSound(binding);
    const Binding plain = bind(mesh, skeleton);
    bool differs = false;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        ASSERT_NE(binding.regions[v], 1u);
        ASSERT_EQ(ratiosOf(binding, v, 1).bend, ratiosOf(binding, v, 2).bend) << "vertex " << v;
        differs = differs || ratiosOf(plain, v, 1).bend != ratiosOf(plain, v, 2).bend;
    }
    EXPECT_TRUE(differs);
}

TEST(Ratios, JointOfNoLengthTurnsWhatItsChildrenTurn) {
    const SkinMesh mesh = shapes::hangingArms();
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "chest", "", {0, 1, 0});
    shapes::addJoint(skeleton, "both", "chest", {0, 1, 0}); // its parent's position
    shapes::addJoint(skeleton, "left", "both", {1.6, -0.9, 0});
    shapes::addJoint(skeleton, "right", "both", {-1.6, -0.9, 0});
    const Binding binding = bind(mesh, skeleton);
    expectSound(binding);
    std::size_t turned = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const float most = std::fmax(ratiosOf(binding, v, 2).bend, ratiosOf(binding, v, 3).bend);
        ASSERT_EQ(ratiosOf(binding, v, 1).bend, most) << "vertex " << v;
        if (most == 1.0f) ++turned;
    }
    EXPECT_GT(turned, 100u);
}

TEST(Ratios, StayContinuousWhereManyJointsMeet) {
    // A ball with six joints close to its centre: more than four of them would rotate every vertex.
    const SkinMesh ball = shapes::voxelSurface(
        [](int x, int y, int z) {
            return (x + .5) * (x + .5) + (y + .5) * (y + .5) + (z + .5) * (z + .5) < 100.0;
        },
        12, 0.1);
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "middle", "", {0.02, 0.01, 0.03});
    const glm::dvec3 ways[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const glm::dvec3& way : ways)
        shapes::addJoint(skeleton, "joint" + std::to_string(skeleton.joints.size()), "middle",
                         0.3 * way);
    BindOptions options;
    options.smoothing = 2.0;
    options.cutOff = 0.0;
    BindReport report;
    const Binding binding = bind(ball, skeleton, options, &report);
    expectSound(binding);
    EXPECT_GT(report.cappedVertices, 50u);
    options.maxPartialInfluences = 8;
    BindReport free;
    bind(ball, skeleton, options, &free);
    EXPECT_EQ(free.cappedVertices, 0u);
    std::size_t corner = 0;
    float steepest = 0.0f;
    for (const std::uint32_t size : ball.faceSizes) {
        for (std::uint32_t k = 0; k < size; ++k)
            for (std::size_t j = 1; j < binding.joints.size(); ++j) {
                const std::uint32_t a = ball.faceVertices[corner + k];
                const std::uint32_t b = ball.faceVertices[corner + (k + 1) % size];
                steepest = std::fmax(steepest, std::abs(ratiosOf(binding, a, j).bend -
                                                        ratiosOf(binding, b, j).bend));
            }
        corner += size;
    }
    EXPECT_LT(steepest, 0.3f); // rounding only the surplus joints would make steps of up to 0.5
}

TEST(Ratios, AreTheSameEachTime) {
    const SkinMesh mesh = shapes::hangingArms();
    const Binding a = bind(mesh, shapes::hangingArmsSkeleton());
    const Binding b = bind(mesh, shapes::hangingArmsSkeleton());
    ASSERT_EQ(a.regions, b.regions);
    ASSERT_EQ(a.influences.size(), b.influences.size());
    for (std::size_t i = 0; i < a.influences.size(); ++i) {
        ASSERT_EQ(a.influences[i].bend, b.influences[i].bend);
        ASSERT_EQ(a.influences[i].twist, b.influences[i].twist);
    }
}

/// A ratio for every joint at every vertex would take 480 MB.
TEST(Ratios, TakeMemoryWhereTheyAreNotZero) {
    const SkinMesh mesh = shapes::cylinder(80.0);
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 40.0}, 79.0);
    while (skeleton.joints.size() < 6000) {
        const auto j = static_cast<double>(skeleton.joints.size());
        shapes::addJoint(skeleton, "j" + std::to_string(skeleton.joints.size()), "joint0",
                         {0.1, 0.013 * j, 0.1});
        skeleton.joints.back().tip = skeleton.joints.back().centre + glm::dvec3(0.1, 0.1, 0.0);
    }
    const auto before = peakMemory();
    const Binding binding = bind(mesh, skeleton);
#ifndef __SANITIZE_ADDRESS__ // the sanitizer keeps freed memory for a while
    EXPECT_LT(peakMemory() - before, 100);
#else
    static_cast<void>(before);
#endif
    EXPECT_EQ(binding.vertexCount(), mesh.positions.size());
}

/// A vertex of a chain's last joint has ratios for all joints, one of its first joint only for that
/// one.
TEST(Ratios, AreAsManyAsJointsAboveVertices) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({1.0, 4.0, 6.0}, 7.0);
    BindOptions options;
    std::size_t above = 0;
    for (const std::uint32_t region : bind(mesh, skeleton, options).regions) above += region + 1;
    options.maxInfluences = above;
    EXPECT_NO_THROW(bind(mesh, skeleton, options));
    options.maxInfluences = above - 1;
    try {
        bind(mesh, skeleton, options);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.what(), "bind: " + std::to_string(mesh.positions.size()) +
                                    " vertices that follow chains of up to 3 joints have " +
                                    std::to_string(above) +
                                    " influences together, expected at most " +
                                    std::to_string(above - 1) + " (option maxInfluences)");
    }
}

/// Each vertex has every joint of a long chain above it: the binding itself takes 36 bytes for
/// each.
TEST(Ratios, OfALongChainTakeLittleMoreThanTheBinding) {
    const SkinMesh mesh = shapes::cylinder(80.0);
    RestSkeleton skeleton = shapes::chainAlongY({1.0}, 1.0);
    for (int j = 1; j < 700; ++j)
        shapes::addJoint(skeleton, "chain" + std::to_string(j), skeleton.joints.back().name,
                         {0.0, 1.0 + 1e-4 * j, 0.0});
    skeleton.joints.back().tip = glm::dvec3(0.0, 79.0, 0.0);
    const auto before = peakMemory();
    const Binding binding = bind(mesh, skeleton);
    ASSERT_GT(binding.influences.size(), 600 * mesh.positions.size());
    ASSERT_EQ(binding.gradients.size(), binding.influences.size());
#ifndef __SANITIZE_ADDRESS__ // the sanitizer keeps freed memory for a while
    const auto influences = static_cast<long>(binding.influences.size());
    EXPECT_LT(peakMemory() - before, influences * 90 / 1'048'576);
#else
    static_cast<void>(before);
#endif
}

namespace {

/// Index of a vertex's influence by a joint, or the end index.
std::uint32_t find(const Binding& binding, std::uint32_t vertex, std::uint32_t joint) {
    std::uint32_t i = binding.firstInfluence[vertex];
    while (i < binding.firstInfluence[vertex + 1] && binding.influences[i].joint != joint) ++i;
    return i;
}

/// Area-weighted normals.
std::vector<glm::vec3> normalsOf(const std::vector<glm::vec3>& points,
                                 const std::vector<std::uint32_t>& corners) {
    std::vector<glm::vec3> normals(points.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        const glm::vec3& a = points[corners[t]];
        const glm::vec3 area = glm::cross(points[corners[t + 1]] - a, points[corners[t + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[corners[t + k]] += area;
    }
    for (glm::vec3& normal : normals) normal = glm::normalize(normal);
    return normals;
}

BindOptions withNormals() {
    BindOptions options;
    options.surfaceNormals = true;
    return options;
}

struct NormalError {
    double mean = 0.0, percentile95 = 0.0; ///< degrees
};

/// For a cylinder along y that is bent at y = 4, within 2.5 of the bend.
NormalError errorOf(const SkinMesh& mesh, const Binding& binding, double degrees) {
    std::vector<std::uint32_t> source(mesh.positions.size());
    std::iota(source.begin(), source.end(), 0u);
    const std::vector<glm::vec3> rest(mesh.positions.begin(), mesh.positions.end());
    const auto model = SkinModel::create(binding, rest, normalsOf(rest, mesh.triangles()), source);
    const glm::dvec3& centre = binding.joints[1].centre;
    std::vector<glm::dmat4> skinning(binding.joints.size(), glm::dmat4(1.0));
    skinning[1] = glm::translate(glm::dmat4(1.0), centre);
    skinning[1] = glm::rotate(skinning[1], glm::radians(degrees), glm::dvec3(1, 0, 0));
    skinning[1] = glm::translate(skinning[1], -centre);
    DeformOptions options;
    options.normals = true;
    const auto [posed, normals, tangents] = deform(*model, skinning, options);
    const std::vector<glm::vec3> wanted = normalsOf(posed, mesh.triangles());
    std::vector<double> errors;
    for (std::size_t v = 0; v < rest.size(); ++v)
        if (std::abs(rest[v].y - 4.0f) < 2.5f)
            errors.push_back(
                glm::degrees(std::acos(std::min(1.0, double(glm::dot(wanted[v], normals[v]))))));
    std::sort(errors.begin(), errors.end());
    const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
    return {sum / double(errors.size()), errors[errors.size() * 95 / 100]};
}

} // namespace

TEST(SurfaceNormals, OfABentLimbAreThoseOfItsTriangles) {
    const SkinMesh mesh = shapes::cylinder(8.0, 32);
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    for (const auto shapes : {BindOptions::Shapes::None, BindOptions::Shapes::Fast}) {
        SCOPED_TRACE(shapes == BindOptions::Shapes::Fast ? "fast" : "none");
        BindOptions options = withNormals();
        options.shapes = shapes;
        const Binding binding = bind(mesh, skeleton, options);
        EXPECT_EQ(binding.correctives.hasNormals(), shapes == BindOptions::Shapes::Fast);
        options.surfaceNormals = false;
        const Binding turned = bind(mesh, skeleton, options);
        for (const double degrees : {90.0, 120.0, 140.0}) {
            SCOPED_TRACE(degrees);
            const NormalError error = errorOf(mesh, binding, degrees);
            EXPECT_LE(error.mean, 3.0);
            EXPECT_LE(error.percentile95, 12.0);
            EXPECT_GE(errorOf(mesh, turned, degrees).mean, 2.0 * error.mean);
        }
    }
}

TEST(RatioGradients, SayHowRatiosGrowAlongEdges) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    BindOptions options = withNormals();
    options.shapes = BindOptions::Shapes::None; // shapes shorten gradients to open folds
    const Binding binding = bind(mesh, skeleton, options);
    ASSERT_EQ(binding.gradients.size(), binding.influences.size());
    const std::vector<std::uint32_t> corners = mesh.triangles();
    double worst = 0.0, steepest = 0.0;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const std::uint32_t a = corners[c], b = corners[c % 3 == 2 ? c - 2 : c + 1];
        const std::uint32_t i = find(binding, a, 1), j = find(binding, b, 1);
        if (i == binding.firstInfluence[a + 1] || j == binding.firstInfluence[b + 1]) continue;
        if (!binding.influences[i].isPartial() || !binding.influences[j].isPartial()) continue;
        const glm::vec3 way(mesh.positions[b] - mesh.positions[a]);
        const float bend = binding.influences[j].bend - binding.influences[i].bend;
        const float twist = binding.influences[j].twist - binding.influences[i].twist;
        const RatioGradient &ga = binding.gradients[i], &gb = binding.gradients[j];
        worst = std::max({worst, double(std::abs(bend - 0.5f * glm::dot(ga.bend + gb.bend, way))),
                          double(std::abs(twist - 0.5f * glm::dot(ga.twist + gb.twist, way)))});
        steepest = std::max(steepest, double(std::abs(bend)));
    }
    EXPECT_GE(steepest, 0.05); // otherwise there is nothing to compare
    EXPECT_LE(worst, 0.2 * steepest);
}

TEST(RatioGradients, AreTheSameOnBothSidesOfASeam) {
    SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    const Binding whole = bind(mesh, skeleton, withNormals());
    // Gives the first face's corners vertices of their own.
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<std::uint32_t> from;
    std::size_t first = 0;
    for (std::size_t face = 0; face < mesh.faceSizes.size() / 2; ++face)
        first += mesh.faceSizes[face];
    for (std::size_t k = first; k < first + mesh.faceSizes[mesh.faceSizes.size() / 2]; ++k) {
        from.push_back(mesh.faceVertices[k]);
        mesh.positions.push_back(mesh.positions[from.back()]);
        mesh.faceVertices[k] = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
    const Binding split = bind(mesh, skeleton, withNormals());
    bool any = false;
    for (std::uint32_t k = 0; k < from.size(); ++k) {
        const std::uint32_t copy = vertices + k;
        const std::uint32_t i = split.firstInfluence[copy], was = whole.firstInfluence[from[k]];
        ASSERT_EQ(split.firstInfluence[copy + 1] - i, whole.firstInfluence[from[k] + 1] - was);
        for (std::uint32_t n = 0; i + n < split.firstInfluence[copy + 1]; ++n) {
            EXPECT_LE(glm::distance(split.gradients[i + n].bend, whole.gradients[was + n].bend),
                      1e-5f);
            any = any || glm::length(whole.gradients[was + n].bend) > 0.01f;
        }
    }
    EXPECT_TRUE(any);
}

TEST(RatioGradients, AreLeftOutWhereNormalsOnlyTurn) {
    BindOptions options;
    options.surfaceNormals = false;
    const Binding binding = bind(shapes::cylinder(), shapes::chainAlongY({0.0, 4.0}, 8.0), options);
    EXPECT_TRUE(binding.gradients.empty());
}

namespace {

constexpr double kLength = 10.0;

/// Rings of triangles around y, radius 1, each vertex moved by up to `jitter` edge lengths.
SkinMesh tube(int sides, double jitter) {
    SkinMesh mesh;
    const double edge = glm::two_pi<double>() / sides;
    const int rings = static_cast<int>(std::lround(kLength / (edge * std::sqrt(0.75))));
    std::mt19937 random(1);
    const auto moved = [&] {
        return jitter * (static_cast<double>(random()) / 2147483648.0 - 1.0);
    };
    const auto at = [&](int ring, int side) {
        return static_cast<std::uint32_t>(ring * sides + (side + sides) % sides);
    };
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const double angle = (s + 0.5 * (r % 2) + moved()) * edge;
            const double y = kLength * (r + (r % rings == 0 ? 0.0 : moved())) / rings;
            mesh.positions.emplace_back(std::sin(angle), y, std::cos(angle));
            if (r == rings) continue;
            const int odd = r % 2;
            for (const std::uint32_t v :
                 {at(r, s), at(r, s + 1), at(r + 1, s + odd), // one up, one down
                  at(r, s), at(r + 1, s + odd), at(r + 1, s + odd - 1)})
                mesh.faceVertices.push_back(v);
        }
    mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    return mesh;
}

/// Five implicit Euler steps on a line of cells: the expected value of the tube's field at `y`.
class Line {
public:
    Line(double border, double above, double below) {
        std::vector<double> width(kCells), lower(kCells), upper(kCells);
        const double cell = kLength / kCells;
        for (std::size_t i = 0; i < kCells; ++i) {
            const bool isAbove = (static_cast<double>(i) + 0.5) * cell < border;
            width[i] = isAbove ? above : below;
            _values[i] = isAbove ? 0.0 : 1.0;
        }
        const auto between = [&](std::size_t i) {
            return 0.5 * (width[i] + width[i + 1]) / (5.0 * cell * cell);
        };
        for (int step = 0; step < 5; ++step) { // Thomas's algorithm
            std::vector<double> c(kCells), d(kCells);
            for (std::size_t i = 0; i < kCells; ++i) {
                const double left = i > 0 ? between(i - 1) : 0.0;
                const double right = i + 1 < kCells ? between(i) : 0.0;
                const double pivot = 1.0 / width[i] + left + right + (i > 0 ? left * c[i - 1] : 0);
                c[i] = -right / pivot;
                d[i] = (_values[i] / width[i] + (i > 0 ? left * d[i - 1] : 0.0)) / pivot;
            }
            for (std::size_t i = kCells; i-- > 0;)
                _values[i] = d[i] - (i + 1 < kCells ? c[i] * _values[i + 1] : 0.0);
        }
    }
    double at(double y) const {
        const double cell = std::clamp(y / kLength * kCells - 0.5, 0.0, kCells - 1.0);
        const auto i = std::min(static_cast<std::size_t>(cell), kCells - 2);
        const double t = cell - static_cast<double>(i);
        return (1.0 - t) * _values[i] + t * _values[i + 1];
    }

private:
    static constexpr std::size_t kCells = 4000;
    std::vector<double> _values = std::vector<double>(kCells);
};

struct Tube {
    const char* name;
    int sides;
    double jitter, above, below;
};

class Smoothed : public testing::TestWithParam<Tube> {
protected:
    double worst(double widest) const {
        const Tube& t = GetParam();
        const WeldedMesh mesh(tube(t.sides, t.jitter));
        std::vector<double> field(mesh.vertexCount()), widths(mesh.vertexCount());
        double lastAbove = 0.0, firstBelow = kLength; // the boundary is between them
        for (std::size_t v = 0; v < field.size(); ++v) {
            const double y = mesh.positions[v].y;
            const bool isAbove = y < kLength / 2;
            field[v] = isAbove ? 0.0 : 1.0;
            widths[v] = isAbove ? t.above : t.below;
            if (isAbove) lastAbove = std::max(lastAbove, y);
            if (!isAbove) firstBelow = std::min(firstBelow, y);
        }
        SkinSmoother(mesh, widest).smooth(field, widths);
        const Line line(0.5 * (lastAbove + firstBelow), t.above, t.below);
        double worst = 0.0;
        for (std::size_t v = 0; v < field.size(); ++v)
            worst = std::max(worst, std::abs(field[v] - line.at(mesh.positions[v].y)));
        return worst;
    }
};

} // namespace

TEST_P(Smoothed, IsHeatAlongTheTube) {
    EXPECT_LT(worst(0.0), 0.01);
}

TEST_P(Smoothed, IsMuchTheSameOnCoarserSkins) {
    EXPECT_LT(worst(1.0), 0.02);
}

INSTANTIATE_TEST_SUITE_P(SkinSmoother, Smoothed,
                         testing::Values(Tube{"Even", 150, 0.0, 1.0, 1.0},
                                         Tube{"Jittered", 150, 0.3, 1.0, 1.0},
                                         Tube{"TwoWidths", 150, 0.3, 1.0, 0.6},
                                         Tube{"TwiceCoarser", 300, 0.2, 1.0, 1.0}),
                         [](const auto& test) { return test.param.name; });
