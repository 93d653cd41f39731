// SPDX-License-Identifier: MIT
#include "Labels.h"

#include <osg/Image>

#include <algorithm>

namespace twist {
namespace {

// The overlay's own units: pixels of a window of the size that the program opens.
constexpr double kWidth = 1280.0;
constexpr double kHeight = 640.0;

constexpr int kTexels = 32; ///< along a chequer's edge

void paint(osg::Image& image, int column, int row, const osg::Vec3& colour) {
    for (int y = 0; y < kTexels; ++y)
        for (int x = 0; x < kTexels; ++x)
            image.setColor(osg::Vec4(colour, 1.0f), static_cast<unsigned int>(column * kTexels + x),
                           static_cast<unsigned int>(row * kTexels + y));
}

} // namespace

osg::ref_ptr<osgText::Text> makeText(float size, osgText::Text::AlignmentType alignment) {
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setCharacterSize(size);
    text->setAlignment(alignment);
    text->setColor(osg::Vec4(0.93f, 0.94f, 0.95f, 1.0f));
    text->setDataVariance(osg::Object::DYNAMIC); // its figures change with every pose
    text->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return text;
}

osg::ref_ptr<osgText::Text> makeLabel(const osg::Vec3& position) {
    osg::ref_ptr<osgText::Text> label = makeText(0.37f, osgText::Text::CENTER_TOP);
    label->setAxisAlignment(osgText::Text::SCREEN);
    label->setPosition(position);
    // It hangs below the floor: drawn last, over everything.
    osg::StateSet& state = *label->getOrCreateStateSet();
    state.setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    state.setRenderBinDetails(10, "RenderBin");
    return label;
}

osg::ref_ptr<osg::Camera> makeOverlay(osgText::Text* title, osgText::Text* lines) {
    osg::ref_ptr<osg::Camera> overlay = new osg::Camera;
    overlay->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    overlay->setProjectionMatrixAsOrtho2D(0.0, kWidth, 0.0, kHeight);
    overlay->setViewMatrix(osg::Matrix::identity());
    overlay->setClearMask(GL_DEPTH_BUFFER_BIT);
    overlay->setRenderOrder(osg::Camera::POST_RENDER);
    overlay->setAllowEventFocus(false);
    title->setPosition(osg::Vec3(20.0f, float(kHeight) - 16.0f, 0.0f));
    lines->setPosition(osg::Vec3(20.0f, float(kHeight) - 60.0f, 0.0f));
    lines->setDrawMode(osgText::Text::TEXT | osgText::Text::FILLEDBOUNDINGBOX);
    lines->setBoundingBoxMargin(8.0f);
    lines->setBoundingBoxColor(osg::Vec4(0.08f, 0.09f, 0.10f, 1.0f)); // readable over a cylinder
    overlay->addChild(title);
    overlay->addChild(lines);
    return overlay;
}

osg::ref_ptr<osg::Texture2D> makeChequers(unsigned int around, const osg::Vec3& colour) {
    const osg::Vec3 white(0.93f, 0.92f, 0.89f);
    const int columns = static_cast<int>(around);
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns * kTexels, 2 * kTexels, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int column = 0; column < columns; ++column)
        for (int row = 0; row < 2; ++row)
            paint(*image, column, row, (column + row) % 2 == 0 ? white : colour);
    // The column that faces the camera at rest.
    for (int row = 0; row < 2; ++row)
        paint(*image, 3 * columns / 4, row, osg::Vec3(0.12f, 0.13f, 0.16f));
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    texture->setMaxAnisotropy(8.0f);
    return texture;
}

} // namespace twist
