// SPDX-License-Identifier: GPL-3.0-or-later
#include "ElasticFigures.h"

#include "SkinFigures.h"
#include "Subject.h"

#include <osgSkinBind/Bind>

#include <elastic/SolveElastic.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace quality {

namespace {

using osgSkin::ElasticJoint;
using osgSkin::ElasticSample;
using osgSkin::ElasticShapes;

/// Distance from skin to bone, posed over rest: 2nd and 98th percentile on the fold's outer side,
/// within a radius of the joint's plane.
struct OuterSide {
    double low = 0.0, high = 0.0;
};

/// Cosine of the angle about the bone that the outer side spans, measured from the outermost line.
constexpr double kOuter = 0.7;

double distanceToBones(const glm::dvec3& p, const ElasticJoint& joint, const glm::dmat3& turn) {
    double nearest = 1e300;
    for (const osgSkin::ElasticBone& bone : joint.bones) {
        const glm::dmat3 own = bone.moves ? turn : glm::dmat3(1.0);
        const glm::dvec3 from = own * (bone.from - joint.centre);
        const glm::dvec3 along = own * (bone.to - joint.centre) - from;
        const double square = glm::dot(along, along);
        const double t =
            square > 0.0 ? std::clamp(glm::dot(p - from, along) / square, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(p - from - t * along));
    }
    return nearest;
}

OuterSide outerSide(const Subject& subject, std::size_t index, const ElasticJoint& joint,
                    const ElasticShapes& shapes, const ElasticSample& sample,
                    const compare::Points& posed) {
    const glm::dmat3 turn = glm::mat3_cast(sample.rotation);
    const auto parent = static_cast<std::size_t>(subject.rig.joints[index].parent);
    const glm::dvec3 a = glm::normalize(subject.rig.joints[parent].centre - joint.centre);
    const glm::dvec3 b = turn * subject.binding.joints[index].boneAxis;
    const glm::dvec3 inwards = glm::normalize(a + b), along = glm::normalize(b - a);
    std::vector<double> ratios;
    for (const std::uint32_t v : shapes.vertices) {
        const glm::dvec3 p = posed[v] - joint.centre;
        const double height = glm::dot(along, p);
        // Skin that an incompressible solid pushes out sideways is not a bulge.
        if (-glm::dot(inwards, p) < kOuter * glm::length(p - height * along) ||
            std::abs(height) > joint.radius || glm::length(p) > 3.0 * joint.radius)
            continue;
        ratios.push_back(distanceToBones(p, joint, turn) /
                         distanceToBones(subject.rest[v] - joint.centre, joint, glm::dmat3(1.0)));
    }
    if (ratios.empty()) return {};
    std::sort(ratios.begin(), ratios.end());
    const auto last = static_cast<double>(ratios.size() - 1);
    return {ratios[static_cast<std::size_t>(0.02 * last)],
            ratios[static_cast<std::size_t>(std::ceil(0.98 * last))]};
}

double rmsDistance(const ElasticShapes& shapes, const ElasticJoint& joint, const compare::Points& a,
                   const compare::Points& b) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < shapes.vertices.size(); ++i) {
        if (glm::length(shapes.rest[i] - joint.centre) > 2.0 * joint.radius) continue;
        const glm::dvec3 d = a[shapes.vertices[i]] - b[shapes.vertices[i]];
        sum += glm::dot(d, d);
        ++count;
    }
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) / joint.radius : 0.0;
}

void writeObj(const std::filesystem::path& file, const Subject& subject,
              const compare::Points& posed) {
    std::ofstream out(file);
    for (const glm::dvec3& p : posed) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (std::size_t t = 0; t + 2 < subject.triangles.size(); t += 3)
        out << "f " << subject.triangles[t] + 1 << ' ' << subject.triangles[t + 1] + 1 << ' '
            << subject.triangles[t + 2] + 1 << '\n';
    if (!out) throw std::runtime_error("cannot write " + file.string());
}

/// One joint's table.
class JointTable {
public:
    JointTable(const Subject& subject, const Subject& shaped, const ReferenceJoint& reference,
               const ElasticShapes& shapes, SelfIntersections& intersections,
               const std::string& folder)
        : _subject(subject), _shaped(shaped), _reference(reference), _joint(reference.joint),
          _shapes(shapes), _intersections(intersections), _folder(folder),
          _index(static_cast<std::size_t>(subject.joint(reference.joint.name))) {}

