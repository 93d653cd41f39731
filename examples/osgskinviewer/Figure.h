// SPDX-License-Identifier: MIT
#ifndef OSGSKINVIEWER_FIGURE_H
#define OSGSKINVIEWER_FIGURE_H 1

#include "Body.h"

#include <osg/Group>
#include <osg/ref_ptr>
#include <osgAnimation/BasicAnimationManager>
#include <osgSkin/DeformableSkin>

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

} // namespace viewer

#endif
