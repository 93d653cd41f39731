// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/SceneMotions.h"

#include "scene/PlayedBounds.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/Error>

#include <osg/NodeVisitor>

#include <algorithm>
#include <vector>

namespace osgSkin {
namespace {

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

/// Puts the wanted animation first.
void putFirst(const std::string& wanted, const std::string& file,
              std::vector<osgAnimation::AnimationList>& lists) {
    std::string names;
    for (osgAnimation::AnimationList& list : lists)
        for (std::size_t a = 0; a < list.size(); ++a) {
            const std::string& name = list[a]->getName();
            names += (names.empty() ? ", expected one of \"" : ", \"") + name + '"';
            if (name != wanted) continue;
            std::rotate(list.begin(), list.begin() + std::ptrdiff_t(a),
                        list.begin() + std::ptrdiff_t(a) + 1);
            return;
        }
    throw Error(file + ": motion \"" + wanted + "\" is none of the scene's" +
                (names.empty() ? ", which has none" : names) +
                "; motion files are not carried over to scenes that OpenSceneGraph reads");
}

/// Gives the root a manager in place of the scene's own.
void manageFromRoot(const Managers::Entry& entry, const osgAnimation::AnimationList& clips,
                    Character& character) {
    const osg::ref_ptr<osg::Group> scene = character.root;
    entry.node->removeUpdateCallback(entry.manager);
    character.root = new osg::Group;
    character.root->setName(scene->getName());
    character.root->addChild(scene);
    character.root->setInitialBound(playedBounds(*character.root, clips));
    const osg::ref_ptr<AutoPlayManager> manager = new AutoPlayManager;
    manager->registerAnimations(clips);
    character.manager = manager;
    for (const auto& clip : clips) character.motions.emplace_back().animation = clip;
    character.root->setUpdateCallback(character.manager);
    character.manager->playAnimation(clips.front());
}

} // namespace

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

} // namespace osgSkin
