// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/BuildScene.h"

#include "options/LoadReport.h"
#include "scene/ClipBounds.h"
#include "scene/FaceViewer.h"
#include "scene/PlayedBounds.h"
#include "scene/Props.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkinBind/Bind>
#include <osgSkinBind/NonUniformScale>
#include <osgSkinBind/ShowRegions>
#include <osgSkinRig/MakeSkeleton>

#include <osg/MatrixTransform>
#include <osgDB/FileNameUtils>

namespace osgSkin {
namespace {

void attach(const CharacterSource& source, Character& character) {
    const SkinMesh& mesh = character.body.mesh;
    const std::vector<std::string> rigid =
        source.bind.rigid ? *source.bind.rigid
                          : automaticRigidJoints(character.rest, source.bind.names);
    character.skeleton = source.skeleton ? source.skeleton : makeSkeleton(character.rest);
    character.skin = attachSkin(*character.skeleton, mesh, character.body.parts, character.binding,
                                splitRigid(mesh, character.binding, rigid));
}

osg::ref_ptr<osg::MatrixTransform> makeUpright(const osg::Matrixd& toWorld) {
    osg::ref_ptr<osg::MatrixTransform> upright = new osg::MatrixTransform(toWorld);
    upright->setName("upright");
    // Bones below are rewritten every frame: nothing here may be flattened into them.
    upright->setDataVariance(osg::Object::DYNAMIC);
    return upright;
}

/// A rigged model's own animations, as the character's motions.
void takeAnimations(const CharacterSource& source, Character& character) {
    const std::vector<std::string> bones =
        findNonUniformScale(*character.skeleton, source.animations);
    if (!bones.empty())
        takeNote(
            character.notes,
            character.file + ": " + bones.front() +
                (bones.size() > 1 ? " and " + std::to_string(bones.size() - 1) + " more" : "") +
                " scaled non-uniformly, mirrored or to nothing, which the skin does not follow");
    for (const auto& animation : source.animations)
        character.motions.emplace_back().animation = animation;
}

void play(Character& character) {
    if (character.motions.empty()) return;
    osgAnimation::AnimationList clips;
    for (const CharacterMotion& motion : character.motions) clips.push_back(motion.animation);
    const osg::ref_ptr<AutoPlayManager> manager =
        new AutoPlayManager; // plays again when saved and read
    manager->registerAnimations(clips);
    character.manager = manager;
    character.root->setUpdateCallback(character.manager);
    character.manager->playAnimation(character.motions.front().animation);
}

/// A rig that is not straight at rest, sitting or curled up, may tell by its motion.
osg::Matrixd turnOfRig(const Character& character, const JointRoles& roles) {
    const JointCentres atRest = restCentres(character.rest, character.toWorld);
    if (character.motions.empty() || isStraight(roles, atRest)) return turnToViewer(roles, atRest);
    return turnToViewer(
        roles, atRest,
        clipCentres(character.rest, character.motions.front().clip, character.toWorld));
}

} // namespace

void buildScene(CharacterSource& source, const LoadOptions& options, Character& character) {
    if (options.showRegions) showRegions(character.body.parts, character.binding);
    attach(source, character);
    const JointRoles roles = recogniseJoints(character.rest, source.bind.names);
    if (!source.skeleton) character.toWorld = character.toWorld * turnOfRig(character, roles);
    const osg::ref_ptr<osg::MatrixTransform> upright = makeUpright(character.toWorld);
    upright->addChild(character.skeleton);
    PropMeshes propMeshes(source.meshOptions.get());
    for (const CharacterMotion& motion : character.motions)
        addProps(source, motion, *upright, propMeshes, options.readOptions.get());
    character.root = new osg::Group;
    character.root->setName(osgDB::getStrippedName(character.file));
    character.root->addChild(upright);
    if (source.skeleton) {
        takeAnimations(source, character);
        const JointCentres atRest = boneCentres(character.rest, *character.root);
        osg::BoundingSphere bound = playedBounds(*character.root, source.animations);
        const JointCentres played = boneCentres(character.rest, *character.root);
        const osg::Matrixd turn = turnToViewer(roles, atRest, played);
        character.toWorld = character.toWorld * turn;
        upright->setMatrix(character.toWorld);
        bound.center() = bound.center() * turn;
        character.root->setInitialBound(bound);
    } else if (!character.motions.empty()) {
        // A viewer places its camera before the first frame: tell it where the figure will get to.
        character.root->setInitialBound(clipBounds(character.motions.front().clip, character.rest,
                                                   character.binding, character.body.mesh,
                                                   character.toWorld));
        character.pose(character.motions.front(), 0);
    }
    play(character);
}

} // namespace osgSkin
