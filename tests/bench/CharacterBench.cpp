// SPDX-License-Identifier: MIT
#include "CharacterBench.h"

#include "OsgRig.h"

#include <osgSkin/DeformJob>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinRig/ClipCharacter>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include <osg/Group>
#include <osgAnimation/BasicAnimationManager>
#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <memory>
#include <vector>

namespace bench {
namespace {

constexpr unsigned int kInScene = 20;
constexpr double kPhase = 0.37; // seconds from one to the next

osg::ref_ptr<osgSkin::DeformableSkin>
makeSkin(const Body& body, const osg::ref_ptr<const osgSkin::SkinModel>& model) {
    const auto array = [](const std::vector<glm::vec3>& vectors) {
        const osg::ref_ptr<osg::Vec3Array> result = new osg::Vec3Array(
            osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(vectors.size()));
        std::copy(vectors.begin(), vectors.end(), osgSkin::asGlm(result->asVector().data()));
        return result;
    };
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(array(body.positions));
    geometry->setNormalArray(array(body.normals));
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, static_cast<unsigned int>(body.triangles.size()), body.triangles.data()));
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(geometry, model);
    return skin;
}

/// Below a manager that plays the body's clip.
osg::ref_ptr<osg::Group> animated(const Body& body, osg::Node* skeleton, double phase) {
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(skeleton);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    const osg::ref_ptr<osgAnimation::Animation> animation =
        osgSkin::makeAnimation(body.clip, body.rig);
    animation->setStartTime(-phase);
    manager->registerAnimation(animation);
    group->setUpdateCallback(manager);
    manager->buildTargetReference();
    manager->playAnimation(animation);
    return group;
}

osg::ref_ptr<osg::Group>
ownCharacter(const Body& body, const osg::ref_ptr<const osgSkin::SkinModel>& model, double phase) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(body.rig);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = makeSkin(body, model);
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    skeleton->addChild(skin);
    return animated(body, skeleton, phase);
}

/// A scene and its frames.
class Scene {
public:
    Scene(Player player, Kind kind) {
        const Body& body = bench::body(1, kind);
        const auto model = body.model();
        osg::ref_ptr<osgSkin::ClipCharacter> copies;
        osg::ref_ptr<const osgSkin::SampledClip> clip;
        if (player == Player::Baked || player == Player::Between || player == Player::Sampled) {
            const osg::ref_ptr<osg::Group> character = ownCharacter(body, model, 0.0);
            copies = osgSkin::ClipCharacter::create(*character);
            clip = copies->sample(*copies->animations().front());
            if (player != Player::Sampled) copies->bake(clip);
        }
        for (unsigned int i = 0; i < kInScene; ++i) {
            const double phase = kPhase * i;
            if (copies) {
                const auto copy = copies->makeInstance();
                copy.player->setInterpolated(player != Player::Baked);
                copy.player->setTrack(0, {clip, phase});
                _scene->addChild(copy.node);
            } else if (player == Player::Skeleton) {
                _scene->addChild(ownCharacter(body, model, phase));
            } else {
                _rigs.push_back(std::make_unique<OsgRig>(body));
                _scene->addChild(animated(body, _rigs.back()->skeleton(), phase));
            }
        }
        _update->setFrameStamp(_stamp);
        _cull->setFrameStamp(_stamp);
        for (int i = 0; i < 3; ++i) frame(); // which still make things
    }

    void frame() {
        _stamp->setFrameNumber(++_frame);
        _stamp->setSimulationTime(_frame / 60.0);
        _update->setTraversalNumber(_frame);
        _scene->accept(*_update);
        const osg::BoundingSphere bound = _scene->getBound();
        const double r = 1.2 * static_cast<double>(bound.radius());
        _graph->clean();
        _stage->reset();
        _cull->reset();
        _cull->setTraversalNumber(_frame);
        _cull->setStateGraph(_graph);
        _cull->setRenderStage(_stage);
        _cull->pushViewport(_viewport);
        _cull->pushProjectionMatrix(
            new osg::RefMatrix(osg::Matrix::ortho(-r, r, -r, r, 0.0, 4 * r)));
        const osg::Vec3d centre = bound.center();
        const osg::ref_ptr<osg::RefMatrix> view = new osg::RefMatrix(osg::Matrix::lookAt(
            centre + osg::Vec3d(0.0, 0.0, 2.0 * r), centre, osg::Vec3d(0.0, 1.0, 0.0)));
        _cull->pushModelViewMatrix(view, osg::Transform::ABSOLUTE_RF);
        _scene->accept(*_cull);
        _cull->popModelViewMatrix();
        _cull->popProjectionMatrix();
        _cull->popViewport();
    }

private:
    osg::ref_ptr<osg::Group> _scene = new osg::Group;
    std::vector<std::unique_ptr<OsgRig>> _rigs;
    osg::ref_ptr<osg::FrameStamp> _stamp = new osg::FrameStamp;
    osg::ref_ptr<osgUtil::UpdateVisitor> _update = new osgUtil::UpdateVisitor;
    osg::ref_ptr<osgUtil::CullVisitor> _cull = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> _graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> _stage = new osgUtil::RenderStage;
    osg::ref_ptr<osg::Viewport> _viewport = new osg::Viewport(0, 0, 1000, 800);
    unsigned int _frame = 0;
};

} // namespace

void characters(benchmark::State& state, Player player, Kind kind) {
    Scene scene(player, kind);
    for ([[maybe_unused]] auto iteration : state) scene.frame();
    state.counters["vertices"] =
        static_cast<double>(kInScene) * static_cast<double>(bench::body(1).positions.size());
}

void deformationAlone(benchmark::State& state, Kind kind) {
    const Body& body = bench::body(1, kind);
    const auto model = body.model();
    // Each frame of the clip, since no character stands still.
    std::vector<osgSkin::Pose> poses(body.skinning.size(), osgSkin::Pose(model->joints()));
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i].set(body.skinning[i].data(), body.skinning[i].size());
    // Two buffers each, in turn, as a DeformableSkin has.
    std::vector<std::vector<glm::vec3>> outputs(std::size_t{2} * kInScene);
    for (auto& output : outputs) output.resize(2 * model->vertexCount());
    std::size_t frame = 0;
    osgSkin::DeformJob job;
    job.model = model.get();
    job.positionCount = job.normalCount = model->vertexCount();
    for ([[maybe_unused]] auto iteration : state) {
        ++frame;
        for (std::size_t i = 0; i < kInScene; ++i) {
            job.pose = &poses[(37 * i + frame) % poses.size()];
            job.positions = outputs[2 * i + frame % 2].data();
            job.normals = job.positions + model->vertexCount();
            job.run();
        }
    }
    state.counters["vertices"] =
        static_cast<double>(kInScene) * static_cast<double>(model->vertexCount());
}

} // namespace bench
