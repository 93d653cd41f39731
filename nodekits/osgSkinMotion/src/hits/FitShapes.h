// SPDX-License-Identifier: MIT
#ifndef OSGSKINMOTION_HITS_FITSHAPES_H
#define OSGSKINMOTION_HITS_FITSHAPES_H

#include <osgSkinMotion/HitBoxes>
#include <osgSkinRig/RestSkeleton>

#include <glm/vec3.hpp>
#include <osg/Matrixd>

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// The surface of a limb or of a part of it.
struct LimbSurface {
    std::vector<glm::dvec3> points;
    std::vector<std::array<std::uint32_t, 2>> edges;
};

/// Fits one shape to a surface.
/// \param surface at least one point
/// \param inside part of the points that it contains
HitBoxes::Shape fitShape(const LimbSurface& surface, double inside);

/// Fits shapes to limbs. The shape whose division saves the most volume is divided, until their sum
/// is small enough.
///
/// \param limbs each with at least one point
/// \param bodyVolume in the same unit
/// \param options inside, volume and maxShapes
/// \return [limb]
std::vector<std::vector<HitBoxes::Shape>> fitShapes(const std::vector<LimbSurface>& limbs,
                                                    double bodyVolume,
                                                    const HitBoxes::Options& options);

/// Finds how elbows and knees bend, by the joints' roles.
///
/// \param rest the figure's skeleton
/// \param toFigure from rest space
/// \param limbs get their hinges
void findHinges(const RestSkeleton& rest, const osg::Matrixd& toFigure,
                std::vector<HitBoxes::Limb>& limbs);

} // namespace osgSkin

#endif
