// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_JOINTSOLVING_H
#define OSGSKINBIND_ELASTIC_JOINTSOLVING_H

#include "elastic/joint/ElasticJoint.h"
#include "elastic/joint/ElasticShapes.h"
#include "elastic/joint/ElasticSkin.h"
#include "elastic/solve/JointSolid.h"
#include "elastic/solve/SampleTree.h"
#include "elastic/solve/SharedProgress.h"

#include <memory>
#include <vector>

namespace osgSkin::elastic {

/// One joint on its way from ElasticJoint to ElasticShapes.
class JointSolving {
public:
    /// All outlive this object.
    JointSolving(const ElasticSkin& skin, const ElasticJoint& joint, SharedProgress& progress);

    ElasticShapes run();

private:
    Point toJoint(const glm::dvec3& point) const;
    glm::dvec3 fromJoint(const Point& point) const;
    void prepare(ElasticShapes& shapes);
    /// A sample, and what was solved in its place where it is bad.
    struct Solved {
        ElasticSample sample;
        std::vector<ElasticSample> before;
    };
    void follow(std::size_t from, const JointSolid::State& state,
                std::vector<Solved>& samples) const;
    void leaveOut(std::size_t from, std::vector<Solved>& samples) const;
    std::vector<ElasticSample> approach(JointSolid::State from,
                                        const Eigen::Quaterniond& bad) const;
    JointSolid::State bend(const JointSolid::State& from, const Eigen::Quaterniond& to,
                           ElasticSample& sample) const;
    ElasticSample sampleOf(const JointSolid::State& state,
                           const Eigen::Quaterniond& rotation) const;
    /// Pairs of triangles that cut each other, beyond rest.
    std::size_t crossings(const Points& posed) const;
    std::size_t plainCrossings(const Eigen::Quaterniond& rotation) const;
    bool isHopeless(const JointSolid::State& state) const;

    const ElasticSkin& _skin;
    const ElasticJoint& _joint;
    SharedProgress& _progress;
    std::vector<Eigen::Quaterniond> _rotations; ///< the samples', unit
    SampleTree _tree;
    std::unique_ptr<const JointSolid> _solid;
    std::size_t _crossingsAtRest = 0;
};

} // namespace osgSkin::elastic

#endif
