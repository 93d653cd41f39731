// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SURFACE_CONTRACT_H
#define OSGSKINBIND_FIT_SURFACE_CONTRACT_H

#include "fit/surface/CurveSkeleton.h"
#include "fit/surface/SurfaceMesh.h"

#include <functional>

namespace osgSkin::fit {

/// Mean curvature flow skeleton (Tagliasacchi, Alhashim, Olson & Zhang 2012) of a closed surface.
///
/// \param mesh closed
/// \param tell as with simplified(), which comes first
CurveSkeleton contract(const Mesh& mesh, const std::function<void(double)>& tell);

} // namespace osgSkin::fit

#endif
