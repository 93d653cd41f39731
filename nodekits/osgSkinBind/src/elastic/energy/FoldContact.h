// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_FOLDCONTACT_H
#define OSGSKINBIND_ELASTIC_FOLDCONTACT_H

#include "elastic/energy/FoldSkin.h"
#include "elastic/lattice/DeformedCells.h"

#include <array>
#include <vector>

namespace osgSkin::elastic {

/// Contact between the two sides of a joint's fold, found in material space (McAdams et al. 2011):
/// a probe on one side's skin, or a little ahead of it, that has come to lie in the other side's
/// flesh is looked up at rest, and what is nearest on the skin there is what it has to keep off.
/// Sides are told by how differently they follow the joint, not by the nearest bone: that would put
/// spikes on the limb's flank. What is nearest jumps as flesh slides, and a minimiser that is told
/// anew each time would never come to rest: after a few detections the touches become the mean of
/// all since. One object for each thread.
class FoldContact {
public:
    /// \param skin outlives this
    explicit FoldContact(const FoldSkin& skin) : _skin(skin) {}

    /// Forgets all touches and detections: for another bend.
    void restart();

    /// Finds anew which probes touch.
    void detect(const Points& nodes);

    /// Energy of the touches that detect() has found; its gradient is added.
    double value(const Points& nodes, Points& gradient) const;

    std::size_t touches() const { return _touches.size(); }

private:
    using Probe = FoldSkin::Probe;

    struct Touch {
        std::array<std::uint32_t, 6>
            corners{};                  ///< of the patch: the probe's, then the other side's
        std::array<double, 6> shares{}; ///< whose sum is the way between the two
        Point normal;                   ///< outwards from the other side
        double gap = 0.0;
        double stiffness = 0.0; ///< falls with each detection since
        double weight = 1.0;    ///< as the stiffness
    };

    /// The deformed flesh.
    struct Flesh {
        DeformedCells cells;
        std::vector<FoldSkin::RatioSpan> ratios; ///< of each bin
        Points normals;                          ///< of the patch
    };

    bool look(const Probe& probe, const Point& at, const Flesh& flesh, Touch& result) const;
    bool touch(const Probe& probe, const Point& rest, const Points& normals, Touch& result) const;
    Point on(std::uint32_t triangle, const Point& shares, const Points& vertices) const;

    const FoldSkin& _skin;
    std::vector<Touch> _touches;
    int _detections = 0;
};

} // namespace osgSkin::elastic

#endif