    void print() {
        std::printf("\n%s %s: r = %.4f, %zu cells, %zu nodes, %zu vertices, %.1f s%s%s\n",
                    _subject.name.c_str(), _joint.name.c_str(), _joint.radius, _shapes.cells,
                    _shapes.nodes, _shapes.vertices.size(), _shapes.seconds,
                    _shapes.reason.empty() ? "" : "; not solved: ", _shapes.reason.c_str());
        if (!_shapes.reason.empty()) return;
        std::printf("  angle   axis             | steps    J  volume | pairs: LBS DQS plain fitted "
                    "elastic | RMS/r: LBS DQS plain fitted | outer side, 2 and 98 %%: plain, "
                    "elastic, fitted\n");
        for (std::size_t i = 0; i < _joint.samples.size(); ++i) line(_shapes.samples[i], i);
        for (const bool between : {false, true}) {
            const Summary& sum = _summary[between];
            if (sum.lines == 0) continue;
            std::printf(
                "  %s: %zu bends; fitted RMS/r mean %.3f, most %.3f; farther than a peer at "
                "%zu; pairs %zu of plain %zu; outer side %.2f to %.2f\n",
                between ? "between" : "at samples", sum.lines,
                sum.rms / static_cast<double>(sum.lines), sum.most, sum.farther, sum.pairs,
                sum.plainPairs, sum.outer.low, sum.outer.high);
        }
    }

private:
    struct Summary {
        std::size_t lines = 0, farther = 0, pairs = 0, plainPairs = 0;
        double rms = 0.0, most = 0.0;
        OuterSide outer{1e9, 0.0};
    };

    void line(const ElasticSample& sample, std::size_t number) {
        const bool between = number >= _reference.fitted;
        const glm::dvec3 axis = glm::axis(sample.rotation);
        std::printf("%c %5.1f %5.2f %5.2f %5.2f | %4d %5.2f %6.3f |", between ? '~' : ' ',
                    glm::degrees(glm::angle(sample.rotation)), axis.x, axis.y, axis.z, sample.steps,
                    sample.leastJacobian, sample.volumeRatio);
        if (sample.positions.empty()) {
            std::printf(" %s\n", sample.reason.c_str());
            return;
        }
        const auto skinning = singleTurn(_subject, _index, axis, glm::angle(sample.rotation));
        std::vector<compare::Points> posed;
        posed.reserve(4);
        for (const Method method : kMethods) posed.push_back(deform(_subject, method, skinning));
        posed.push_back(deform(_shaped, Method::Ours, skinning));
        compare::Points elastic = posed[2];
        for (std::size_t i = 0; i < sample.positions.size(); ++i)
            elastic[_shapes.vertices[i]] = sample.positions[i];
        std::vector<std::size_t> pairs;
        pairs.reserve(posed.size());
        for (const compare::Points& points : posed)
            pairs.push_back(_intersections.beyondRest(points));
        for (const std::size_t count : pairs) std::printf(" %4zu", count);
        std::printf(" %4zu |", _intersections.beyondRest(elastic));
        std::vector<double> rms;
        rms.reserve(posed.size());
        for (const compare::Points& points : posed)
            rms.push_back(rmsDistance(_shapes, _joint, points, elastic));
        for (const double distance : rms) std::printf(" %.3f", distance);
        OuterSide outer;
        for (const compare::Points* points : {&posed[2], &elastic, &posed[3]}) {
            outer = outerSide(_subject, _index, _joint, _shapes, sample, *points);
            std::printf(" | %.2f %.2f", outer.low, outer.high);
        }
        std::printf(" %s\n", sample.reason.c_str());
        std::fflush(stdout);
        if (sample.reason.empty()) {
            Summary& sum = _summary[between];
            ++sum.lines;
            sum.rms += rms[3];
            sum.most = std::max(sum.most, rms[3]);
            sum.farther += rms[3] > *std::min_element(rms.begin(), rms.begin() + 3) ? 1 : 0;
            sum.plainPairs += pairs[2];
            sum.pairs += pairs[3];
            sum.outer.low = std::min(sum.outer.low, outer.low);
            sum.outer.high = std::max(sum.outer.high, outer.high);
        }
        if (_folder.empty()) return;
        const std::string stem = _subject.name + '_' + _joint.name + '_' + std::to_string(number);
        const char* names[] = {"_lbs", "_dqs", "_plain", "_fitted"};
        for (std::size_t i = 0; i < posed.size(); ++i)
            writeObj(std::filesystem::path(_folder) / (stem + names[i] + ".obj"), _subject,
                     posed[i]);
        writeObj(std::filesystem::path(_folder) / (stem + "_elastic.obj"), _subject, elastic);
    }

