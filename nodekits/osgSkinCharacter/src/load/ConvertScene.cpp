// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/ConvertScene.h"

#include "load/BonesFirst.h"
#include "load/SceneMotions.h"
#include "scene/FaceViewer.h"
#include "source/CacheFolder.h"

#include <osgSkin/Error>
#include <osgSkinBind/ConvertRigs>
#include <osgSkinImport/ReadLimits>
#include <osgSkinImport/ReadScene>

#include <osg/MatrixTransform>
#include <osg/StateSet>
#include <osg/Transform>

#include <filesystem>
#include <utility>

namespace osgSkin {
namespace {

ConvertOptions convertOptionsOf(const LoadOptions& options) {
    using Method = LoadOptions::Method;
    ConvertOptions convert;
    convert.ratios = options.method == Method::Default   ? ConvertOptions::Ratios::Best
                     : options.method == Method::Weights ? ConvertOptions::Ratios::Painted
                                                         : ConvertOptions::Ratios::Own;
    if (options.method == Method::Paper) convert.bind.method = BindOptions::Method::Paper;
    convert.bind.rigid = options.rigid;
    convert.bind.shapes = options.shapes;
    convert.bind.cacheFolder = cacheFolder();
    convert.bind.muscles = options.muscles.value_or(false);
    convert.bind.surfaceNormals = options.surfaceNormals;
    convert.showRegions = options.showRegions;
    return convert;
}

osg::ref_ptr<osg::Group> asGroup(osg::Node* node) {
    osg::ref_ptr<osg::Group> group = node->asGroup();
    if (group) return group;
    group = new osg::Group;
    group->addChild(node);
    return group;
}

/// The state that all nodes down to a skin set together.
osg::ref_ptr<osg::StateSet> stateOf(const osg::Node& skin) {
    osg::ref_ptr<osg::StateSet> merged = new osg::StateSet;
    const osg::NodePathList paths = skin.getParentalNodePaths();
    if (paths.empty()) return merged;
    for (const osg::Node* node : paths.front())
        if (node->getStateSet() != nullptr) merged->merge(*node->getStateSet());
    return merged;
}

/// The one body of a scene is the character's.
void takeBody(ConvertedBody& body, const BindOptions& options, Character& character) {
    character.body.mesh = std::move(body.mesh);
    character.body.parts = std::move(body.parts);
    character.rest = std::move(body.rest);
    character.binding = std::move(body.binding);
    character.bindReport = std::move(body.report);
    character.bindOptions = options;
    character.bindOptions.progress = {};
    character.skeleton = body.skeleton;
    character.skin.skins = std::move(body.skins);
    for (std::size_t i = 0; i < character.skin.skins.size(); ++i)
        character.body.parts[i].geometry->setStateSet(stateOf(*character.skin.skins[i].drawable));
    const osg::NodePathList paths = body.skeleton->getParentalNodePaths(character.root);
    if (!paths.empty()) character.toWorld = osg::computeLocalToWorld(paths.front());
}

/// Turns the whole scene; the author's own nodes stay as they are.
void faceViewer(Character& character) {
    const osg::Matrixd turn =
        turnToViewer(recogniseJoints(character.rest), boneCentres(character.rest, *character.root));
    if (turn.isIdentity()) return;
    const osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(turn);
    placed->setName(character.root->getName());
    placed->setDataVariance(osg::Object::DYNAMIC);
    placed->addChild(character.root);
    character.root = placed;
    character.toWorld = character.toWorld * turn;
}

} // namespace

Character convertScene(const std::string& file, const LoadOptions& options, LoadStages& stages) {
    const double binding = LoadStages::kBinding + LoadStages::shapesSize(options.shapes);
    stages.plan(LoadStages::kModel + binding);
    stages.begin("model", LoadStages::kModel);
    const ReadLimits limits = ReadLimits::of(options.readOptions.get());
    limits.checkFormat(file);
    if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file))
        throw Error(file + ": no regular file, expected neither pipe nor device");
    const osg::ref_ptr<osg::Node> scene = readScene(file, options.readOptions.get());
    putBonesFirst(*scene);
    ConvertOptions convert = convertOptionsOf(options);
    convert.bind.progress = stages.begin("binding", binding);
    ConvertReport report = convertRigs(*scene, convert);
    if (report.skins.empty())
        throw Error(file + ": " +
                    (report.notes.empty() ? "no osgAnimation::RigGeometry, expected a rigged model"
                                          : report.notes.front()));
    Character character;
    character.file = character.meshFile = file;
    character.files = {file};
    character.notes = report.notes;
    for (const auto& skin : report.skins) character.skin.skins.push_back({skin, {}});
    character.root = asGroup(scene);
    if (report.bodies.size() == 1) {
        takeBody(report.bodies.front(), convert.bind, character);
        faceViewer(character);
    }
    takeSceneMotions(options, character);
    stages.finish();
    return character;
}

} // namespace osgSkin
