// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SKINSMOOTHER_H
#define OSGSKINBIND_SKINSMOOTHER_H

#include "WeldedMesh.h"

#include <vector>

namespace osgSkin {

/// Spreads a field over the skin like heat: implicit Euler steps of (M + tau L) a' = M a with the
/// cotangent Laplacian L and the lumped mass M.
///
/// The width of the spread may change over the skin. Then lengths count in widths: the mass is
/// divided by the width and the edges' weights are multiplied with it, so that an edge between two
/// widths keeps its middle where it was.
///
/// Only the skin near where the field changes is computed: a solver's time grows faster than the
/// number of its vertices.
///
/// Values never leave the range of the input: weights that degenerate or obtuse triangles would
/// make negative or huge are clamped.
class SkinSmoother {
public:
    /// \param mesh must outlive the smoother
    explicit SkinSmoother(const WeldedMesh& mesh);

    /// \param width square root of the heat's total time, above 0; an edge of the field becomes
    /// about
    ///        as wide
    void smooth(std::vector<double>& field, double width) const;
    /// \param widths one for each vertex, above 0
    void smooth(std::vector<double>& field, const std::vector<double>& widths) const;

private:
    const WeldedMesh& _mesh;
    std::vector<double> _mass;
    std::vector<double> _weights; ///< one for each of the mesh's neighbours
};

} // namespace osgSkin

#endif
