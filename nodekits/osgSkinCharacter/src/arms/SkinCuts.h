// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_ARMS_SKINCUTS_H
#define OSGSKINCHARACTER_ARMS_SKINCUTS_H

#include "arms/BodyPieces.h"

#include <osgSkin/SkinModel>

#include <osg/ref_ptr>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace osgSkin {

/// Finds triangles of the deformed skin of arms that cut those of trunk, head and thighs, except
/// pairs that do so at rest.
class SkinCuts {
public:
    static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

    /// \param rest valid
    /// \param pieces of the body
    /// \param mesh in rest space
    /// \param binding of `mesh` to `rest`, valid
    SkinCuts(const RestSkeleton& rest, const BodyPieces& pieces, const SkinMesh& mesh,
             const Binding& binding);

    /// Deforms the skin.
    void pose(const PosedJoints& joints);

    /// The pairs in the last pose.
    /// \param arm 0 for the left one, 1 for the right one
    /// \param most where to stop
    /// \return for each pair, where a corner of the arm's triangle is at rest
    std::vector<glm::dvec3> find(std::size_t arm, std::size_t most = kAll) const;

private:
    using Triangle = std::array<std::uint32_t, 3>;
    using Pair = std::pair<std::size_t, std::size_t>; ///< of the arm and of the body
    std::vector<Pair> pairs(std::size_t arm, std::size_t most) const;
    bool cut(const Triangle& a, const Triangle& b) const;

    osg::ref_ptr<const SkinModel> _model;
    std::array<std::vector<Triangle>, 2> _arms;
    std::vector<Triangle> _body;
    std::array<std::set<Pair>, 2> _atRest;
    std::vector<glm::vec3> _places;
};

} // namespace osgSkin

#endif
