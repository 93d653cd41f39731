// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/Character.h"

#include "file/WeightsFile.h"
#include "load/ClipBounds.h"
#include "load/LoadSteps.h"
#include "load/MeshWeights.h"
#include "load/Props.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/Error>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinBind/Bind>
#include <osgSkinBind/ShowRegions>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/ApplyFrame>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

#include <algorithm>

namespace osgSkin {
namespace {

/// Bind errors know the mesh's vertices and the skeleton's joints, but not where they came from.
template <typename Step>
auto inFile(const std::string& file, const Step& step) {
    try {
        return step();
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.rfind(file, 0) == 0) throw;
        throw Error(file + ": " + what);
    }
}

Binding bindBody(Character& character, LoadSteps& steps) {
    const SkinFile& file = character.file;
    BindOptions options = file.bind;
    options.progress = [&steps](const std::string& what, double share) {
        steps.within(what, share);
    };
    const SkinMesh& mesh = character.body.mesh;
    if (!file.paintedWeights)
        return inFile(file.file,
                      [&] { return bind(mesh, character.rig, options, &character.report); });
    const VertexWeights weights =
        file.weights.empty() ? meshWeights(file.mesh, character.body, character.rig)
                             : readWeights(file.weights, character.rig, mesh.positions.size());
    return inFile(file.file, [&] {
        return bindWeights(mesh, character.rig, weights, options, &character.report);
    });
}

RestSkeleton findRig(Character& character, LoadSteps& steps) {
    const SkinFile& file = character.file;
    if (!file.fit) return importSkeleton(file.skeleton);
    FitOptions options = *file.fit;
    options.progress = [&steps](const std::string& what, double share) {
        steps.within(what, share);
    };
    RestSkeleton rig = inFile(
        file.mesh, [&] { return fitSkeleton(character.body.mesh, options, &character.fitReport); });
    OSG_INFO << file.file << ":\n" << character.fitReport.text();
    for (const std::string& note : character.fitReport.notes)
        OSG_NOTICE << file.file << ": fitted skeleton: " << note << std::endl;
    return rig;
}

void loadMotions(Character& character, LoadSteps& steps) {
    for (const SkinFile::Motion& entry : character.file.motions) {
        steps.begin("motion " + entry.name);
        osgSkin::Motion motion = importMotion(entry.file, entry.skipFrames);
        motion.name = entry.name;
        RetargetOptions options;
        options.joints = entry.joints;
        options.names = character.file.names;
        character.motions.push_back(inFile(entry.file, [&] {
            Character::Motion loaded;
            loaded.clip = retarget(motion, character.rig, options, &loaded.report);
            OSG_INFO << entry.file << ":\n" << loaded.report.text();
            for (const std::string& note : loaded.report.notes)
                OSG_NOTICE << entry.file << ": " << note << std::endl;
            return loaded;
        }));
    }
}

/// OSG's world has Z up; most characters' files have Y up and face +Z, so they come to face -Y,
/// towards osgviewer's camera.
osg::ref_ptr<osg::MatrixTransform> makeUpright(bool zUp) {
    osg::ref_ptr<osg::MatrixTransform> upright = new osg::MatrixTransform(
        zUp ? osg::Matrix() : osg::Matrix::rotate(osg::PI_2, osg::Vec3(1, 0, 0)));
    upright->setName("upright");
    // Bones below are rewritten every frame: nothing here may be flattened into them.
    upright->setDataVariance(osg::Object::DYNAMIC);
    return upright;
}

void buildScene(Character& character, const osgDB::Options* options) {
    character.skeleton = makeSkeleton(character.rig);
    character.skin = attachSkin(
        *character.skeleton, character.body.mesh, character.body.parts, character.binding,
        splitRigid(character.body.mesh, character.binding,
                   character.file.bind.rigid ? *character.file.bind.rigid
                                             : automaticRigidJoints(character.rig)));
    character.manager = new AutoPlayManager; // one that plays again when saved and read
    const osg::ref_ptr<osg::MatrixTransform> upright = makeUpright(character.file.zUp);
    upright->addChild(character.skeleton);
    for (const Character::Motion& motion : character.motions) {
        const osg::ref_ptr<osgAnimation::Animation> animation =
            makeAnimation(motion.clip, character.rig);
        addProps(character.file, motion, *upright, *animation, options);
        character.manager->registerAnimation(animation);
    }
    character.root = new osg::Group;
    character.root->setName(osgDB::getStrippedName(character.file.file));
    character.root->addChild(upright);
    if (character.motions.empty()) return;
    character.root->setUpdateCallback(character.manager);
    character.manager->playAnimation(character.manager->getAnimationList().front());
    // A viewer places its camera before the first frame: tell it where the figure will get to.
    character.root->setInitialBound(clipBounds(character.motions.front().clip, character.rig,
                                               character.binding, character.body.mesh,
                                               upright->getMatrix()));
}

/// What the caller asks for goes before what the file says.
void change(SkinFile& file, const SkinOptions& wanted, const osgDB::Options* options) {
    if (wanted.bind != SkinOptions::Bind::Default) {
        file.paintedWeights = wanted.bind == SkinOptions::Bind::Weights;
        if (!file.paintedWeights) file.weights.clear();
        file.bind.method = wanted.bind == SkinOptions::Bind::Paper ? BindOptions::Method::Paper
                                                                   : BindOptions::Method::Smooth;
    }
    if (wanted.rigid) file.bind.rigid = wanted.rigid;
    if (wanted.shapes) file.bind.shapes = *wanted.shapes;
    if (!wanted.motion) return;
    if (*wanted.motion == "none") {
        file.motions.clear();
        file.props.clear();
        return;
    }
    const auto named = std::find_if(file.motions.begin(), file.motions.end(),
                                    [&](const auto& m) { return m.name == *wanted.motion; });
    if (named != file.motions.end()) {
        std::rotate(file.motions.begin(), named, named + 1);
        return;
    }
    const std::string found = osgDB::findDataFile(*wanted.motion, options);
    if (found.empty())
        throw Error(file.file + ": motion \"" + *wanted.motion +
                    "\" is neither one of its motions nor a file");
    SkinFile::Motion motion;
    motion.file = found;
    motion.name = found;
    file.motions.insert(file.motions.begin(), motion);
}

} // namespace

Character Character::load(const std::string& file, const osgDB::Options* options,
                          const SkinOptions& wanted) {
    Character character;
    character.file = SkinFile::read(file);
    change(character.file, wanted, options);
    LoadSteps steps(file, 4 + character.file.motions.size(), options);
    steps.begin("mesh");
    character.body = importMesh(character.file.mesh, options);
    steps.begin("skeleton");
    character.rig = findRig(character, steps);
    steps.begin("binding");
    character.binding = bindBody(character, steps);
    OSG_INFO << file << ":\n" << character.report.text();
    loadMotions(character, steps);
    steps.begin("scene");
    inFile(file, [&] {
        if (wanted.showRegions) showRegions(character.body.parts, character.binding);
        buildScene(character, options);
        return 0;
    });
    steps.finish();
    return character;
}

void Character::pose(const Motion& motion, std::size_t frame) {
    applyFrame(motion.clip, rig, frame, *skeleton);
    for (const AttachedSkin::Skin& attached : skin.skins)
        if (auto* update =
                dynamic_cast<UpdateDeformableSkin*>(attached.drawable->getUpdateCallback()))
            update->pose(*attached.drawable, *skeleton);
}

} // namespace osgSkin
