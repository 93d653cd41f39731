// SPDX-License-Identifier: MIT
//
// Morph targets: a morphed skin deforms as one whose rest vertices are the moved ones.
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "SomeMorphs.h"
#include "TubeSkin.h"
#include "UpdateAt.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkin/MorphedRest>
#include <osgSkin/SetMorph>
#include <osgSkin/UpdateMorphs>

#include <gtest/gtest.h>
#include <osgAnimation/BasicAnimationManager>

#include <cmath>
#include <limits>

namespace {

using osgSkin::DeformableSkin;
using osgSkin::MorphTarget;
using osgSkin::MorphTargets;

const std::vector<float> kWeights = {0.7f, -0.4f, 0.5f};

/// The rest vertices that a tube has with these weights.
test::Tube moved(test::Tube tube, const std::vector<MorphTarget>& targets,
                 const std::vector<float>& weights) {
    for (std::size_t i = 0; i < targets.size(); ++i)
        for (std::size_t k = 0; k < targets[i].vertices.size(); ++k) {
            const std::uint32_t v = targets[i].vertices[k];
            tube.positions[v] += weights[i] * targets[i].positions[k];
            if (!targets[i].normals.empty()) tube.normals[v] += weights[i] * targets[i].normals[k];
        }
    for (glm::vec3& normal : tube.normals) normal = glm::normalize(normal);
    return tube;
}

/// The model in one pose, of random rotations.
osgSkin::DeformedVertices posed(const osgSkin::SkinModel& model,
                                const osgSkin::MorphedRest* morphed, bool byReference) {
    std::mt19937_64 random(5);
    std::vector<glm::dquat> turns;
    for (std::size_t j = 0; j < model.joints().size(); ++j)
        turns.push_back(test::randomRotation(random));
    osgSkin::DeformOptions options;
    options.normals = true;
    options.morphed = morphed;
    options.reference = byReference;
    const auto skinning = test::skinningFrom(model.joints(), turns, {0.3, -0.2, 0.5});
    return osgSkin::deform(model, skinning, options);
}

float farthest(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    float result = 0.0f;
    for (std::size_t v = 0; v < a.size(); ++v) result = std::max(result, glm::distance(a[v], b[v]));
    return result;
}

osg::ref_ptr<DeformableSkin> morphSkin(const char* name = nullptr) {
    osg::ref_ptr<DeformableSkin> skin = test::makeSkin();
    const std::size_t vertices = skin->getModel()->vertexCount();
    std::vector<MorphTarget> targets = test::someMorphs(vertices, 0.1);
    if (name) targets.resize(1);
    if (name) targets[0].name = name;
    skin->setMorphTargets(MorphTargets::create(targets, vertices));
    return skin;
}

std::vector<glm::vec3> drawn(const DeformableSkin& skin) {
    const auto& array =
        static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray());
    std::vector<glm::vec3> result;
    for (const osg::Vec3& p : array) result.emplace_back(p.x(), p.y(), p.z());
    return result;
}

} // namespace

/// Vertices out of the deformation's order, and partial last blocks, are covered by 3 sizes.
TEST(Morph, MatchesASkinWithMovedRestVertices) {
    for (const int rings : {3, 9, 25})
        for (const bool byReference : {false, true}) {
            const test::Tube tube(rings, 7);
            const auto targets = test::someMorphs(tube.positions.size(), 0.2);
            const auto model = tube.model();
            osgSkin::MorphedRest rest(model, MorphTargets::create(targets, model->vertexCount()));
            rest.set({0.2f, 0.9f, 0.0f}); // leaves nothing behind
            rest.set(kWeights);
            const auto is = posed(*model, &rest, byReference);
            const auto expected = posed(*moved(tube, targets, kWeights).model(), nullptr, true);
            EXPECT_LT(farthest(is.positions, expected.positions), 6e-6f);
            EXPECT_LT(farthest(is.normals, expected.normals), 1e-5f);
        }
}

