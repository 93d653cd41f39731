// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/SolveElastic.h"

#include "elastic/solve/EachAtOnce.h"
#include "elastic/solve/JointSolving.h"
#include "elastic/solve/SharedProgress.h"

namespace osgSkin {

ElasticShapes solveElasticJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                                const Progress& progress) {
    return solveElasticJoints(skin, {joint}, progress).front();
}

std::vector<ElasticShapes> solveElasticJoints(const ElasticSkin& skin,
                                              const std::vector<ElasticJoint>& joints,
                                              const Progress& progress) {
    std::size_t whole = 0;
    for (const ElasticJoint& joint : joints) whole += joint.samples.size();
    elastic::SharedProgress shared(whole);
    std::vector<ElasticShapes> shapes(joints.size());
    shared.tellWhile(progress, [&] {
        elastic::eachAtOnce(joints.size(), [&](std::size_t i) {
            shapes[i] = elastic::JointSolving(skin, joints[i], shared).run();
        });
    });
    return shapes;
}

} // namespace osgSkin
