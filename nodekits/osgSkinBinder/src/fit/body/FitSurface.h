// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_BODY_FITSURFACE_H
#define OSGSKINBINDER_FIT_BODY_FITSURFACE_H

#include "fit/body/CurveSkeleton.h"
#include "mesh/WeldedMesh.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// One closed curve in which a plane cuts the skin.
struct Section {
    std::vector<glm::dvec3> points; ///< the curve's corners; the first is not repeated
    glm::dvec3 centre{0.0};         ///< centroid of the enclosed area
    double area = 0.0;
    double girth = 0.0; ///< length of the curve

    /// \param curve the corners; the first is not repeated
    /// \param normal of the plane, unit
    Section(std::vector<glm::dvec3> curve, const glm::dvec3& normal);

    /// Least and greatest coordinate of the curve along an axis: 0 x, 1 y, 2 z.
    double low(int axis) const;
    double high(int axis) const;

    /// Distance from a point of the plane to the curve; negative inside.
    double distance(const glm::dvec3& point, const glm::dvec3& normal) const;
};

} // namespace osgSkin

namespace osgSkin::fit {

class SolidGrid;
}

namespace osgSkin {

/// The closed, oriented surface that is measured: the body's largest shell, without eyes, teeth and
/// clothes, with its holes (a mouth, a cut neck) closed; or a surface around all shells together.
class FitSurface {
public:
    /// \param mesh the body, rest space
    /// \param filled the volume inside all shells; null: the largest shell is measured
    /// \param notes gets lines about shells left out and holes closed
    /// \throw Error if no closed surface can be made
    FitSurface(const WeldedMesh& mesh, const fit::SolidGrid* filled,
               std::vector<std::string>& notes);
    ~FitSurface();

    /// Moves all points: p becomes scale * rotation * (p - origin).
    void transform(const glm::dmat3& rotation, const glm::dvec3& origin, double scale);

    const std::vector<glm::dvec3>& points() const;

    /// The closed curves in which a plane cuts the skin.
    std::vector<Section> slice(const glm::dvec3& point, const glm::dvec3& normal) const;

    /// The section around `point`, or the nearest one within `reach`.
    std::optional<Section> sectionAt(const glm::dvec3& point, const glm::dvec3& normal,
                                     double reach) const;

    bool isInside(const glm::dvec3& point) const;
    glm::dvec3 nearest(const glm::dvec3& point) const;

    /// Curve skeleton by mean curvature flow, of a simplified copy if the surface is fine.
    CurveSkeleton curveSkeleton(const std::function<void(double)>& tell) const;

private:
    struct Surface;
    std::unique_ptr<Surface> _surface;
};

} // namespace osgSkin

#endif