/// Correctives and the tilt of bent skin are added to a morphed one, by kernel and reference alike.
TEST(Morph, KernelMatchesTheReferenceWithCorrectives) {
    test::SlopedTube tube;
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.05, 7, true);
    const auto model = tube.model();
    const auto targets = test::someMorphs(model->vertexCount(), 0.1);
    osgSkin::MorphedRest rest(model, MorphTargets::create(targets, model->vertexCount()));
    rest.set(kWeights);
    const auto kernel = posed(*model, &rest, false), reference = posed(*model, &rest, true);
    const auto without = posed(*model, nullptr, true);
    EXPECT_LT(farthest(kernel.positions, reference.positions), 6e-6f);
    EXPECT_LT(farthest(kernel.normals, reference.normals), 2e-5f);
    EXPECT_GT(farthest(without.positions, reference.positions), 0.05f);
    EXPECT_GT(farthest(without.normals, reference.normals), 0.05f);
}

TEST(Morph, SkinSetsAndReturnsWeights) {
    const osg::ref_ptr<DeformableSkin> skin = morphSkin();
    const std::vector<glm::vec3> before = drawn(*skin);
    EXPECT_FALSE(skin->isMorphed());
    EXPECT_TRUE(skin->setMorph("smile", 0.7f));
    EXPECT_TRUE(skin->isMorphed());
    EXPECT_EQ(skin->getMorph("smile"), 0.7f);
    EXPECT_FALSE(skin->setMorph("simle", 1.0f));
    EXPECT_FALSE(skin->setMorph("smile", std::numeric_limits<float>::quiet_NaN()));
    EXPECT_FALSE(skin->setMorphWeights({1.0f}));
    const std::vector<glm::vec3> smiling = drawn(*skin);
    const MorphTarget& smile = skin->getMorphTargets()->targets()[0];
    for (std::size_t k = 0; k < smile.vertices.size(); ++k) {
        const std::uint32_t v = smile.vertices[k];
        EXPECT_LT(glm::distance(smiling[v], before[v] + 0.7f * smile.positions[k]), 2e-6f) << v;
        EXPECT_TRUE(skin->getBoundingBox().contains({smiling[v].x, smiling[v].y, smiling[v].z}));
    }
    const osg::ref_ptr<DeformableSkin> copy = osg::clone(skin.get());
    EXPECT_EQ(farthest(drawn(*copy), smiling), 0.0f);
    EXPECT_TRUE(skin->setMorph("smile", 0.0f));
    EXPECT_EQ(farthest(drawn(*skin), before), 0.0f);
    EXPECT_EQ(copy->getMorph("smile"), 0.7f);
}

TEST(Morph, RestVerticesIncludeInitialWeights) {
    const osg::ref_ptr<DeformableSkin> skin = test::makeSkin();
    const std::vector<glm::vec3> rest = drawn(*skin);
    auto targets = test::someMorphs(rest.size(), 0.1);
    targets[1].initial = 0.25f;
    const std::uint32_t v = targets[1].vertices[3];
    skin->setMorphTargets(MorphTargets::create(targets, rest.size()));
    EXPECT_EQ(skin->getMorph("frown"), 0.25f);
    EXPECT_EQ(farthest(drawn(*skin), rest), 0.0f);
    skin->setMorph("frown", 1.0f);
    EXPECT_LT(glm::distance(drawn(*skin)[v], rest[v] + 0.75f * targets[1].positions[3]), 2e-6f);
}

TEST(Morph, SettingAnotherSkinRemovesMismatchedTargets) {
    const osg::ref_ptr<DeformableSkin> skin = morphSkin();
    skin->setMorph("open", 1.0f);
    test::Tube shorter(9);
    skin->setSkin(test::makeGeometry(shorter), shorter.model());
    EXPECT_EQ(skin->getMorphTargets(), nullptr);
    EXPECT_FALSE(skin->isMorphed());
    EXPECT_EQ(drawn(*skin).size(), shorter.positions.size());
}

