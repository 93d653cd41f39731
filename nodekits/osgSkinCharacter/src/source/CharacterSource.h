// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options/LoadReport.h"
#include "options/MotionSamples.h"
#include "options/SkinFile.h"

#include <osgSkinBind/BindOptions>
#include <osgSkinBind/FitReport>
#include <osgSkinCharacter/LoadOptions>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadLimits>
#include <osgSkinRig/RestSkeleton>

#include <osg/Matrixd>
#include <osg/ref_ptr>
#include <osgAnimation/Animation>
#include <osgAnimation/Skeleton>
#include <osgDB/Options>

#include <string>
#include <vector>

namespace osgSkin {

/// What a file gives to make a character of, before anything is bound. A `.skin` file and a rigged
/// model fill it in, each in its own way; all that follows is the same.
struct CharacterSource {
    enum class Painted {
        No,       ///< bind by regions
        Yes,      ///< by painted weights; an error where there are none
        WhereGood ///< by painted weights where isWellPainted(), else by regions
    };

    std::string file;     ///< that was asked for; named in messages
    std::string meshFile; ///< that the body comes from

    std::vector<std::string> files; ///< that are read

    ImportedMesh body;
    RestSkeleton rest;
    FitReport fitReport;
    osg::Matrixd toWorld; ///< from rest space to a scene with Z up

    BindOptions bind;
    Painted painted = Painted::No;
    std::string weightsFile; ///< painted weights; empty: the mesh's own

    /// A rigged model's own skeleton, in the pose of its nodes, and its animations, which move
    /// nothing else. Without: the skeleton is made of `rest`.
    osg::ref_ptr<osgAnimation::Skeleton> skeleton;
    osgAnimation::AnimationList animations;

    std::vector<SkinFile::MotionEntry> motions; ///< files to retarget
    /// What the file says, and after applyOptions() what the caller and the file say.
    LoadOptions options;
    std::vector<SkinFile::Prop> props;
    /// For the body and the props, whose pictures count together; may be null.
    osg::ref_ptr<const osgDB::Options> meshOptions;

    ReadLimits limits;     ///< for all files
    MotionSamples samples; ///< of the motions read so far

    std::vector<std::string> notes; ///< what was unusual so far
    std::string rigidNote;          ///< for the report of binding; may be empty

    /// Sizes of the stages that follow the reading, see LoadStages.
    double bindingSize() const {
        return (painted == Painted::No ? LoadStages::kBinding : LoadStages::kPaintedBinding) +
               LoadStages::shapesSize(bind.shapes);
    }
    double sceneSize() const { return skeleton ? LoadStages::kPlayedScene : LoadStages::kScene; }
    double laterSize() const {
        return bindingSize() + LoadStages::kMotion * double(motions.size()) + sceneSize();
    }
};

} // namespace osgSkin
