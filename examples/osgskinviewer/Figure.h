// SPDX-License-Identifier: MIT
#ifndef OSGSKINVIEWER_FIGURE_H
#define OSGSKINVIEWER_FIGURE_H

#include "Body.h"

#include <osgSkin/DeformableSkin>

#include <osg/BoundingBox>
#include <osg/Group>
#include <osg/ref_ptr>
#include <osgAnimation/BasicAnimationManager>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace viewer {

/// The scene of a file, and its body if known.
struct Figure {
    /// \param file any that osgSkin::loadCharacter() takes
    /// \param weights file of painted weights (JSON); empty for none
    /// \param options of the load
    /// \throw std::exception with the file and the reason
    Figure(const std::string& file, const std::string& weights,
           const osgSkin::LoadOptions& options);

    /// Null for a saved character: its skins are bound, and the mesh is not stored.
    std::unique_ptr<figures::Body> body;
    osg::ref_ptr<osg::Group> root;
    std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skins; ///< below `root`

    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager; ///< null without animations
    osg::ref_ptr<osg::Node> managed;                           ///< node with the callback `manager`

    std::size_t motionCount() const { return manager ? manager->getAnimationList().size() : 0; }
    osgAnimation::Animation& motion(std::size_t index) const {
        return *manager->getAnimationList()[index];
    }
};

/// The extent of a figure while a motion plays, in the space of its root. It includes skins and
/// objects attached to bones, but not props, such as a ball that flies away.
struct PlayedExtent {
    osg::BoundingBoxd box; ///< of the triangles in all samples
    /// z of the floor: the 10th percentile of the lowest points of the samples. A jump does not
    /// raise it, and a foot that briefly dips through the floor does not lower it. Without a
    /// motion, the lowest point.
    double floor;
};

/// Measures the extent of a figure.
/// \param figure is left in an arbitrary pose of the motion
/// \param motion index of the motion; ignored if the figure has none
PlayedExtent playedExtent(const Figure& figure, std::size_t motion);

} // namespace viewer

#endif
