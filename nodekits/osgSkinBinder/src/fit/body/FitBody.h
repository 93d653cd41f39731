// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_BODY_FITBODY_H
#define OSGSKINBINDER_FIT_BODY_FITBODY_H

#include "fit/body/BodyBranches.h"
#include "fit/body/FitSurface.h"

#include <osgSkinBind/FitOptions>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// A body in the frame in which it is measured: y up, +z forward, +x to its left, the floor at y =
/// 0, the top of the head at 1, x = 0 between left and right. A figure with a larger head than a
/// person's has its neck where a person has it, and the top of the head above 1.
struct FitBody {
    FitSurface surface;
    BodyBranches branches;
    double symmetryError = 0.0; ///< RMS distance between the skin and its mirror image

    /// Stands the body up along the options' axis and finds its branches. Its facing is not known
    /// yet.
    ///
    /// \param mesh the body, rest space
    /// \param filled the volume inside all shells; null: the largest shell is measured
    /// \param options the up axis and progress are used
    /// \param legsGiven landmarks replace legs that are not found
    /// \param armsGiven landmarks replace arms that are not found
    /// \param notes gets lines about unusual findings
    /// \throw Error if the surface is not that of a standing body
    FitBody(const WeldedMesh& mesh, const fit::SolidGrid* filled, const FitOptions& options,
            bool legsGiven, bool armsGiven, std::vector<std::string>& notes);

    /// Rotates the body about its up axis until it faces +z.
    ///
    /// \param facing its forward direction, rest space
    /// \param left from its right to its left, rest space, of any length. If both are unset, feet, head
    ///        and elbows decide
    /// \return how the facing was found
    std::string face(const std::optional<glm::dvec3>& facing,
                     const std::optional<glm::dvec3>& left);

    glm::dvec3 toBody(const glm::dvec3& rest) const {
        return _scale * (_rotation * (rest - _origin));
    }
    glm::dvec3 toRest(const glm::dvec3& body) const {
        return _origin + glm::transpose(_rotation) * (body / _scale);
    }
    bool isSymmetric() const { return symmetryError < 0.01; }
    double top() const { return _top; }             ///< of the head
    double height() const { return _top / _scale; } ///< in the mesh's unit

private:
    void move(const glm::dmat3& rotation, const glm::dvec3& origin);
    glm::dvec3 lateral(const std::optional<glm::dvec3>& left) const;
    void faceBackwards();
    void shrinkHead(std::vector<std::string>& notes);
    void refineSymmetry();
    double mirrorError(double angle, double x) const;

    glm::dmat3 _rotation{1.0};
    glm::dvec3 _origin{0.0};
    double _scale = 1.0;
    double _top = 1.0;
};

} // namespace osgSkin

#endif
