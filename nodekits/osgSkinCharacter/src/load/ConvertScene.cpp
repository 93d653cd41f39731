// SPDX-License-Identifier: MIT
#include "load/LoadSteps.h"
#include "scene/BuildScene.h"
#include "scene/FrontOrientation.h"
#include "source/ApplyOptions.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkinBind/ConvertRigs>
#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadOptions>
#include <osgSkinImport/ReadLimits>
#include <osgSkinImport/ReadScene>
#include <osgSkinMotion/ClipPlayer>
#include <osgSkinRig/ReadSkeleton>

#include <osg/MatrixTransform>
#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/StateSet>
#include <osg/Transform>
#include <osgAnimation/Bone>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

bool isBone(const osg::ref_ptr<osg::Node>& node) {
    return dynamic_cast<osgAnimation::Bone*>(node.get()) != nullptr;
}

class Sorter : public osg::NodeVisitor {
public:
    Sorter() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Bone*>(&node) != nullptr) sort(node);
        traverse(node);
    }

private:
    static void sort(osg::Group& bone) {
        std::vector<osg::ref_ptr<osg::Node>> children;
        for (unsigned int c = 0; c < bone.getNumChildren(); ++c)
            children.emplace_back(bone.getChild(c));
        if (std::is_partitioned(children.begin(), children.end(), isBone)) return;
        std::stable_partition(children.begin(), children.end(), isBone);
        bone.removeChildren(0, bone.getNumChildren());
        for (const auto& child : children) bone.addChild(child);
    }
};

/// Moves bones before a bone's other children: osgAnimation updates them in this order, and warns
/// about others.
void putBonesFirst(osg::Node& scene) {
    Sorter sorter;
    scene.accept(sorter);
}

using osgAnimation::BasicAnimationManager;

/// Finds a scene's animation managers and the nodes that they update.
class Managers : public osg::NodeVisitor {
public:
    struct Entry {
        osg::ref_ptr<BasicAnimationManager> manager;
        osg::Node* node;
    };

    Managers() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override {
        for (osg::Callback* callback = node.getUpdateCallback(); callback != nullptr;
             callback = callback->getNestedCallback()) {
            auto* manager = dynamic_cast<BasicAnimationManager*>(callback);
            const bool isKnown = std::any_of(found.begin(), found.end(), [&](const Entry& entry) {
                return entry.manager == manager;
            });
            if (manager != nullptr && !isKnown) found.push_back({manager, &node});
        }
        traverse(node);
    }

    std::vector<Entry> found;
};

/// Moves the requested animation to the front.
void putFirst(const std::string& wanted, const std::string& file,
              std::vector<osgAnimation::AnimationList>& lists) {
    std::vector<std::string> names;
    for (osgAnimation::AnimationList& list : lists)
        for (std::size_t a = 0; a < list.size(); ++a) {
            names.push_back(list[a]->getName());
            if (names.back() != wanted) continue;
            std::rotate(list.begin(), list.begin() + std::ptrdiff_t(a),
                        list.begin() + std::ptrdiff_t(a) + 1);
            return;
        }
    throw Error(file + ": motion \"" + wanted + "\" is not in the scene" +
                (names.empty() ? ", which has none" : expectedNames(wanted, names)) +
                "; motion files are not carried over to scenes that OpenSceneGraph reads");
}

/// Replaces the scene's manager by one on the root, but where a ClipPlayer plays.
void manageFromRoot(const Managers::Entry& entry, const osgAnimation::AnimationList& clips,
                    Character& character) {
    const osg::ref_ptr<osg::Group> scene = character.root;
    for (const auto& clip : clips) character.motions.emplace_back().animation = clip;
    if (find<ClipPlayer>(*scene)) { // a saved one, which plays in the manager's place
        character.manager = entry.manager;
        return;
    }
    entry.node->removeUpdateCallback(entry.manager);
    character.root = new osg::Group;
    character.root->setName(scene->getName());
    character.root->addChild(scene);
    character.root->setInitialBound(playedBounds(*character.root, clips));
    const osg::ref_ptr<AutoPlayManager> manager = new AutoPlayManager;
    manager->registerAnimations(clips);
    character.manager = manager;
    character.root->setUpdateCallback(character.manager);
    character.manager->playAnimation(clips.front());
}

/// Sets up the animations of a scene that osgDB has read: the one of LoadOptions plays, else the
/// first. In a scene with one animation manager, the character gets its motions, and a manager at
/// the root replaces the scene's and also plays when saved and read again. Several managers stay
/// and play their first animations.
///
/// \param options of the caller
/// \param character with `file` and the scene as its root
/// \throw Error where the requested motion is not one of the scene's, with their names: motion
///        files are not retargeted to such scenes
void takeSceneMotions(const LoadOptions& options, Character& character) {
    Managers managers;
    character.root->accept(managers);
    if (options.atRest) {
        for (const Managers::Entry& entry : managers.found)
            entry.node->removeUpdateCallback(entry.manager);
        return;
    }
    std::vector<osgAnimation::AnimationList> lists;
    for (const Managers::Entry& entry : managers.found) {
        lists.push_back(entry.manager->getAnimationList());
        auto& list = lists.back();
        list.erase(std::remove(list.begin(), list.end(), nullptr), list.end());
    }
    if (options.motion) putFirst(*options.motion, character.file, lists);
    if (lists.size() == 1 && !lists.front().empty())
        return manageFromRoot(managers.found.front(), lists.front(), character);
    for (std::size_t m = 0; m < lists.size(); ++m)
        if (!lists[m].empty()) managers.found[m].manager->playAnimation(lists[m].front());
}

