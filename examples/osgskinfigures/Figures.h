// SPDX-License-Identifier: MIT
#ifndef OSGSKINFIGURES_FIGURES_H
#define OSGSKINFIGURES_FIGURES_H

#include "Snapshots.h"

#include <vector>

namespace figures {

class Body;

/// The paper's Fig. 3 with its caption: ratios along a limb.
Tile ratioFigure(const Body& body);

class Body;

/// One pose of a joint by each method.
struct Comparison {
    const char* name;
    /// Linear blending, dual quaternions, the paper's model where the body has shapes, ours, and
    /// the elastic body.
    std::vector<Tile> tiles;
};
/// Shoulder, elbow, wrist, hip and knee.
/// \param painted whether the peers' weights are
/// \param elastic the same body with elastic shapes; may be null
std::vector<Comparison> comparisons(const Body& body, bool painted, const Body* elastic);

class Body;

/// The paper's Fig. 1 with its caption: the regions of the skin.
Tile regionFigure(const Body& body);

/// The paper's Fig. 2 with its caption: a rotation split into bend and twist.
Tile splitFigure();

class Body;

/// The paper's Fig. 4 with its caption: the thrower.
Tile throwFigure(Body& body);

} // namespace figures

#endif
