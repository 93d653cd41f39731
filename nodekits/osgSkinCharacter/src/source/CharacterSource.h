// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_SOURCE_CHARACTERSOURCE_H
#define OSGSKINCHARACTER_SOURCE_CHARACTERSOURCE_H

#include "options/SkinFile.h"
#include "source/LoadReport.h"

#include <osg/Matrixd>
#include <osg/ref_ptr>
#include <osgAnimation/Animation>
#include <osgAnimation/Skeleton>
#include <osgDB/Options>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/FitReport>
#include <osgSkinCharacter/LoadOptions>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadLimits>
#include <osgSkinMotion/Constraint>
#include <osgSkinMotion/SpringSettings>
#include <osgSkinRig/RestSkeleton>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {

/// Counts the rotations of a character's motions, props included: a short file that is named often
/// takes as much memory as a long one.
class MotionSamples {
public:
    /// Adds a motion.
    ///
    /// \param file its file, whose size counts once, whatever paths lead to it
    /// \param frames of the motion, including skipped ones
    /// \param joints of the motion or of the rig, whichever are more
    /// \param limits of the character
    /// \throw osgSkin::Error where all motions together have more than ReadLimits::samplesOf() of
    ///        their files' sizes
    void add(const std::string& file, std::size_t frames, std::size_t joints,
             const ReadLimits& limits);

private:
    std::set<std::string> _files;
    std::size_t _bytes = 0;   ///< of them
    std::size_t _samples = 0; ///< so far, within the limit
};

/// Everything read from files for a character, before binding. Read from a `.skin` file or a rigged
/// model; all further steps are the same.
struct CharacterSource {
    enum class Painted {
        No,       ///< bind by regions
        Yes,      ///< by painted weights; an error where there are none
        WhereGood ///< by painted weights where isWellPainted(), else by regions
    };

    std::string file;     ///< the loaded file; named in messages
    std::string meshFile; ///< the body's file

    std::vector<std::string> files; ///< all files that are read

    ImportedMesh body;
    RestSkeleton rest;
    std::vector<Constraint> constraints; ///< that the files state
    SpringSettings springs; ///< that the files state; the options may say that none swing
    FitReport fitReport;
    osg::Matrixd toWorld;    ///< rotates rest space to Z up
    double statedUnit = 0.0; ///< metres per unit of rest space, as the files state it; else 0

    BindOptions bind;
    Painted painted = Painted::WhereGood;
    std::string weightsFile; ///< painted weights; empty: the mesh's own

    /// A rigged model's own skeleton, in the pose of its nodes, and its animations, which move
    /// nothing else. Without: the skeleton is made of `rest`.
    osg::ref_ptr<osgAnimation::Skeleton> skeleton;
    osgAnimation::AnimationList animations;

    std::vector<SkinFile::MotionEntry> motions; ///< files to retarget
    bool yIsUp = false; ///< the file says that Y is up; motions are taken to have it, too
    /// The file's options; after applyOptions() the caller's and the file's.
    LoadOptions options;
    std::vector<SkinFile::Prop> props;
    /// For the body and the props, whose images count together; may be null.
    osg::ref_ptr<const osgDB::Options> meshOptions;

    ReadLimits limits;     ///< for all files
    MotionSamples samples; ///< of the motions read so far

    std::vector<std::string> notes; ///< notes so far
    std::string rigidNote;          ///< for the report of binding; may be empty

    /// Sizes of the stages that follow the reading, see LoadStages.
    double bindingSize() const {
        return painted == Painted::No ? LoadStages::kBinding : LoadStages::kPaintedBinding;
    }
    double sceneSize() const { return skeleton ? LoadStages::kPlayedScene : LoadStages::kScene; }
    double laterSize() const {
        return bindingSize() + LoadStages::kMotion * double(motions.size()) + sceneSize();
    }
};

/// The unit of rest space.
///
/// \param stated metres per unit, as the files state it; 0 if they do not
/// \param options the caller's and the file's
/// \param file named in the note
/// \param notes gets one if the option names another unit than the files
/// \return metres per unit
double unitOf(double stated, const LoadOptions& options, const std::string& file,
              std::vector<std::string>& notes);

/// Reads a `.skin` file, the mesh and the skeleton that it names, or fits a skeleton.
///
/// \param file its path
/// \param options are applied, see applyOptions()
/// \param stages planned for the whole load here; the first ones are begun
/// \return the character's source
/// \throw Error with file, JSON path and what was expected
CharacterSource readSkinFile(const std::string& file, const LoadOptions& options,
                             LoadStages& stages);

/// Reads a rigged model (glTF, FBX, ...): body, painted weights, skeleton and animations.
///
/// \param file for which hasImporter() is true
/// \param options are applied, see applyOptions()
/// \param stages planned for the whole load here; the first one is begun
/// \return all that the character is made of
/// \throw Error with the file and the reason
CharacterSource readRig(const std::string& file, const LoadOptions& options, LoadStages& stages);

} // namespace osgSkin

#endif