ConvertOptions convertOptionsOf(const LoadOptions& options) {
    using Method = LoadOptions::Method;
    ConvertOptions convert;
    convert.ratios = options.method == Method::Default   ? ConvertOptions::Ratios::Best
                     : options.method == Method::Weights ? ConvertOptions::Ratios::Painted
                                                         : ConvertOptions::Ratios::Own;
    if (options.method == Method::Paper) convert.bind.method = BindOptions::Method::Paper;
    convert.bind.rigid = options.rigid;
    convert.bind.shapes = options.shapes;
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

/// The merged state of all nodes above a skin.
osg::ref_ptr<osg::StateSet> stateOf(const osg::Node& skin) {
    osg::ref_ptr<osg::StateSet> merged = new osg::StateSet;
    const osg::NodePathList paths = skin.getParentalNodePaths();
    if (paths.empty()) return merged;
    for (const osg::Node* node : paths.front())
        if (node->getStateSet() != nullptr) merged->merge(*node->getStateSet());
    return merged;
}

void takeSkeleton(osgAnimation::Skeleton& skeleton, Character& character) {
    character.skeleton = &skeleton;
    const osg::NodePathList paths = skeleton.getParentalNodePaths(character.root);
    if (!paths.empty()) character.toWorld = osg::computeLocalToWorld(paths.front());
}

/// Makes a scene's only body the character's.
void takeBody(ConvertedBody& body, const BindOptions& options, Character& character) {
    character.body.mesh = std::move(body.mesh);
    character.body.parts = std::move(body.parts);
    character.rest = std::move(body.rest);
    character.binding = std::move(body.binding);
    character.bindReport = std::move(body.report);
    character.bindOptions = options;
    character.bindOptions.progress = {};
    character.skin.skins = std::move(body.skins);
    for (std::size_t i = 0; i < character.skin.skins.size(); ++i)
        character.body.parts[i].geometry->setStateSet(stateOf(*character.skin.skins[i].drawable));
    takeSkeleton(*body.skeleton, character);
}

/// Finds the skins of a saved character.
class SavedSkins : public osg::NodeVisitor {
public:
    SavedSkins() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(&node))
            skeletons.insert(skeleton);
        traverse(node);
    }
    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<DeformableSkin*>(&drawable)) skins.push_back({skin, {}});
    }

    std::vector<AttachedSkin::Skin> skins;
    std::set<osgAnimation::Skeleton*> skeletons;
};

/// Whether options ask for another binding, shape or size than the saved one.
bool asksForBinding(const LoadOptions& options) {
    return options.method != LoadOptions::Method::Default || options.shapes || options.muscles ||
           options.surfaceNormals || options.avoidBody || options.rigid || options.mergeRigid ||
           options.unit || options.showRegions;
}

/// Makes a scene that has skins already the character.
/// \return false where it has none
bool takeSaved(const LoadOptions& options, Character& character) {
    SavedSkins saved;
    character.root->accept(saved);
    if (saved.skins.empty()) return false;
    character.skin.skins = std::move(saved.skins);
    if (saved.skeletons.size() == 1) {
        takeSkeleton(**saved.skeletons.begin(), character);
        character.rest = readSkeleton(*character.skeleton);
    }
    if (asksForBinding(options))
        warn(character.notes, character.file + ": bound already, so options of binding, shapes "
                                               "and unit have no effect; load what it was made of");
    return true;
}

/// Rotates the whole scene, and scales it to metres, without changing the author's nodes.
void placeScene(double metresPerUnit, Character& character) {
    osg::Matrixd place = osg::Matrixd::scale(metresPerUnit, metresPerUnit, metresPerUnit);
    if (character.hasBody())
        place =
            place * orientToFront(character.roles, boneCentres(character.rest, *character.root));
    if (place.isIdentity()) return;
    const osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(place);
    placed->setName(character.root->getName());
    placed->setDataVariance(osg::Object::DYNAMIC);
    normalizeIfScaled(*placed);
    placed->addChild(character.root);
    character.root = placed;
    character.toWorld = character.toWorld * place;
}

} // namespace

Character convertScene(const std::string& file, const LoadOptions& options, LoadStages& stages) {
    stages.plan(LoadStages::kModel + LoadStages::kBinding);
    stages.begin("model", LoadStages::kModel);
    const ReadLimits limits = ReadLimits::of(options.readOptions.get());
    limits.checkFormat(file);
    if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file))
        throw Error(file + ": not a regular file");
    const osg::ref_ptr<osg::Node> scene = readScene(file, options.readOptions.get());
    putBonesFirst(*scene);
    ConvertOptions convert = convertOptionsOf(options);
    convert.bind.progress = stages.begin("binding", LoadStages::kBinding);
    ConvertReport report = convertRigs(*scene, convert);
    Character character;
    character.file = character.meshFile = file;
    character.files = {file};
    character.notes = report.notes;
    character.root = asGroup(scene);
    const bool isSaved = report.skins.empty() && takeSaved(options, character);
    if (report.skins.empty() && !isSaved)
        throw Error(file + ": " +
                    (report.notes.empty() ? "no osgAnimation::RigGeometry, expected a rigged model"
                                          : report.notes.front()));
    for (const auto& skin : report.skins) character.skin.skins.push_back({skin, {}});
    if (report.bodies.size() == 1) takeBody(report.bodies.front(), convert.bind, character);
    character.roles = recogniseJoints(character.rest);
    if (!isSaved) placeScene(unitOf(0.0, options, file, character.notes), character);
    if (character.hasBody() && !options.unit) checkSize(character, false);
    takeSceneMotions(options, character);
    stages.finish();
    return character;
}

} // namespace osgSkin