    const Subject& _subject;
    const Subject& _shaped;
    const ReferenceJoint& _reference;
    const ElasticJoint& _joint;
    const ElasticShapes& _shapes;
    SelfIntersections& _intersections;
    const std::string& _folder;
    std::size_t _index;
    Summary _summary[2]; ///< at samples, between
};

/// The body with elastic shapes.
Subject shapedOf(const Subject& subject) {
    Subject shaped = subject;
    osgSkin::BindOptions options = subject.options.value_or(osgSkin::BindOptions());
    options.shapes = osgSkin::BindOptions::Shapes::Elastic;
    options.progress = [](const osgSkin::ProgressStep& step) {
        std::fprintf(stderr, "\r%3.0f %% %-16s", 100.0 * step.fraction, step.what.c_str());
    };
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    shaped.binding = osgSkin::bind(subject.mesh, subject.rig, options, &shaped.report);
    std::fprintf(stderr, "\r%24s\r", "");
    std::printf("\n%s: elastic shapes of %zu joints in %.1f s, %.1f s of processors; %.1f bytes a "
                "vertex\n",
                subject.name.c_str(), shaped.binding.correctives.joints.size(),
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC,
                2.0 * static_cast<double>(shaped.binding.correctives.shares.size()) /
                    static_cast<double>(subject.rest.size()));
    for (const std::string& note : shaped.report.notes) std::printf("  %s\n", note.c_str());
    shaped.model = modelOf(shaped);
    return shaped;
}

} // namespace

void measureElastic(const Subject& subject, const ElasticRun& run) {
    if (!run.folder.empty()) std::filesystem::create_directories(run.folder);
    const Subject shaped = shapedOf(subject);
    std::vector<ReferenceJoint> references;
    std::vector<ElasticJoint> joints;
    joints.reserve(run.joints.size());
    for (const std::string& name : run.joints) {
        references.push_back(referenceJointOf(shaped, name));
        joints.push_back(references.back().joint);
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t t = 0; t + 2 < subject.triangles.size(); t += 3)
        triangles.push_back(
            {subject.triangles[t], subject.triangles[t + 1], subject.triangles[t + 2]});
    const std::vector<ElasticShapes> shapes =
        osgSkin::solveElasticJoints({subject.rest, triangles}, joints);
    SelfIntersections intersections(subject);
    for (std::size_t i = 0; i < joints.size(); ++i)
        JointTable(subject, shaped, references[i], shapes[i], intersections, run.folder).print();
}

namespace {

using osgSkin::CorrectiveJoint;

/// Angles at which a ball joint is measured between the sampled directions, degrees.
constexpr double kBetweenAngles[] = {45.0, 75.0};
constexpr int kDirections = 8;

/// Median distance from the bone's line to the edges on which the ratio crosses one half.
double radiusAt(const Subject& subject, const glm::dvec3& centre, const glm::dvec3& axis,
                const std::vector<double>& ratios) {
    std::vector<double> radii;
    for (const auto& [a, b] : subject.edges) {
        if ((ratios[a] > 0.5) == (ratios[b] > 0.5)) continue;
        const glm::dvec3 d = 0.5 * (subject.rest[a] + subject.rest[b]) - centre;
        radii.push_back(glm::length(d - axis * glm::dot(d, axis)));
    }
    if (radii.empty()) throw std::runtime_error("no skin follows a joint halfway");
    std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2),
                     radii.end());
    return radii[radii.size() / 2];
}

