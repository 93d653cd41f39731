// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_SKINSMOOTHER_H
#define OSGSKINBINDER_MESH_SKINSMOOTHER_H

#include "mesh/HeatGraph.h"

#include <functional>
#include <memory>
#include <vector>

namespace osgSkin {

class CoarseGraph;

/// Spreads a field over the skin like heat: implicit Euler steps of (M + tau L) a' = M a with the
/// cotangent Laplacian L and the lumped mass M.
///
/// The width of the spread may vary over the skin. Lengths are then measured in widths: the mass is
/// divided by the width and the edges' weights are multiplied by it, so a step of the field keeps
/// its middle in place between two widths.
///
/// Only the skin near changes of the field is computed, since a solver's time grows faster than its
/// number of vertices. Values never leave the range of the input (see edgeWeights()).
class SkinSmoother {
public:
    /// \param mesh is copied as far as needed
    /// \param widest the widest spread to be expected: if the skin's edges are much shorter,
    ///        coarser copies of the skin are prepared. Other widths work, too.
    explicit SkinSmoother(const WeldedMesh& mesh, double widest = 0.0);
    ~SkinSmoother();
    SkinSmoother(const SkinSmoother&) = delete;

    const HeatGraph& skin() const { return _skin; }

    /// Smooths a field by the same width everywhere.
    ///
    /// \param field one value for each vertex
    /// \param width square root of the heat's total time, above 0; about the width that a step of
    ///        the field gets
    void smooth(std::vector<double>& field, double width) const;
    /// Smooths a field by a width for each vertex.
    ///
    /// \param field one value for each vertex
    /// \param widths one for each vertex, above 0
    /// \param isHeld the vertices that keep their values while heat flows from them; may be empty
    void smooth(std::vector<double>& field, const std::vector<double>& widths,
                const std::vector<bool>& isHeld = {}) const;

    /// Changes a field at its free vertices.
    using Change = std::function<void(const HeatGraph& skin, std::vector<double>& field,
                                      const std::vector<bool>& isFree)>;

    /// Changes a field on the coarsest copy of the skin whose edges are still much shorter than
    /// `width`, and adds the difference to the skin's field.
    ///
    /// \param field one value for each vertex, 0 to 1
    /// \param isFree for each vertex, whether it may change
    /// \param width of the details of the field that must survive
    /// \param change is called with the copy and its field
    void change(std::vector<double>& field, const std::vector<bool>& isFree, double width,
                const Change& change) const;

private:
    void change(std::vector<double>& field, const std::vector<bool>& isFree, double width,
                const Change& change, std::size_t level) const;
    void smooth(std::vector<double>& field, const std::vector<double>& widths,
                const std::vector<bool>& isHeld, std::size_t level) const;

    HeatGraph _skin;
    std::vector<std::unique_ptr<CoarseGraph>> _coarser; ///< each a coarser copy of the one before
};

} // namespace osgSkin

#endif
