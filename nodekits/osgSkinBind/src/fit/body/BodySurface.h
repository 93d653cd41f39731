// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_BODYSURFACE_H
#define OSGSKINBIND_FIT_BODYSURFACE_H

#include "fit/surface/CurveSkeleton.h"
#include "fit/surface/Section.h"
#include "mesh/WeldedMesh.h"

#include <glm/mat3x3.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin::fit {
class SolidGrid;
}

namespace osgSkin {

/// One closed, oriented surface of the body: what skeleton fitting measures.
///
/// Of the largest shell, without eyes, teeth and clothes, its holes (a mouth, a cut neck) closed;
/// or around all shells together.
class BodySurface {
public:
    /// \param mesh the body, rest space
    /// \param filled what all its shells fill; null for the largest shell's surface
    /// \param notes gets one line for each thing that was left out or closed
    /// \throw Error where no closed surface can be made
    BodySurface(const WeldedMesh& mesh, const fit::SolidGrid* filled,
                std::vector<std::string>& notes);
    ~BodySurface();

    /// Moves all points: p becomes scale * rotation * (p - origin).
    void transform(const glm::dmat3& rotation, const glm::dvec3& origin, double scale);

    const std::vector<glm::dvec3>& points() const;

    /// The closed curves in which the plane through `point` cuts the skin.
    std::vector<Section> slice(const glm::dvec3& point, const glm::dvec3& normal) const;

    /// The section around `point`, or the nearest one within `reach`.
    std::optional<Section> sectionAt(const glm::dvec3& point, const glm::dvec3& normal,
                                     double reach) const;

    bool isInside(const glm::dvec3& point) const;
    glm::dvec3 nearest(const glm::dvec3& point) const;

    /// Curve skeleton by mean curvature flow, of a simplified copy where the surface is fine.
    CurveSkeleton curveSkeleton(const std::function<void(double)>& tell) const;

private:
    struct Surface;
    std::unique_ptr<Surface> _surface;
};

} // namespace osgSkin

#endif
