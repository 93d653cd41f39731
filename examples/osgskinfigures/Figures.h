// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

namespace figures {

class Body;

/// The paper's figures, each a picture with its caption in it.
Tile regionFigure(const Body& body); ///< Fig. 1
Tile splitFigure();                  ///< Fig. 2
Tile ratioFigure(const Body& body);  ///< Fig. 3
Tile throwFigure(Body& body);        ///< Fig. 4

struct Comparison {
    const char* name;
    std::vector<Tile> tiles; ///< linear blending, dual quaternions, ours
};
/// Shoulder, elbow, wrist, hip and knee.
std::vector<Comparison> comparisons(const Body& body, bool painted);

} // namespace figures
