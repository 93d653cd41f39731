// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "file/SkinFile.h"
#include "file/SkinOptions.h"

#include <osgSkin/Binding>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/BindReport>
#include <osgSkinImport/ImportMesh>
#include <osgSkinRig/Clip>
#include <osgSkinRig/Retarget>

#include <osg/Group>
#include <osgAnimation/Animation>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/Options>

#include <string>
#include <vector>

namespace osgSkin {

/// A character read from a `.skin` file or a rigged model: what its files hold and the scene made
/// of them.
struct Character {
    /// A motion carried over to the rig.
    struct Motion {
        Clip clip;
        RetargetReport report;
    };

    SkinFile file;
    ImportedMesh body;
    RestSkeleton rig;
    std::vector<Motion> motions;       ///< of a `.skin` file
    osgAnimation::AnimationList clips; ///< of a rigged model, for its `skeleton`
    Binding binding;
    BindReport report;
    FitReport fitReport; ///< of a skeleton that was fitted

    osg::ref_ptr<osg::Group> root; ///< Z up; its animation manager plays the first motion
    osg::ref_ptr<osgAnimation::Skeleton> skeleton; ///< rest space below it
    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager;
    AttachedSkin skin;

    /// Reads, binds and builds. \throw Error with file, place and what was expected
    static Character load(const std::string& file, const osgDB::Options* options = nullptr,
                          const SkinOptions& wanted = {});

    /// Puts bones and skin into a sample of a motion, exactly, without an update traversal.
    void pose(const Motion& motion, std::size_t frame);
};

} // namespace osgSkin
