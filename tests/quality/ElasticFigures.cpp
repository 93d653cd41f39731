// SPDX-License-Identifier: GPL-3.0-or-later
#include "ElasticFigures.h"

#include "Methods.h"
#include "SelfIntersections.h"

#include <elastic/SolveElastic.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace quality {
namespace {

using osgSkin::ElasticJoint;
using osgSkin::ElasticSample;
using osgSkin::ElasticShapes;

/// Distance of skin to bone, posed over rest: 2nd and 98th percentile on the fold's outer side,
/// within a radius of the joint's plane.
struct OuterSide {
    double low = 0.0, high = 0.0;
};

/// Cosine of the angle about the bone, from the outermost line, that the outer side takes up.
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
        // What an incompressible solid gives way sideways is no bulge.
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
    JointTable(const Subject& subject, const ElasticJoint& joint, const ElasticShapes& shapes,
               SelfIntersections& intersections, const std::string& folder)
        : _subject(subject), _joint(joint), _shapes(shapes), _intersections(intersections),
          _folder(folder), _index(static_cast<std::size_t>(subject.joint(joint.name))) {}

    void print() const {
        std::printf("\n%s %s: r = %.4f, %zu cells, %zu nodes, %zu vertices, %.1f s%s%s\n",
                    _subject.name.c_str(), _joint.name.c_str(), _joint.radius, _shapes.cells,
                    _shapes.nodes, _shapes.vertices.size(), _shapes.seconds,
                    _shapes.reason.empty() ? "" : "; not solved: ", _shapes.reason.c_str());
        if (!_shapes.reason.empty()) return;
        std::printf("angle   axis             | steps    J  volume  s   | pairs: LBS DQS plain "
                    "elastic | RMS/r: LBS  DQS plain | outer 2-98 %%: plain, elastic\n");
        for (std::size_t i = 0; i < _shapes.samples.size(); ++i) line(_shapes.samples[i], i);
    }

private:
    void line(const ElasticSample& sample, std::size_t number) const {
        const glm::dvec3 axis = glm::axis(sample.rotation);
        std::printf("%5.1f %5.2f %5.2f %5.2f %s | %4d %5.2f %6.3f %4.1f |",
                    glm::degrees(glm::angle(sample.rotation)), axis.x, axis.y, axis.z,
                    sample.converged ? " " : "!", sample.steps, sample.leastJacobian,
                    sample.volumeRatio, sample.seconds);
        if (sample.positions.empty()) {
            std::printf(" %s\n", sample.reason.c_str());
            return;
        }
        const auto skinning = singleTurn(_subject, _index, axis, glm::angle(sample.rotation));
        PerMethod<compare::Points> posed;
        for (const Method method : kMethods) posed[method] = deform(_subject, method, skinning);
        const compare::Points& plain = posed[Method::Ours];
        compare::Points elastic = plain;
        for (std::size_t i = 0; i < sample.positions.size(); ++i)
            elastic[_shapes.vertices[i]] = sample.positions[i];
        for (const Method method : kMethods)
            std::printf(" %4zu", _intersections.beyondRest(posed[method]));
        std::printf(" %4zu |", _intersections.beyondRest(elastic));
        for (const Method method : kMethods)
            std::printf(" %.3f", rmsDistance(_shapes, _joint, posed[method], elastic));
        for (const compare::Points* points :
             {&plain, static_cast<const compare::Points*>(&elastic)}) {
            const OuterSide outer = outerSide(_subject, _index, _joint, _shapes, sample, *points);
            std::printf(" | %.2f %.2f", outer.low, outer.high);
        }
        std::printf(" %s\n", sample.reason.c_str());
        std::fflush(stdout);
        if (_folder.empty()) return;
        const std::string stem = _subject.name + '_' + _joint.name + '_' + std::to_string(number);
        writeObj(std::filesystem::path(_folder) / (stem + "_plain.obj"), _subject, plain);
        writeObj(std::filesystem::path(_folder) / (stem + "_elastic.obj"), _subject, elastic);
    }

    const Subject& _subject;
    const ElasticJoint& _joint;
    const ElasticShapes& _shapes;
    SelfIntersections& _intersections;
    const std::string& _folder;
    std::size_t _index;
};

} // namespace

void measureElastic(const Subject& subject, const ElasticRun& run) {
    if (!run.folder.empty()) std::filesystem::create_directories(run.folder);
    std::vector<ElasticJoint> joints;
    for (const std::string& name : run.joints) {
        std::vector<glm::dquat>& samples =
            joints.emplace_back(elasticJointOf(subject, name)).samples;
        samples.resize(std::min(samples.size(), run.mostSamples));
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t t = 0; t + 2 < subject.triangles.size(); t += 3)
        triangles.push_back(
            {subject.triangles[t], subject.triangles[t + 1], subject.triangles[t + 2]});
    const auto start = std::chrono::steady_clock::now();
    const std::vector<ElasticShapes> shapes = osgSkin::solveElasticJoints(
        {subject.rest, triangles}, joints, [](const std::string& what, double share) {
            std::fprintf(stderr, "\r%3.0f %% %-16s", 100.0 * share, what.c_str());
        });
    std::fprintf(stderr, "\r%24s\r", "");
    std::printf("\n%s: %zu joints in %.1f s\n", subject.name.c_str(), joints.size(),
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    SelfIntersections intersections(subject);
    for (std::size_t i = 0; i < joints.size(); ++i)
        JointTable(subject, joints[i], shapes[i], intersections, run.folder).print();
}

} // namespace quality
