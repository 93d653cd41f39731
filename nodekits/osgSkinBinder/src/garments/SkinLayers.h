// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_GARMENTS_SKINLAYERS_H
#define OSGSKINBINDER_GARMENTS_SKINLAYERS_H

#include "joints/JointRegions.h"
#include "mesh/SurfaceQueries.h"
#include "mesh/WeldedMesh.h"
#include "ratios/JointFields.h"
#include "regions/Regions.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// A vertex that lies on another shell.
struct Attached {
    std::uint32_t vertex;
    SurfacePoint on;
    double gap;  ///< distance from it
    double hold; ///< above 0; 1 if it follows the other shell fully
};

/// Finds the vertices of shells that lie on other shells, which are those nearer to the bones. Such
/// a vertex is near the other shell, above it rather than beside it, and has a similar normal. A
/// near vertex with an opposite normal, as on the inside of a cloth, follows the nearest attached
/// vertex of its shell.
///
/// A vertex is not attached if its joint's seeds are on its own shell rather than on those below.
/// Nothing of a shell such as an eye, which has a joint of its own, is attached.
///
/// \param regions found for each shell independently
/// \param radii of limbRadii(), for the limits of distance
/// \return each vertex after those on which it may lie
std::vector<Attached> findAttached(const WeldedMesh& mesh, const Regions& regions,
                                   const std::vector<PlannedJoint>& joints,
                                   const std::vector<double>& radii);

/// Shells that lie on others: clothes on a body, a belt on the clothes. Such a shell must move as
/// the skin below it does, or that shows through, even if other ratios would suit the shell better.
class SkinLayers {
public:
    /// \param mesh must outlive this
    /// \param regions found for each shell independently
    SkinLayers(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
               const Regions& regions);

    /// The number of attached vertices.
    std::size_t size() const { return _attached.size(); }

    /// Gives attached vertices the regions of the skin below them, and vertices of the same shells
    /// that are no seeds the region that is nearest along the shell.
    void follow(Regions& regions) const;

    /// Gives attached vertices the ratios of the skin below them.
    ///
    /// A cloth over a hollow such as an armpit would tear where the ratios of the skin below
    /// change, so they are smoothed, by a width equal to the gap between cloth and skin.
    ///
    /// \param bend one field for each joint
    /// \param twist one field for each joint
    void follow(JointFields& bend, JointFields& twist) const;

    /// Gives attached vertices the displacement of the skin below them.
    /// \param moves of each welded vertex
    void follow(std::vector<glm::dvec3>& moves) const;

private:
    std::vector<bool> layers(double hold) const;
    WeldedMesh layersAlone() const;
    template <typename Value>
    void blend(std::vector<Value>& field) const;

    const WeldedMesh& _mesh;
    std::vector<Attached> _attached;
};

} // namespace osgSkin

#endif
