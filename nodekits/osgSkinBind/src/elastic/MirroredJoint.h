// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_MIRROREDJOINT_H
#define OSGSKINBIND_ELASTIC_MIRROREDJOINT_H

#include "elastic/joint/ElasticJoint.h"
#include "elastic/joint/ElasticShapes.h"
#include "elastic/joint/ElasticSkin.h"
#include "elastic/skin/RestSkin.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgSkin::elastic {

/// The plane midway between two joints.
struct MirrorPlane {
    glm::dvec3 through{0.0}, normal{0.0}; ///< normal: unit

    glm::dvec3 mirrored(const glm::dvec3& point) const;
    glm::dquat mirrored(const glm::dquat& rotation) const;
};

/// A joint that another one mirrors, such as the right knee the left one: what is solved for the
/// one serves both. Skins need not mirror each other vertex by vertex.
class MirroredJoint {
public:
    /// \param skin in rest space
    /// \param solved the joint that will be solved
    /// \param joint the other one; outlives this object
    /// \return nothing where skin, ratios, bones or samples within reach are no mirror images
    static std::optional<MirroredJoint> find(const RestSkin& skin, const ElasticJoint& solved,
                                             const ElasticJoint& joint);

    /// The other joint's shapes.
    ElasticShapes shapes(const ElasticShapes& solved) const;

private:
    explicit MirroredJoint(const ElasticJoint& joint) : _joint(&joint) {}

    /// Where a vertex of the other joint's skin lies on the solved one's, once mirrored.
    struct Place {
        std::uint32_t vertex = 0;
        glm::dvec3 rest{0.0};
        std::uint32_t corners[3] = {};
        double shares[3] = {};
    };

    const ElasticJoint* _joint;
    MirrorPlane _plane;
    std::vector<std::size_t> _samples; ///< the solved one for each of the other joint's
    std::vector<Place> _places;
};

} // namespace osgSkin::elastic

#endif
