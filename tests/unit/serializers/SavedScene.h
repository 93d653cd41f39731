// SPDX-License-Identifier: MIT
#pragma once

#include "Tube.h"

#include <osgSkin/DeformableSkin>

#include <gtest/gtest.h>
#include <osg/Group>
#include <osg/Notify>
#include <osg/ref_ptr>

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace test {

/// A tube's skin and a copy of it under a skeleton of three bones, a rigid part on the last bone,
/// an animation of the middle one, and a non-default value in each saved field.
osg::ref_ptr<osg::Group> makeScene(const Tube& tube = Tube());

/// All skins below `root`.
std::vector<osgSkin::DeformableSkin*> skinsOf(osg::Node& root);

/// Writes to memory, in the format of this extension. Text has all digits of a number.
/// \param scene to save
/// \param extension of the format
/// \param version of OSG's files; 0: the current one
std::string save(const osg::Node& scene, const std::string& extension, int version = 0);

/// Reads the output of save(); null, with the message that it would print, if osgDB refuses it.
osg::ref_ptr<osg::Node> load(const std::string& file, const std::string& extension,
                             std::string* reason = nullptr);

/// Skinning matrices of a few poses of the tube, with all joints rotated.
std::vector<std::vector<glm::dmat4>> somePoses(const osgSkin::DeformableSkin& skin);

/// The vertices, then the normals, of the skin in this pose.
std::vector<osg::Vec3> posed(osgSkin::DeformableSkin& skin, const std::vector<glm::dmat4>& pose);

/// Besides our own messages, OSG prints its reading of each word of a bad file.
template <typename Case>
class Quietly : public testing::TestWithParam<Case> {
protected:
    void SetUp() override { osg::setNotifyLevel(osg::ALWAYS); }
    void TearDown() override { osg::setNotifyLevel(osg::NOTICE); }
};

} // namespace test
