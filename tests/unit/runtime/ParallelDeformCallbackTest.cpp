// SPDX-License-Identifier: MIT
#include "TubeSkin.h"

#include <osgSkin/ParallelDeformCallback>

#include <gtest/gtest.h>
#include <osg/Group>
#include <osgUtil/UpdateVisitor>

#include <vector>

using osgSkin::DeformableSkin;
using osgSkin::ParallelDeformCallback;

namespace {

/// Some skins below a group; bones are not needed, because the test sets the poses.
struct SkinsBelow {
    explicit SkinsBelow(unsigned int count) {
        for (unsigned int i = 0; i < count; ++i) {
            skins.push_back(test::makeSkin());
            const osg::ref_ptr<osg::Group> between = new osg::Group;
            between->addChild(skins.back());
            group->addChild(between);
        }
        together->getPool()->setMinimumVertices(0);
        group->setUpdateCallback(together);
    }
    void update() {
        osgUtil::UpdateVisitor visitor;
        visitor.setTraversalNumber(++frame);
        group->accept(visitor);
    }
    void bendAll(double angle) {
        for (const auto& skin : skins) test::bend(*skin, angle);
    }

    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<ParallelDeformCallback> together =
        new ParallelDeformCallback(osg::ref_ptr<osgSkin::DeformPool>(new osgSkin::DeformPool(2)));
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    unsigned int frame = 0;
};

} // namespace

TEST(ParallelDeformCallback, DeformsSkinsThatWereVisible) {
    SkinsBelow crowd(5);
    crowd.bendAll(0.1);
    crowd.update();
    for (const auto& skin : crowd.skins) EXPECT_EQ(skin->getDeformCount(), 0u); // not in view yet
    test::cull(*crowd.skins[1], true);
    test::cull(*crowd.skins[3], true);
    EXPECT_EQ(crowd.skins[1]->getDeformCount(), 1u);

    crowd.bendAll(0.2);
    crowd.update();
    for (unsigned int i = 0; i < crowd.skins.size(); ++i) {
        EXPECT_EQ(crowd.skins[i]->needsDeform(), i != 1 && i != 3) << i;
        EXPECT_EQ(crowd.skins[i]->getDeformCount(), i == 1 || i == 3 ? 2u : 0u) << i;
    }
    // Out of view now: the deformed vertices are not used, so the next pose is not deformed.
    crowd.bendAll(0.3);
    crowd.update();
    EXPECT_EQ(crowd.skins[1]->getDeformCount(), 2u);
    test::cull(*crowd.skins[1], true);
    EXPECT_EQ(crowd.skins[1]->getDeformCount(), 3u);
}

/// Scenes may have thousands of nodes: the search for skins runs only when the scene changes.
TEST(ParallelDeformCallback, SearchesOnlyWhenTheSceneChanges) {
    struct Counted : osg::Group {
        void traverse(osg::NodeVisitor& nv) override {
            if (nv.getVisitorType() != osg::NodeVisitor::UPDATE_VISITOR) ++looks;
            osg::Group::traverse(nv);
        }
        int looks = 0;
    };
    SkinsBelow crowd(3);
    const osg::ref_ptr<Counted> counted = new Counted;
    crowd.group->addChild(counted);
    for (int frame = 0; frame < 10; ++frame) crowd.update();
    EXPECT_EQ(counted->looks, 1);
    crowd.group->removeChild(0, 1);
    crowd.update();
    crowd.update();
    EXPECT_EQ(counted->looks, 2);
}

TEST(ParallelDeformCallback, CanDeformHiddenSkins) {
    SkinsBelow crowd(5);
    crowd.together->setOnlySeen(false);
    crowd.bendAll(0.1);
    crowd.update();
    const osg::ref_ptr<DeformableSkin> alone = test::makeSkin();
    test::bend(*alone, 0.1);
    for (const auto& skin : crowd.skins) {
        EXPECT_EQ(skin->getDeformCount(), 1u);
        EXPECT_EQ(test::verticesOf(*skin), test::verticesOf(*alone));
    }
}

TEST(ParallelDeformCallback, TracksAddedAndRemovedSkins) {
    SkinsBelow crowd(2);
    crowd.together->setOnlySeen(false);
    crowd.update();
    const osg::ref_ptr<DeformableSkin> late = test::makeSkin(), deep = test::makeSkin();
    crowd.group->addChild(late);
    crowd.update();
    EXPECT_EQ(late->getDeformCount(), 1u);

    crowd.group->getChild(0)->asGroup()->addChild(deep);
    crowd.together->dirty();
    crowd.update();
    EXPECT_EQ(deep->getDeformCount(), 1u);

    crowd.group->getChild(0)->asGroup()->removeChild(deep);
    crowd.update();
    crowd.update();
    EXPECT_EQ(deep->referenceCount(), 1);
}

TEST(ParallelDeformCallback, DeformsASkinWithTwoParentsOnce) {
    SkinsBelow crowd(1);
    crowd.together->setOnlySeen(false);
    crowd.group->addChild(crowd.skins[0]);
    crowd.update();
    EXPECT_EQ(crowd.skins[0]->getDeformCount(), 1u);
}
