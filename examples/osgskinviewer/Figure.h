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

/// What is shown: the scene of a file, and what is known of the body in it.
struct Figure {
    /// \param file a `.skin` file, a rigged model (with or without `.skin` after its name), or a
    ///        scene with skins in it (`.osgb`)
    /// \param weights painted weights (JSON), empty for none
    /// \param options of the load; a scene's skins are bound already, for it they do not count
    /// \throw std::exception with the file and the reason
    Figure(const std::string& file, const std::string& weights,
           const osgSkin::LoadOptions& options);

    /// Empty where the file is a scene: its skins are bound and its mesh is gone.
    std::unique_ptr<figures::Body> body;
    osg::ref_ptr<osg::Group> root;
    std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skins; ///< below `root`

    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager; ///< null where nothing moves
    osg::ref_ptr<osg::Node> managed;                           ///< whose callback `manager` is

    std::size_t motionCount() const { return manager ? manager->getAnimationList().size() : 0; }
    osgAnimation::Animation& motion(std::size_t index) const {
        return *manager->getAnimationList()[index];
    }
};

/// Where a figure gets to while a motion plays: its skins and what its bones carry. Props have ways
/// of their own, and count for nothing: a ball flies off. In the space of the figure's root.
struct PlayedExtent {
    osg::BoundingBoxd box; ///< around its triangles in all samples
    /// z of its floor: where its feet are when they stand. That is the lowest point in a tenth of
    /// the samples: a jump does not lift the floor, and a foot that dips into it for a moment does
    /// not lower it. At rest, the lowest point.
    double floor;
};

/// \param figure is left in some pose of the motion
/// \param motion index of one of its motions; passed over where it has none
PlayedExtent playedExtent(const Figure& figure, std::size_t motion);

} // namespace viewer

#endif
