// SPDX-License-Identifier: MIT
#ifndef OSGSKINFIGURES_FIGURES_H
#define OSGSKINFIGURES_FIGURES_H

#include "Snapshots.h"

#include <vector>

namespace figures {

class Body;

/// The paper's Fig. 3 with its caption: ratios along a limb.
Tile ratioFigure(const Body& body);

/// A pose of one joint, deformed by each method.
struct Comparison {
    const char* name;
    /// Linear blending, dual quaternions, the paper's model (if the body has shapes), and osgSkin.
    std::vector<Tile> tiles;
};

/// Compares the methods at shoulder, elbow, wrist, hip and knee.
/// \param body the body
/// \param painted true if the weights for the other methods are painted
std::vector<Comparison> comparisons(const Body& body, bool painted);

/// The paper's Fig. 1 with its caption: the regions of the skin.
Tile regionFigure(const Body& body);

/// The paper's Fig. 2 with its caption: a rotation split into bend and twist.
Tile splitFigure();

/// The paper's Fig. 4 with its caption: the thrower.
Tile throwFigure(Body& body);

} // namespace figures

#endif
