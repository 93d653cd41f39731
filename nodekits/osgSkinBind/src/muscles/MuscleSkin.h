// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MUSCLESKIN_H
#define OSGSKINBIND_MUSCLESKIN_H

#include "mesh/WeldedMesh.h"
#include "muscles/Muscle.h"
#include "ratios/JointRatios.h"

#include <array>
#include <vector>

namespace osgSkin {

/// The skin of the limb that a muscle lies in, with what tells how its shape changes: girth around
/// the belly and volume. Rest space.
class MuscleSkin {
public:
    using Heights = std::vector<double>; ///< along its normal, of each vertex

    /// Takes the limb's skin, and sets the muscle's radius.
    /// \param ratios of the binding
    MuscleSkin(const WeldedMesh& mesh, const JointRatios& ratios, Muscle& muscle);

    /// The limb's vertices, welded ones; none where it has no skin.
    const std::vector<std::uint32_t>& vertices() const { return _vertices; }
    const glm::dvec3& normal(std::size_t i) const { return _normals[i]; }

    /// What the skin is lifted by, in rest units, where the muscle is shortened: a spindle that is
    /// shorter and thicker by as much, less the one at rest. It gives and takes the same volume as
    /// far as the limb is a cylinder.
    /// \param length over that at rest
    Heights spindle(double length) const;

    /// The limb's girth around the belly, with its skin lifted.
    double girth(const Heights& lifted) const;

    /// Of what lies below the skin that can be lifted, up to a constant.
    double volume(const Heights& lifted) const;

private:
    glm::dvec3 at(std::size_t i, const Heights& lifted) const {
        return _positions[i] + lifted[i] * _normals[i];
    }

    glm::dvec3 _belly{0.0}, _along{0.0};
    std::vector<std::uint32_t> _vertices;
    std::vector<glm::dvec3> _positions, _normals;
    std::vector<double> _place;  ///< along the muscle, 0..1 within it
    std::vector<double> _weight; ///< how far the vertex lies over the muscle, 0..1
    std::vector<std::array<std::uint32_t, 3>> _triangles;
};

} // namespace osgSkin

#endif