const CorrectiveJoint& correctivesOf(const Subject& shaped, std::size_t joint) {
    for (const CorrectiveJoint& each : shaped.binding.correctives.joints)
        if (each.joint == joint) return each;
    throw std::runtime_error("joint " + shaped.rig.joints[joint].name + " has no shapes");
}

double angleOf(double sineOfHalf) {
    return 2.0 * std::asin(sineOfHalf);
}

/// Midway between a hinge's samples in the main direction.
std::vector<glm::dquat> betweenHinges(const std::vector<glm::dquat>& samples,
                                      const glm::dvec3& axis) {
    std::vector<double> angles{0.0};
    for (const glm::dquat& q : samples)
        if (glm::length(glm::cross(glm::dvec3(q.x, q.y, q.z), axis)) < 1e-9)
            angles.push_back(angleOf(glm::dot(glm::dvec3(q.x, q.y, q.z), axis)));
    std::sort(angles.begin(), angles.end());
    std::vector<glm::dquat> between;
    for (std::size_t i = 1; i < angles.size(); ++i)
        between.push_back(glm::angleAxis(0.5 * (angles[i - 1] + angles[i]), axis));
    return between;
}

/// In directions between those of the samples.
std::vector<glm::dquat> betweenBalls(const glm::dvec3& axis, const glm::dvec3& pole) {
    std::vector<glm::dquat> between;
    for (int i = 0; i < kDirections; ++i)
        for (const double angle : kBetweenAngles)
            between.push_back(glm::angleAxis(
                glm::radians(angle),
                glm::angleAxis(2.0 * glm::pi<double>() * (i + 0.5) / kDirections, pole) * axis));
    return between;
}

void addBones(const Subject& subject, int joint, std::vector<osgSkin::ElasticBone>& bones) {
    const auto& joints = subject.rig.joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j].tip)
            bones.push_back({joints[j].centre, *joints[j].tip,
                             subject.rig.isInSubtree(static_cast<int>(j), joint)});
        if (joints[j].parent < 0) continue;
        bones.push_back({joints[static_cast<std::size_t>(joints[j].parent)].centre,
                         joints[j].centre, subject.rig.isInSubtree(joints[j].parent, joint)});
    }
}

} // namespace

ReferenceJoint referenceJointOf(const Subject& shaped, const std::string& name) {
    const int found = shaped.joint(name);
    if (found < 0) throw std::runtime_error("there is no joint " + name);
    const auto index = static_cast<std::size_t>(found);
    const CorrectiveJoint& functions = correctivesOf(shaped, index);
    ReferenceJoint reference;
    osgSkin::ElasticJoint& joint = reference.joint;
    joint.name = name;
    joint.centre = shaped.rig.joints[index].centre;
    joint.ratios.assign(shaped.rest.size(), 0.0);
    for (std::size_t v = 0; v < shaped.rest.size(); ++v)
        for (std::size_t i = shaped.binding.firstInfluence[v];
             i < shaped.binding.firstInfluence[v + 1]; ++i)
            if (shaped.binding.influences[i].joint == index)
                joint.ratios[v] = double(shaped.binding.influences[i].bend);
    addBones(shaped, found, joint.bones);
    const osgSkin::BoundJoint& bound = shaped.binding.joints[index];
    joint.radius = radiusAt(shaped, joint.centre, bound.boneAxis, joint.ratios);
    joint.hinge = functions.basis == CorrectiveJoint::Basis::Hinge;

    std::vector<glm::dquat> between;
    if (joint.hinge) {
        osgSkin::HingeRange range;
        range.axis = functions.axis;
        range.leastFlexion = angleOf(functions.low.x);
        range.mostFlexion = angleOf(functions.high.x);
        joint.samples = osgSkin::hingeSamples(range, bound.twistAxis);
        between = betweenHinges(joint.samples, functions.axis);
    } else {
        joint.samples =
            osgSkin::ballSamples(bound.twistAxis, functions.axis, angleOf(functions.high.x));
        between = betweenBalls(functions.axis, bound.twistAxis);
    }
    reference.fitted = joint.samples.size();
    joint.samples.insert(joint.samples.end(), between.begin(), between.end());
    return reference;
}

} // namespace quality
