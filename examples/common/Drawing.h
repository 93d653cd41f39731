// SPDX-License-Identifier: MIT
#pragma once

#include "Body.h"

#include <osg/Camera>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/ref_ptr>
#include <osgText/Text>

#include <functional>
#include <string>
#include <vector>

namespace figures {

const osg::Vec4 kInk(0.93f, 0.94f, 0.95f, 1.0f);
const osg::Vec4 kSkin(0.86f, 0.72f, 0.62f, 1.0f);

/// A group with three lights placed relative to the camera: a key light over its left shoulder, a
/// weaker fill light from the right, and a rim light from behind the scene.
/// \param toCamera direction from the scene to the camera, Z up
osg::ref_ptr<osg::Group> makeLit(const osg::Vec3d& toCamera = {0, -1, 0});

/// Geometry of the body's skin at `points` (rest space), in the scene's frame, with smooth normals.
osg::ref_ptr<osg::Geometry> makeSkin(const Body& body, const std::vector<glm::dvec3>& points,
                                     const std::function<osg::Vec4(std::size_t)>& colour);

/// Unlit geometry of the primitive type `mode`.
osg::ref_ptr<osg::Geometry> makeLines(const std::vector<osg::Vec3>& points, const osg::Vec4& colour,
                                      GLenum mode, float width = 2.0f);

osg::ref_ptr<osg::Node> makeBall(const osg::Vec3& centre, float radius, const osg::Vec4& colour);
osg::ref_ptr<osgText::Text> makeText(const std::string& text, const osg::Vec3& place, float size,
                                     const osg::Vec4& colour = kInk);
/// A camera that draws over the scene, in pixels from the lower left.
osg::ref_ptr<osg::Camera> makeOverlay(int width, int height);
/// An overlay with a caption at the lower left.
osg::ref_ptr<osg::Camera> makeCaption(const std::string& text, int width, int height,
                                      float size = 20.0f);

osg::Vec3 toScene(const glm::dvec3& v);
/// Colour of a ratio: 0 is blue, 0.5 light grey, 1 red.
osg::Vec4 ratioColour(double ratio);

} // namespace figures
