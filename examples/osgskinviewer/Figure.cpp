// SPDX-License-Identifier: MIT
#include "Figure.h"

#include <osg/NodeVisitor>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ReadScene>

#include <stdexcept>

namespace viewer {
namespace {

/// Finds the skins of a scene and what plays it.
class Finder : public osg::NodeVisitor {
public:
    explicit Finder(Figure& figure) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _figure(figure) {}

    void apply(osg::Node& node) override {
        auto* manager =
            dynamic_cast<osgAnimation::BasicAnimationManager*>(node.getUpdateCallback());
        if (manager != nullptr && !_figure.manager) {
            _figure.manager = manager;
            _figure.managed = &node;
        }
        traverse(node);
    }

    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable))
            _figure.skins.emplace_back(skin);
    }

private:
    Figure& _figure;
};

/// Whether the file says what its body is made of; other files are scenes.
bool hasBody(const std::string& file) {
    const bool isSkin = osgDB::getLowerCaseFileExtension(file) == "skin";
    if (isSkin && osgDB::fileExists(file)) return true;
    return osgSkin::isReadByAssimp(isSkin ? osgDB::getNameLessExtension(file) : file);
}

osg::ref_ptr<osg::Group> readScene(const std::string& file) {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(osgSkin::readScene(file, nullptr));
    return root;
}

osg::ref_ptr<osg::Group> loadScene(const std::string& file) {
    return osgSkin::loadCharacter(file).root;
}

} // namespace

Figure::Figure(const std::string& file, const std::string& weights,
               const osgSkin::LoadOptions& options) {
    if (hasBody(file)) {
        body = std::make_unique<figures::Body>(file, weights, options);
        root = body->character.root;
    } else {
        root = readScene(file);
    }
    Finder finder(*this);
    root->accept(finder);
    if (!skins.empty()) return;
    // A scene of rigs, which a load makes skins of.
    manager = nullptr;
    managed = nullptr;
    root = loadScene(file);
    root->accept(finder);
    if (skins.empty()) throw std::runtime_error(file + ": no skin in it, expected a character");
}

} // namespace viewer
