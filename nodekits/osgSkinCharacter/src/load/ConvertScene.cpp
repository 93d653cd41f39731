// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/ConvertScene.h"

#include "source/CacheFolder.h"

#include <osgSkin/Error>
#include <osgSkinBind/ConvertRigs>

#include <osgDB/Registry>

namespace osgSkin {
namespace {

osg::ref_ptr<osg::Node> readScene(const std::string& file, const osgDB::Options* options) {
    osgDB::ReaderWriter::ReadResult read = osgDB::Registry::instance()->readNode(file, options);
    osg::ref_ptr<osg::Node> node = read.getNode();
    if (node) return node;
    const std::string reason = read.message();
    throw Error(file + ": " + (reason.empty() ? "cannot be read" : reason));
}

ConvertOptions convertOptionsOf(const LoadOptions& options) {
    using Method = LoadOptions::Method;
    ConvertOptions convert;
    convert.ratios = options.method == Method::Default   ? ConvertOptions::Ratios::Best
                     : options.method == Method::Weights ? ConvertOptions::Ratios::Painted
                                                         : ConvertOptions::Ratios::Own;
    if (options.method == Method::Paper) convert.bind.method = BindOptions::Method::Paper;
    convert.bind.rigid = options.rigid;
    if (options.shapes) convert.bind.shapes = *options.shapes;
    convert.bind.cacheFolder = cacheFolder();
    convert.bind.muscles = options.muscles.value_or(false);
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

} // namespace

Character convertScene(const std::string& file, const LoadOptions& options, LoadStages& stages) {
    const double binding =
        LoadStages::kBinding +
        LoadStages::shapesSize(options.shapes.value_or(BindOptions::Shapes::None));
    stages.plan(LoadStages::kModel + binding);
    stages.begin("model", LoadStages::kModel);
    const osg::ref_ptr<osg::Node> scene = readScene(file, options.readOptions.get());
    ConvertOptions convert = convertOptionsOf(options);
    convert.bind.progress = stages.begin("binding", binding);
    ConvertReport report = convertRigs(*scene, convert);
    if (report.skins.empty())
        throw Error(file + ": " +
                    (report.notes.empty() ? "no osgAnimation::RigGeometry, expected a rigged model"
                                          : report.notes.front()));
    Character character;
    character.file = character.meshFile = file;
    character.notes = report.notes;
    for (const auto& skin : report.skins) character.skin.skins.push_back({skin, {}});
    character.root = asGroup(scene);
    stages.finish();
    return character;
}

} // namespace osgSkin
