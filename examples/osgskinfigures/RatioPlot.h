// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Vec4>
#include <osg/ref_ptr>

#include <optional>
#include <string>
#include <vector>

namespace figures {

/// A ratio over the position along a bone, as the lower half of a picture.
struct RatioPlot {
    struct Dots {
        std::string name;
        osg::Vec4 colour;
        std::vector<double> positions; ///< along the bone, in its lengths
        std::vector<double> ratios;    ///< as many
    };
    double low = 0.0, high = 1.0;       ///< of the positions shown
    std::optional<double> upper, lower; ///< boundaries that eq. 5 runs between, if there are any
    std::vector<Dots> dots;             ///< later ones over earlier ones
    std::string axis;                   ///< what position 0 is, and the unit
};

/// \param height of the picture; the plot fills the lower part of it
osg::ref_ptr<osg::Camera> drawPlot(const RatioPlot& plot, int width, int height);

} // namespace figures
