// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/SolveElastic.h"

#include "elastic/MirroredJoint.h"
#include "elastic/solve/EachAtOnce.h"
#include "elastic/solve/JointSolving.h"
#include "elastic/solve/SharedProgress.h"

#include <optional>
#include <utility>

namespace osgSkin {
namespace {

/// An earlier joint that a joint mirrors, if there is one.
struct Mirror {
    std::size_t of = 0;
    std::optional<elastic::MirroredJoint> how;
};

std::vector<Mirror> mirrorsOf(const ElasticSkin& skin, const std::vector<ElasticJoint>& joints) {
    std::vector<Mirror> mirrors(joints.size());
    if (joints.size() < 2 || skin.triangles.empty()) return mirrors;
    elastic::Points positions(3, static_cast<Eigen::Index>(skin.positions.size()));
    for (std::size_t v = 0; v < skin.positions.size(); ++v) {
        const glm::dvec3& p = skin.positions[v];
        positions.col(static_cast<Eigen::Index>(v)) << p.x, p.y, p.z;
    }
    const elastic::RestSkin rest(std::move(positions), skin.triangles);
    std::vector<bool> taken(joints.size(), false);
    for (std::size_t i = 1; i < joints.size(); ++i)
        for (std::size_t k = 0; k < i && !mirrors[i].how; ++k) {
            if (taken[k] || mirrors[k].how) continue;
            mirrors[i] = {k, elastic::MirroredJoint::find(rest, joints[k], joints[i])};
            taken[k] = mirrors[i].how.has_value();
        }
    return mirrors;
}

} // namespace

ElasticShapes solveElasticJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                                const Progress& progress) {
    return solveElasticJoints(skin, {joint}, progress).front();
}

std::vector<ElasticShapes> solveElasticJoints(const ElasticSkin& skin,
                                              const std::vector<ElasticJoint>& joints,
                                              const Progress& progress) {
    const std::vector<Mirror> mirrors = mirrorsOf(skin, joints);
    std::vector<std::size_t> toSolve;
    std::size_t whole = 0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (mirrors[i].how) continue;
        toSolve.push_back(i);
        whole += joints[i].samples.size();
    }
    elastic::SharedProgress shared(whole);
    std::vector<ElasticShapes> shapes(joints.size());
    shared.tellWhile(progress, [&] {
        elastic::eachAtOnce(toSolve.size(), [&](std::size_t i) {
            shapes[toSolve[i]] = elastic::JointSolving(skin, joints[toSolve[i]], shared).run();
        });
    });
    for (std::size_t i = 0; i < joints.size(); ++i)
        if (mirrors[i].how) shapes[i] = mirrors[i].how->shapes(shapes[mirrors[i].of]);
    return shapes;
}

} // namespace osgSkin
