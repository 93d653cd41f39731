// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_MUSCLES_H
#define OSGSKINBINDER_CORRECTIVES_MUSCLES_H

#include "joints/JointRegions.h"
#include "mesh/WeldedMesh.h"
#include "ratios/JointRatios.h"

#include <osgSkin/Binding>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace osgSkin {

/// A muscle below the skin, along a line from its origin to its insertion. Rest space.
struct Muscle {
    std::string name;
    CorrectiveJoint functions; ///< of the joint that moves it; without modes and coefficients
    /// How far a bend at coordinates (x, y) of `functions` contracts it: 0 at rest, 1 where its
    /// growth is given; never below 0, as a stretched muscle leaves the skin as it is.
    std::function<double(const glm::dvec2& xy)> contraction;
    glm::dvec3 origin{0.0};
    glm::dvec3 insertion{0.0};
    double peak = 0.5;    ///< where the belly is thickest, 0..1 along the line
    glm::dvec3 side{0.0}; ///< unit, perpendicular to the line, from it towards the belly
    /// A limb's muscle lies along the bone of the joint `above`, down to the joint `hinge`. Others
    /// have `above` 0.
    std::uint32_t above = 0, hinge = 0;
    /// The half widths of a flat muscle, at both ends. A muscle that wraps around its line has 0.
    double widthAtOrigin = 0.0, widthAtInsertion = 0.0;
    double reach = 0.0; ///< skin farther from the line is not over it; of muscles with `above` 0
    /// Contracted, and tensed by the application. Of a limb's muscle, the relative growth of the
    /// limb's girth around the belly; of others the thickness that the belly gains, rest units.
    double growth = 0.0, tension = 0.0;

    bool isOfLimb() const { return above != 0; }
    bool isFlat() const { return widthAtOrigin > 0.0; }
};

/// The muscles that the options request: the automatic ones, if arms and legs are known by their
/// joints' names, and the author's own.
/// \param bound the binding's joints
/// \param notes gets a line for each that cannot be made
/// \throw osgSkin::Error if an own muscle names an unknown joint, or one that has no bone above it
///        or no known direction of its bend
std::vector<Muscle> findMuscles(const RestSkeleton& skeleton,
                                const std::vector<PlannedJoint>& joints,
                                const std::vector<BoundJoint>& bound, const BindOptions& options,
                                std::vector<std::string>& notes);

/// The skin over a muscle, and how it swells.
class MuscleSkin {
public:
    /// \param ratios of the binding
    MuscleSkin(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
               const JointRatios& ratios, const Muscle& muscle);

    /// Welded vertices: of a limb's muscle the limb's, of others those over the muscle. Empty if
    /// there are none.
    const std::vector<std::uint32_t>& vertices() const { return _vertices; }

    /// The displacement of a vertex when the belly gains a thickness of 1, rest space.
    const glm::dvec3& swelling(std::size_t i) const { return _swelling[i]; }

    /// The thickness that the belly must gain so that the limb's girth around it grows by a factor
    /// of 1 + `growth`; 0 if the limb has no skin there that could swell.
    double thicknessFor(double growth) const;

private:
    double girth(double thickness) const;

    glm::dvec3 _belly{0.0}, _along{0.0};
    std::vector<std::uint32_t> _vertices;
    std::vector<glm::dvec3> _positions, _swelling;
    std::vector<std::array<std::uint32_t, 3>> _triangles;
};

/// The correctives of the muscles that the options request: for each muscle one mode that follows
/// the bend of the joint that moves it, and one that follows an input of its name. Empty if there
/// are no muscles.
/// \param binding of the mesh as given, with the other correctives
/// \param notes gets a line for each muscle that cannot be made
/// \throw osgSkin::Error as findMuscles() does
Correctives makeMuscles(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                        const WeldedMesh& mesh, const Binding& binding, const BindOptions& options,
                        std::vector<std::string>& notes);

} // namespace osgSkin

#endif
