// SPDX-License-Identifier: MIT
#include "Drawing.h"

#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/LineWidth>
#include <osg/Material>
#include <osg/Point>
#include <osg/ShapeDrawable>

namespace figures {
namespace {

osg::ref_ptr<osg::Vec4Array> one(const osg::Vec4& colour) {
    osg::ref_ptr<osg::Vec4Array> colours = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    colours->push_back(colour);
    return colours;
}

void addLight(osg::Group& group, int number, const osg::Vec3d& from, const osg::Vec4& diffuse) {
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::Light& light = *source->getLight();
    light.setLightNum(number);
    light.setPosition(osg::Vec4(osg::Vec3(from), 0.0f));
    light.setAmbient(osg::Vec4(0, 0, 0, 1));
    light.setDiffuse(diffuse);
    light.setSpecular(osg::Vec4(0, 0, 0, 1));
    source->setStateSetModes(*group.getOrCreateStateSet(), osg::StateAttribute::ON);
    group.addChild(source);
}

} // namespace

osg::Vec3 toScene(const glm::dvec3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

osg::Vec4 ratioColour(double ratio) {
    const float t = float(ratio);
    const osg::Vec4 blue(0.13f, 0.33f, 0.85f, 1.0f);
    const osg::Vec4 grey(0.88f, 0.87f, 0.85f, 1.0f);
    const osg::Vec4 red(0.85f, 0.13f, 0.12f, 1.0f);
    return t < 0.5f ? blue * (1.0f - 2.0f * t) + grey * (2.0f * t)
                    : grey * (2.0f - 2.0f * t) + red * (2.0f * t - 1.0f);
}

osg::ref_ptr<osg::Group> makeLit(const osg::Vec3d& toCamera) {
    osg::Vec3d back = toCamera;
    back.normalize();
    osg::Vec3d right = osg::Vec3d(0, 0, 1) ^ back;
    right.normalize();
    const osg::Vec3d up = back ^ right;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    addLight(*group, 0, back * 0.55 - right * 0.8 + up * 0.75, osg::Vec4(0.86f, 0.84f, 0.80f, 1));
    addLight(*group, 1, back * 0.5 + right * 1.0 - up * 0.1, osg::Vec4(0.24f, 0.28f, 0.36f, 1));
    addLight(*group, 2, up * 0.8 + right * 0.7 - back * 0.8, osg::Vec4(0.45f, 0.45f, 0.42f, 1));
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.30f, 0.30f, 0.33f, 1.0f));
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    group->getOrCreateStateSet()->setAttributeAndModes(material);
    group->getOrCreateStateSet()->setAttributeAndModes(model);
    return group;
}

osg::ref_ptr<osg::Geometry> makeSkin(const Body& body, const std::vector<glm::dvec3>& points,
                                     const std::function<osg::Vec4(std::size_t)>& colour) {
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec4Array> colours = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    for (std::size_t v = 0; v < points.size(); ++v) {
        vertices->push_back(toScene(body.toWorld(points[v])));
        colours->push_back(colour(v));
    }
    const osg::ref_ptr<osg::Vec3Array> normals =
        new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, unsigned(points.size()));
    const std::vector<std::uint32_t>& t = body.triangles;
    for (std::size_t i = 0; i < t.size(); i += 3) {
        const osg::Vec3& a = (*vertices)[t[i]];
        const osg::Vec3 area = ((*vertices)[t[i + 1]] - a) ^ ((*vertices)[t[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) (*normals)[t[i + k]] += area;
    }
    for (osg::Vec3& normal : *normals) normal.normalize();
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals);
    geometry->setColorArray(colours);
    geometry->addPrimitiveSet(
        new osg::DrawElementsUInt(GL_TRIANGLES, unsigned(t.size()), t.data()));
    return geometry;
}

osg::ref_ptr<osg::Geometry> makeLines(const std::vector<osg::Vec3>& points, const osg::Vec4& colour,
                                      GLenum mode, float width) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(points.begin(), points.end()));
    geometry->setColorArray(one(colour));
    geometry->addPrimitiveSet(new osg::DrawArrays(mode, 0, int(points.size())));
    osg::StateSet& state = *geometry->getOrCreateStateSet();
    state.setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state.setAttribute(new osg::LineWidth(width));
    state.setAttribute(new osg::Point(width));
    return geometry;
}

osg::ref_ptr<osg::Node> makeBall(const osg::Vec3& centre, float radius, const osg::Vec4& colour) {
    const osg::ref_ptr<osg::ShapeDrawable> ball =
        new osg::ShapeDrawable(new osg::Sphere(centre, radius));
    ball->setColor(colour);
    return ball;
}

osg::ref_ptr<osgText::Text> makeText(const std::string& text, const osg::Vec3& place, float size,
                                     const osg::Vec4& colour) {
    osg::ref_ptr<osgText::Text> label = new osgText::Text;
    label->setCharacterSize(size);
    label->setPosition(place);
    label->setColor(colour);
    label->setText(text);
    label->setDataVariance(osg::Object::DYNAMIC);
    osg::StateSet& state = *label->getOrCreateStateSet();
    state.setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state.setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    state.setRenderBinDetails(10, "RenderBin");
    return label;
}

osg::ref_ptr<osg::Camera> makeOverlay(int width, int height) {
    osg::ref_ptr<osg::Camera> overlay = new osg::Camera;
    overlay->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    overlay->setProjectionMatrixAsOrtho2D(0.0, width, 0.0, height);
    overlay->setViewMatrix(osg::Matrix::identity());
    overlay->setClearMask(GL_DEPTH_BUFFER_BIT);
    // Nested in the main draw, so that reading the picture back includes the overlay.
    overlay->setRenderOrder(osg::Camera::NESTED_RENDER, 1);
    overlay->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    overlay->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    overlay->getOrCreateStateSet()->setRenderBinDetails(100, "RenderBin");
    return overlay;
}

osg::ref_ptr<osg::Camera> makeCaption(const std::string& text, int width, int height, float size) {
    osg::ref_ptr<osg::Camera> overlay = makeOverlay(width, height);
    const osg::ref_ptr<osgText::Text> label = makeText(text, osg::Vec3(14, 14, 0), size);
    label->setAlignment(osgText::Text::LEFT_BOTTOM);
    label->setDrawMode(osgText::Text::TEXT | osgText::Text::FILLEDBOUNDINGBOX);
    label->setBoundingBoxMargin(6.0f);
    label->setBoundingBoxColor(osg::Vec4(0.08f, 0.09f, 0.10f, 1.0f));
    overlay->addChild(label);
    return overlay;
}

} // namespace figures
