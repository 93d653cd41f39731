// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/RigCharacter.h"

#include "load/LoadSteps.h"
#include "load/MeshWeights.h"
#include "load/PlayedBounds.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/Error>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinBind/ConvertRigs>
#include <osgSkinBind/NonUniformScale>
#include <osgSkinBind/ShowRegions>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinRig/Clip>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Retarget>

#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <algorithm>

namespace osgSkin {
namespace {

using Bind = SkinOptions::Bind;

Binding bindRig(const std::string& file, const ImportedRig& rig, const SkinOptions& wanted,
                BindReport& report, LoadSteps& steps) {
    BindOptions options;
    options.progress = [&steps](const std::string& what, double share) {
        steps.within(what, share);
    };
    options.rigid = wanted.rigid;
    if (wanted.shapes) options.shapes = *wanted.shapes;
    if (wanted.bind == Bind::Paper) options.method = BindOptions::Method::Paper;
    VertexWeights weights;
    bool painted = wanted.bind == Bind::Weights;
    if (painted || wanted.bind == Bind::Default) weights = meshWeights(file, rig.body, rig.rest);
    if (wanted.bind == Bind::Default) painted = isWellPainted(weights);
    Binding binding = painted ? bindWeights(rig.body.mesh, rig.rest, weights, options, &report)
                              : bind(rig.body.mesh, rig.rest, options, &report);
    OSG_INFO << file << ": bound by " << (painted ? "its own weights" : "regions") << "\n"
             << report.text();
    return binding;
}

std::string clipNames(const osgAnimation::AnimationList& clips) {
    std::string names;
    for (const auto& clip : clips)
        names += (names.empty() ? "\"" : ", \"") + clip->getName() + "\"";
    return names.empty() ? "no clip" : "one of " + names;
}

/// A motion of another skeleton, which moves the joints of makeSkeleton().
osg::ref_ptr<osgAnimation::Animation> carriedOver(const std::string& file, const ImportedRig& rig) {
    try {
        RetargetReport report;
        const Clip clip = retarget(importMotion(file), rig.rest, {}, &report);
        OSG_INFO << file << ":\n" << report.text();
        for (const std::string& note : report.notes)
            OSG_NOTICE << file << ": " << note << std::endl;
        return makeAnimation(clip, rig.rest);
    } catch (const Error& error) {
        const std::string what = error.what();
        throw Error(what.rfind(file, 0) == 0 ? what : file + ": " + what);
    }
}

/// Takes what is to be played out of the rig: its clips with the wanted one first, or a motion
/// file, for which the skeleton is built anew.
osgAnimation::AnimationList chooseMotion(const std::string& file, ImportedRig& rig,
                                         const SkinOptions& wanted, const osgDB::Options* options) {
    osgAnimation::AnimationList clips = rig.animations;
    if (!wanted.motion) return clips;
    if (*wanted.motion == "none") return {};
    for (auto clip = clips.begin(); clip != clips.end(); ++clip)
        if ((*clip)->getName() == *wanted.motion) {
            std::rotate(clips.begin(), clip, clip + 1);
            return clips;
        }
    const std::string found = osgDB::findDataFile(*wanted.motion, options);
    if (found.empty())
        throw Error(file + ": motion \"" + *wanted.motion + "\" is neither a clip nor a file, " +
                    "expected " + clipNames(clips));
    rig.skeleton = makeSkeleton(rig.rest);
    return {carriedOver(found, rig)};
}

osg::ref_ptr<osg::Group> loadByOsg(const std::string& file, const osgDB::Options* options,
                                   const SkinOptions& wanted) {
    LoadSteps steps(file, 2, options);
    steps.begin("model");
    osgDB::ReaderWriter::ReadResult read = osgDB::Registry::instance()->readNode(file, options);
    const osg::ref_ptr<osg::Node> node = read.getNode();
    if (!node) {
        const std::string reason = read.message();
        throw Error(file + ": " + (reason.empty() ? "cannot be read" : reason));
    }
    ConvertOptions convert;
    convert.ratios = wanted.bind == Bind::Default   ? ConvertOptions::Ratios::Best
                     : wanted.bind == Bind::Weights ? ConvertOptions::Ratios::Painted
                                                    : ConvertOptions::Ratios::Own;
    if (wanted.bind == Bind::Paper) convert.bind.method = BindOptions::Method::Paper;
    convert.bind.rigid = wanted.rigid;
    if (wanted.shapes) convert.bind.shapes = *wanted.shapes;
    convert.showRegions = wanted.showRegions;
    steps.begin("binding");
    convert.bind.progress = [&steps](const std::string& what, double share) {
        steps.within(what, share);
    };
    const ConvertReport report = convertRigs(*node, convert);
    if (report.skins.empty())
        throw Error(file + ": " +
                    (report.notes.empty() ? "no osgAnimation::RigGeometry, expected a rigged model"
                                          : report.notes.front()));
    steps.finish();
    osg::ref_ptr<osg::Group> root = node->asGroup();
    if (root) return root;
    root = new osg::Group;
    root->addChild(node);
    return root;
}

} // namespace

Character loadRig(const std::string& file, const osgDB::Options* options,
                  const SkinOptions& wanted) {
    LoadSteps steps(file, 3, options);
    steps.begin("model");
    ImportedRig rig = importRig(file, options);
    steps.begin("binding");
    Character result;
    result.binding = bindRig(file, rig, wanted, result.report, steps);
    steps.begin("scene");
    result.clips = chooseMotion(file, rig, wanted, options);
    for (const std::string& bone : findNonUniformScale(*rig.skeleton, result.clips))
        OSG_NOTICE << file << ": " << bone
                   << " scaled unevenly or mirrored, which the skin does not follow" << std::endl;
    if (wanted.showRegions) showRegions(rig.body.parts, result.binding);
    const std::vector<std::string> rigid =
        wanted.rigid ? *wanted.rigid : automaticRigidJoints(rig.rest);
    result.skin = attachSkin(*rig.skeleton, rig.body.mesh, rig.body.parts, result.binding,
                             splitRigid(rig.body.mesh, result.binding, rigid));
    result.file.file = result.file.mesh = result.file.skeleton = file;
    result.file.zUp = rig.toWorld.isIdentity();
    result.body = std::move(rig.body);
    result.rig = std::move(rig.rest);
    result.skeleton = rig.skeleton;

    const osg::ref_ptr<osg::MatrixTransform> upright = new osg::MatrixTransform(rig.toWorld);
    upright->setName("upright");
    upright->setDataVariance(osg::Object::DYNAMIC); // the bones below are rewritten every frame
    upright->addChild(result.skeleton);
    result.root = new osg::Group;
    result.root->setName(osgDB::getStrippedName(file));
    result.root->addChild(upright);
    result.root->setInitialBound(playedBounds(*result.root, result.clips));
    steps.finish();
    if (result.clips.empty()) return result;
    result.manager = new AutoPlayManager;
    for (const auto& clip : result.clips) result.manager->registerAnimation(clip);
    result.root->setUpdateCallback(result.manager);
    result.manager->playAnimation(result.clips.front());
    return result;
}

osg::ref_ptr<osg::Group> loadRigCharacter(const std::string& file, const osgDB::Options* options,
                                          const SkinOptions& wanted) {
    const std::string found = osgDB::findDataFile(file, options);
    if (!found.empty() && isReadByAssimp(found)) return loadRig(found, options, wanted).root;
    return loadByOsg(file, options, wanted); // which may be a pseudo-loader's name and no file
}

} // namespace osgSkin
