// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SKINSMOOTHER_H
#define OSGSKINBIND_SKINSMOOTHER_H

#include "mesh/CoarseGraph.h"

#include <functional>
#include <memory>
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
    /// \param mesh is copied as far as it is needed
    /// \param widest the widest spread that will be asked for; where the skin's edges are much
    ///        shorter, coarser copies of it are prepared. Any other width works too.
    explicit SkinSmoother(const WeldedMesh& mesh, double widest = 0.0);
    SkinSmoother(const SkinSmoother&) = delete;

    const HeatGraph& skin() const { return _skin; }

    /// Smooths a field alike everywhere.
    ///
    /// \param field one value for each vertex
    /// \param width square root of the heat's total time, above 0; an edge of the field becomes
    ///        about as wide
    void smooth(std::vector<double>& field, double width) const;
    /// Smooths a field more here and less there.
    ///
    /// \param field one value for each vertex
    /// \param widths one for each vertex, above 0
    /// \param isHeld the vertices that keep their values while heat flows from them; empty: none
    void smooth(std::vector<double>& field, const std::vector<double>& widths,
                const std::vector<bool>& isHeld = {}) const;

    /// What changes a field where it may.
    using Change = std::function<void(const HeatGraph& skin, std::vector<double>& field,
                                      const std::vector<bool>& isFree)>;

    /// Changes a field on the coarsest copy of the skin whose edges are still much shorter than
    /// `width`; what the copy's field gained is added to the skin's.
    ///
    /// \param field one value for each vertex, 0 to 1
    /// \param isFree which vertices may change, one for each
    /// \param width of what is to be kept of the field
    /// \param change of the copy's field; gets the copy
    void change(std::vector<double>& field, const std::vector<bool>& isFree, double width,
                const Change& change) const;

private:
    void change(std::vector<double>& field, const std::vector<bool>& isFree, double width,
                const Change& change, std::size_t level) const;
    void smooth(std::vector<double>& field, const std::vector<double>& widths,
                const std::vector<bool>& isHeld, std::size_t level) const;

    HeatGraph _skin;
    std::vector<std::unique_ptr<CoarseGraph>> _coarser; ///< each of the one before
};

} // namespace osgSkin

#endif
