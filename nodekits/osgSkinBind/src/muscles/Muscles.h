// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MUSCLES_MUSCLES_H
#define OSGSKINBIND_MUSCLES_MUSCLES_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "ratios/JointRatios.h"

#include <osgSkin/Binding>

#include <array>
#include <string>
#include <vector>

namespace osgSkin {

/// A muscle along the bone above a hinge, which the hinge's bend shortens. Rest space.
struct Muscle {
    std::string name;
    CorrectiveJoint functions; ///< of the hinge; without modes and coefficients
    std::uint32_t above = 0;   ///< the joint whose bone carries it
    glm::dvec3 begin{0.0};     ///< that bone: from the joint above ...
    glm::dvec3 end{0.0};       ///< ... to the hinge
    glm::dvec3 side{0.0};      ///< unit, perpendicular to the bone, towards the belly
    double from = 0.0;         ///< the muscle's ends, in fractions of the bone
    double to = 1.0;
    double shortens = 1.0; ///< 1: when the hinge flexes; -1: when it extends
    double flexed = 0.0;   ///< the hinge's bend at rest, radians; 0 is straight
    double growth = 0.0;   ///< of the limb's girth, see BindOptions::Muscle
    double tension = 0.0;  ///< of the limb's girth, see BindOptions::Muscle
    double radius = 0.0;   ///< of the limb around the muscle's belly
    bool isFlexor() const { return shortens > 0.0; }
};

/// The muscles that the options request: biceps and triceps, quadriceps and hamstrings, and calves,
/// if arms and legs are known by their joints' names, and the author's own.
/// \param bound the binding's joints
/// \param notes gets a line for each that cannot be made
/// \throw osgSkin::Error if an own muscle names an unknown joint, or one that has no bone above it
///        or no known direction of its bend
std::vector<Muscle> findMuscles(const RestSkeleton& skeleton,
                                const std::vector<PlannedJoint>& joints,
                                const std::vector<BoundJoint>& bound, const BindOptions& options,
                                std::vector<std::string>& notes);

/// The skin of the limb around a muscle, with the measures of its shape: girth around the belly,
/// and volume. Rest space.
class MuscleSkin {
public:
    using Heights = std::vector<double>; ///< of each vertex, along its normal

    /// Finds the limb's skin, and sets the muscle's radius.
    /// \param ratios of the binding
    MuscleSkin(const WeldedMesh& mesh, const JointRatios& ratios, Muscle& muscle);

    /// The limb's welded vertices; empty if it has no skin.
    const std::vector<std::uint32_t>& vertices() const { return _vertices; }
    const glm::dvec3& normal(std::size_t i) const { return _normals[i]; }

    /// The displacement of the skin, in rest units, when the muscle is shortened: a spindle that is
    /// shorter, and thicker by the same factor, minus the spindle at rest. On a cylindrical limb
    /// this keeps the volume.
    /// \param length over that at rest
    Heights spindle(double length) const;

    /// The limb's girth around the belly with displaced skin.
    double girth(const Heights& lifted) const;

    /// The volume below the skin that can be displaced, up to a constant.
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

/// The correctives of the muscles that the options request: for each muscle one mode that follows
/// its hinge's bend and one that follows an input of its name. Empty if there are no muscles.
/// \param binding of the mesh as given; its correctives are ignored
/// \param notes gets a line for each muscle that cannot be made
/// \throw osgSkin::Error as findMuscles() does
Correctives makeMuscles(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                        const WeldedMesh& mesh, const Binding& binding, const BindOptions& options,
                        std::vector<std::string>& notes);

} // namespace osgSkin

#endif
