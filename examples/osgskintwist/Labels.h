// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Texture2D>
#include <osg/Vec3>
#include <osg/ref_ptr>
#include <osgText/Text>

namespace twist {

/// Text in OSG's built-in font, which is there without any font file.
osg::ref_ptr<osgText::Text> makeText(float size, osgText::Text::AlignmentType alignment);

/// Text in the scene that always faces the camera, hung from `position`.
osg::ref_ptr<osgText::Text> makeLabel(const osg::Vec3& position);

/// Text over the scene at the upper left corner; `lines` below it.
osg::ref_ptr<osg::Camera> makeOverlay(osgText::Text* title, osgText::Text* lines);

/// Chequers in white and `colour`, with one dark stripe along the limb that shows the twist.
osg::ref_ptr<osg::Texture2D> makeChequers(unsigned int around, const osg::Vec3& colour);

} // namespace twist
