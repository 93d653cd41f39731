// SPDX-License-Identifier: MIT
// What a crowd's character and its members refuse; it leaves them as they were.
#include "CrowdSubject.h"

#include "TubeSkin.h"

#include <osgSkin/Error>

#include <gtest/gtest.h>

#include <limits>

namespace {

using osgSkin::CrowdCharacter;
using osgSkin::CrowdInstance;
using osgSkin::Error;
using osgSkin::GpuCrowd;
using test::CrowdSubject;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A tube with palettes of more than 800 texels.
osg::ref_ptr<osgSkin::DeformableSkin> skinOfLargePalettes() {
    test::Tube tube;
    osgSkin::Correctives& correctives = tube.binding.correctives;
    osgSkin::CorrectiveJoint breath;
    breath.basis = osgSkin::CorrectiveJoint::Basis::Input;
    breath.low.x = -1.0;
    breath.high.x = 1.0;
    breath.modes = osgSkin::CorrectiveJoint::kMaxModes;
    breath.coefficients.assign(breath.modes, 0.1);
    correctives.inputs = {"breath"};
    correctives.joints.assign(osgSkin::Correctives::kMaxJoints, breath);
    correctives.firstEntry.assign(tube.positions.size() + 1, 1);
    correctives.firstEntry.front() = 0;
    correctives.entries = {{0, 0}};
    correctives.shares.assign(3 * breath.modes, 1);
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(test::makeGeometry(tube), tube.model());
    return skin;
}

osg::PrimitiveSet* triangles(const std::vector<GLuint>& corners) {
    return new osg::DrawElementsUInt(GL_TRIANGLES, corners.begin(), corners.end());
}

CrowdCharacter::Samples restSamples(std::size_t count) {
    return {
        std::vector<std::vector<glm::dmat4>>(count, std::vector<glm::dmat4>(3, glm::dmat4(1.0)))};
}

} // namespace

TEST(CrowdCharacter, RefusesWhatDoesNotFit) {
    const CrowdSubject subject(1);
    EXPECT_THROW(osg::ref_ptr<GpuCrowd>(new GpuCrowd(new CrowdCharacter)), Error);
    const osg::ref_ptr<osg::Geometry> nothing = new osg::Geometry;
    const auto character = subject.character();
    EXPECT_THROW(character->addClip({}, 30.0, true), Error);
    EXPECT_THROW(character->addClip({{{}}}, 30.0, true), Error);
    EXPECT_FALSE(character->setSample(7, 0, 0, osgSkin::Pose()));
    EXPECT_THROW(character->addRigid(*nothing, nullptr, 0, "end"), Error);
    EXPECT_THROW(character->addRigid(*nothing, nullptr, 0, "tail"), Error);
    EXPECT_THROW(character->addRigid(*nothing, nullptr, 9, "end"), Error);
}

TEST(CrowdCharacter, KeepsNoClipThatItRefuses) {
    const osg::ref_ptr<CrowdCharacter> character = new CrowdCharacter;
    character->addSkin(*skinOfLargePalettes(), osg::Matrixd());
    EXPECT_THROW(character->addClip(restSamples(25000), 30.0, true), Error) << "texels";
    EXPECT_THROW(osg::ref_ptr<GpuCrowd>(new GpuCrowd(character)), Error) << "it has no clip";
    auto far = restSamples(2);
    far[0][0][0][3].x = 1000.0;
    far[0][1][1][0].x = kNaN;
    EXPECT_THROW(character->addClip(far, 30.0, true), Error);
    EXPECT_FALSE(character->bounds().valid());
    EXPECT_EQ(character->addClip(restSamples(2), 30.0, true), 0u);
    EXPECT_EQ(character->clipCount(), 1u);
    EXPECT_LT(character->bounds().xMax(), 100.0f);
}

TEST(CrowdCharacter, ClipsNeedRatesThatShadersHave) {
    const auto character = CrowdSubject(1).character();
    for (const double rate : {0.0, -1.0, kNaN, kInf, 1e39, 1e-46})
        EXPECT_THROW(character->addClip(restSamples(2), rate, true), Error) << rate;
    EXPECT_EQ(character->clipCount(), 3u);
    EXPECT_DOUBLE_EQ(character->loopSeconds(0), 0.8);
    EXPECT_EQ(character->loopSeconds(2), 0.0);
}

