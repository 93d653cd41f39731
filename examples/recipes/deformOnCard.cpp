// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinGpu/GpuSkin>

#include <osg/ComputeBoundsVisitor>
#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osgText/Text>

namespace {

/// Shows how often compute shaders have deformed a skin.
struct ShowCount : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const unsigned int count = osgSkin::gpuCounts().dispatches;
        static_cast<osgText::Text&>(*node).setText("dispatches: " + std::to_string(count));
        traverse(node, nv);
    }
};

} // namespace

/// A figure that the graphics card deforms, and a line that says so.
osg::ref_ptr<osg::Node> deformOnCard(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    osgSkin::setGpu(*character.root, true); // all skins below; false: by the processor again

    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setAxisAlignment(osgText::Text::XZ_PLANE);
    osg::ComputeBoundsVisitor figure;
    character.root->accept(figure);
    const float height = figure.getBoundingBox().zMax();
    text->setPosition(osg::Vec3(-0.4f, 0.0f, 1.14f) * height);
    text->setCharacterSize(0.09f * height);
    text->setDataVariance(osg::Object::DYNAMIC);
    text->setUpdateCallback(new ShowCount);
    character.root->addChild(text);
    return character.root;
}
