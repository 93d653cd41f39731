// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SKINLAYERS_H
#define OSGSKINBIND_SKINLAYERS_H

#include "fields/JointFields.h"
#include "joints/JointPlan.h"
#include "layers/Attached.h"
#include "mesh/WeldedMesh.h"
#include "regions/RegionLabels.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// Shells that lie on others: clothes on a body, a belt on the clothes. Whatever ratios would be
/// the best for such a shell alone, it must move as what is below it does, or the skin shows
/// through.
class SkinLayers {
public:
    /// \param mesh is referred to
    /// \param regions as they are so far
    SkinLayers(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
               const Regions& regions);

    /// The number of attached vertices.
    std::size_t size() const { return _attached.size(); }

    /// Gives attached vertices the regions of the skin below them, and what else no joint sees of
    /// their shells those of the nearest along the shell.
    void follow(Regions& regions) const;

    /// Gives attached vertices what the skin below them has.
    ///
    /// A cloth over a hollow, as at an armpit, would tear where the skin below changes: it is
    /// smoothed about as widely as it is above the skin.
    ///
    /// \param bend one field for each joint
    /// \param twist likewise
    void follow(JointFields& bend, JointFields& twist) const;

    /// Gives attached vertices what the skin below them is moved by.
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
