// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MUSCLE_H
#define OSGSKINBIND_MUSCLE_H

#include <osgSkin/Correctives>

#include <glm/vec3.hpp>

#include <string>

namespace osgSkin {

/// A muscle that lies along the bone above a hinge and is shortened by the hinge's bend. Rest
/// space.
struct Muscle {
    std::string name;
    CorrectiveJoint functions; ///< of the hinge; not yet modes and coefficients
    std::uint32_t above = 0;   ///< the joint whose bone carries it
    glm::dvec3 begin{0.0};     ///< that bone: from the joint above ...
    glm::dvec3 end{0.0};       ///< ... to the hinge
    glm::dvec3 side{0.0};      ///< unit, across the bone, towards the belly
    double from = 0.0;         ///< where it begins and ends, in fractions of the bone
    double to = 1.0;
    double shortens = 1.0; ///< 1: when the hinge flexes; -1: when it stretches
    double flexed = 0.0;   ///< by how much the hinge is at rest, radians; 0 is straight
    double growth = 0.0;   ///< of the limb's girth, see BindOptions::Muscle
    double tension = 0.0;  ///< likewise
    double radius = 0.0;   ///< of the limb around its belly
    bool isFlexor() const { return shortens > 0.0; }
};

} // namespace osgSkin

#endif