TEST(Morph, RejectsInvalidTargets) {
    const auto good = test::someMorphs(30, 0.1);
    const auto refused = [&](const auto& change) {
        auto targets = good;
        change(targets);
        EXPECT_THROW(MorphTargets::create(targets, 30), osgSkin::Error);
    };
    EXPECT_NO_THROW(MorphTargets::create(good, 30));
    refused([](auto& targets) { targets[1].name = targets[0].name; });
    refused([](auto& targets) { targets[1].name.clear(); });
    refused([](auto& targets) { targets[0].vertices[1] = 0; });
    refused([](auto& targets) { targets[2].vertices.back() = 30; });
    refused([](auto& targets) { targets[0].positions.pop_back(); });
    refused([](auto& targets) { targets[0].normals.pop_back(); });
    refused([](auto& targets) { targets[2].tangents[0].x = std::nanf(""); });
    const osg::ref_ptr<DeformableSkin> skin = test::makeSkin();
    EXPECT_THROW(skin->setMorphTargets(MorphTargets::create(good, 30)), osgSkin::Error);
}

/// A face and its teeth are two skins.
TEST(Morph, SetsAllSkinsOfAScene) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<DeformableSkin> face = morphSkin(), teeth = morphSkin("open");
    scene->addChild(face);
    scene->addChild(teeth);
    scene->addChild(test::makeSkin());
    EXPECT_EQ(osgSkin::morphNames(*scene), (std::vector<std::string>{"smile", "frown", "open"}));
    EXPECT_TRUE(osgSkin::setMorph(*scene, "open", 0.5f));
    EXPECT_TRUE(osgSkin::setMorph(*scene, "smile", 0.3f));
    EXPECT_FALSE(osgSkin::setMorph(*scene, "wink", 0.3f));
    EXPECT_EQ(face->getMorph("open"), 0.5f);
    EXPECT_EQ(teeth->getMorph("open"), 0.5f);
    EXPECT_EQ(face->getMorph("smile"), 0.3f);
    EXPECT_EQ(osgSkin::getMorph(*scene, "smile"), 0.3f);
    EXPECT_EQ(osgSkin::getMorph(*scene, "wink"), 0.0f);
}

TEST(Morph, FollowsPlayingChannels) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<osg::Group> below = new osg::Group;
    const osg::ref_ptr<DeformableSkin> skin = morphSkin();
    below->addChild(skin);
    below->setUpdateCallback(new osgSkin::UpdateMorphs);
    scene->addChild(below);
    const osg::ref_ptr<osgAnimation::FloatLinearChannel> channel =
        new osgAnimation::FloatLinearChannel;
    channel->setName("smile");
    channel->setTargetName(osgSkin::UpdateMorphs::kName);
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::FloatKeyframe(0.0, 0.0f));
    keys->push_back(osgAnimation::FloatKeyframe(2.0, 1.0f));
    const osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
    clip->addChannel(channel);
    clip->setPlayMode(osgAnimation::Animation::LOOP);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    manager->registerAnimation(clip);
    scene->setUpdateCallback(manager);
    const auto update = [&](double time) { test::updateAt(*scene, time); };
    skin->setMorph("smile", 0.9f);
    skin->setMorph("frown", 0.8f);
    update(0.0);
    EXPECT_EQ(skin->getMorph("smile"), 0.9f) << "nothing plays";
    manager->playAnimation(clip);
    update(0.0);
    update(1.0);
    EXPECT_NEAR(skin->getMorph("smile"), 0.5f, 1e-3f);
    EXPECT_EQ(skin->getMorph("frown"), 0.8f) << "no channel drives it";
    manager->stopAnimation(clip);
    update(1.5);
    skin->setMorph("smile", 0.1f);
    update(1.6);
    EXPECT_EQ(skin->getMorph("smile"), 0.1f);
}