TEST(CrowdCharacter, LevelsGrowCoarserOneByOne) {
    const auto character = CrowdSubject(1).character();
    for (const double wrong : {-0.1, 1.0, 2.0, kNaN, kInf, -kInf})
        EXPECT_THROW(character->addLevel(wrong, 0.5), Error) << wrong;
    for (const double wrong : {-0.1, kNaN, kInf, 1e39})
        EXPECT_THROW(character->addLevel(0.5, wrong), Error) << wrong;
    EXPECT_EQ(character->levelCount(), 1u);
    character->addLevel(0.5, 0.5);
    EXPECT_THROW(character->addLevel(0.5, 0.1), Error);
    EXPECT_THROW(character->addLevel(0.1, 0.5), Error);
    EXPECT_EQ(character->levelCount(), 2u);
    // Not a skin without triangles in the levels.
    EXPECT_THROW(character->addSkin(*test::makeSkin(), osg::Matrixd()), Error);
    EXPECT_EQ(character->skins().size(), 1u);
}

TEST(CrowdCharacter, RefusesTrianglesOfVerticesThatAreNotThere) {
    const CrowdSubject subject(1);
    const osg::ref_ptr<CrowdCharacter> character = new CrowdCharacter;
    for (const GLuint beyond : {72u, 4000000000u}) {
        const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
        const osg::ref_ptr<osg::Geometry> rest =
            new osg::Geometry(*skin->getRestGeometry(), osg::CopyOp::SHALLOW_COPY);
        const GLuint last = beyond == 72u ? rest->getVertexArray()->getNumElements() : beyond;
        skin->setSkin(rest, skin->getModel());
        rest->addPrimitiveSet(triangles({0, 1, last}));
        EXPECT_THROW(character->addSkin(*skin, osg::Matrixd()), Error);
    }
    const std::size_t skin = character->addSkin(*test::makeSkin(), osg::Matrixd());
    EXPECT_EQ(skin, 0u) << "what was refused is not kept";
    subject.knob().setPrimitiveSet(0, triangles({0, 1, 2, 3}));
    EXPECT_THROW(character->addRigid(subject.knob(), nullptr, skin, "end"), Error);
    subject.knob().setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 0, 3000000));
    EXPECT_THROW(character->addRigid(subject.knob(), nullptr, skin, "end"), Error);
    EXPECT_EQ(character->parts().size(), 1u);
    EXPECT_THROW(character->addSkin(*test::makeSkin(), osg::Matrixd::scale(1, 0, 1)), Error);
    EXPECT_THROW(character->addSkin(*test::makeSkin(), osg::Matrixd::scale(1, kNaN, 1)), Error);
}

TEST(CrowdCharacter, StaysAsItIsOnceACrowdIsMadeOfIt) {
    const CrowdSubject subject(2);
    const auto character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    EXPECT_THROW(character->addClip(restSamples(2), 30.0, true), Error);
    EXPECT_THROW(character->addLevel(0.5, 0.5), Error);
    EXPECT_THROW(character->addRigid(subject.knob(), nullptr, 0, "end"), Error);
}

TEST(GpuCrowd, RefusesMembersThatItCannotShow) {
    const CrowdSubject subject(2);
    const auto character = subject.character();
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    crowd->setInstances(subject.members);
    const osg::BoundingSphere before = crowd->getBound();
    const auto refuses = [&](void (*spoil)(CrowdInstance&)) {
        std::vector<CrowdInstance> members(3, subject.members.front());
        spoil(members[2]);
        EXPECT_THROW(crowd->setInstances(members), Error);
    };
    refuses([](CrowdInstance& one) { one.clip = 3; });
    refuses([](CrowdInstance& one) { one.otherClip = 65536, one.blend = 0.5f; });
    refuses([](CrowdInstance& one) { one.blend = 1.5f; });
    refuses([](CrowdInstance& one) { one.blend = std::numeric_limits<float>::quiet_NaN(); });
    refuses([](CrowdInstance& one) { one.position.x() = 1e39; });
    refuses([](CrowdInstance& one) { one.rotation.y() = kNaN; });
    refuses([](CrowdInstance& one) { one.position.z() = -2e18; });
    refuses([](CrowdInstance& one) { one.scale = 1e38f; });
    refuses([](CrowdInstance& one) { one.rotation *= 1e10; });
    refuses([](CrowdInstance& one) { one.phase = kInf; });
    refuses([](CrowdInstance& one) { one.scale = std::numeric_limits<float>::infinity(); });
    refuses([](CrowdInstance& one) { one.colour.a() = std::numeric_limits<float>::quiet_NaN(); });
    EXPECT_EQ(crowd->getInstanceCount(), 2u);
    EXPECT_EQ(crowd->getBound(), before);
}
