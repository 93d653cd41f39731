// SPDX-License-Identifier: MIT
#include "Crowd.h"

#include <osgSkin/ParallelDeformCallback>

#include <osg/MatrixTransform>
#include <osg/Timer>

#include <algorithm>
#include <cmath>

Crowd::Crowd(const std::vector<SampledCharacter>& characters, std::size_t count,
             osgSkin::DeformPool* pool)
    : _scene(new osg::Group), _pool(pool) {
    float width = 0.0f;
    for (const SampledCharacter& c : characters)
        width = std::max({width, c.box.xMax() - c.box.xMin(), c.box.yMax() - c.box.yMin()});
    width *= 0.7f; // they may reach between each other
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    _radius = 0.5f * width * static_cast<float>(side);
    std::size_t phase = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // Rows stand half a place apart, and phases differ from one neighbour to the next.
        const std::size_t line = i / side;
        const double row = static_cast<double>(line);
        const double column = static_cast<double>(i % side) + (line % 2 == 0 ? 0.0 : 0.5);
        const osg::Matrix transform = osg::Matrix::translate(
            static_cast<double>(width) * (column - 0.5 * static_cast<double>(side)),
            static_cast<double>(width) * (row - 0.5 * static_cast<double>(side)), 0.0);
        _members.push_back(makeMember(characters[i % characters.size()], transform, phase));
        phase += 37;
    }
    _scene->setUpdateCallback(this);
    // Nested in ours, which it therefore follows.
    _scene->addUpdateCallback(new osgSkin::ParallelDeformCallback(pool));
}

Crowd::Member Crowd::makeMember(const SampledCharacter& character, const osg::Matrix& transform,
                                std::size_t phase) {
    Member member{&character, phase, {}, {}};
    const osg::ref_ptr<osg::MatrixTransform> stand = new osg::MatrixTransform(transform);
    for (const SampledCharacter::Skin& source : character.skins) {
        const osg::ref_ptr<osgSkin::DeformableSkin> skin =
            osg::clone(source.skin.get(), osg::CopyOp::SHALLOW_COPY);
        skin->setUpdateCallback(nullptr); // the crowd sets its pose
        const osg::ref_ptr<osg::MatrixTransform> upright =
            new osg::MatrixTransform(source.toCharacter);
        upright->addChild(skin);
        stand->addChild(upright);
        member.skins.push_back(skin);
        _vertices += skin->getModel()->vertexCount();
    }
    for (const SampledCharacter::Rigid& source : character.rigids) {
        const osg::ref_ptr<osg::MatrixTransform> rigid = new osg::MatrixTransform;
        for (const osg::ref_ptr<osg::Node>& part : source.parts) rigid->addChild(part);
        stand->addChild(rigid);
        member.rigids.push_back(rigid);
    }
    _scene->addChild(stand);
    return member;
}

void Crowd::pose(const Member& member, double time) {
    const SampledCharacter& character = *member.character;
    const auto now =
        static_cast<std::size_t>(std::max(0.0, time) * SampledCharacter::kSamplesPerSecond);
    const std::size_t sample = (now + member.phase) % character.sampleCount;
    for (std::size_t i = 0; i < member.skins.size(); ++i) {
        const std::vector<glm::dmat4>& skinning = character.skins[i].samples[sample];
        member.skins[i]->setPose(skinning.data(), skinning.size());
    }
    for (std::size_t i = 0; i < member.rigids.size(); ++i)
        member.rigids[i]->setMatrix(character.rigids[i].samples[sample]);
}

void Crowd::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    const double time = nv && nv->getFrameStamp() ? nv->getFrameStamp()->getSimulationTime() : 0.0;
    const osg::Timer_t start = osg::Timer::instance()->tick();
    // What the members have in common is marked here; each thread then marks only what is its
    // member's own.
    _scene->dirtyBound();
    _pool->forEach(_members.size(), [&](std::size_t i) { pose(_members[i], time); });
    const osg::Timer_t posed = osg::Timer::instance()->tick();
    traverse(node, nv);
    const osg::Timer_t end = osg::Timer::instance()->tick();
    if (time != _time) _poseTime = _deformTime = 0.0;
    _time = time;
    _poseTime += osg::Timer::instance()->delta_m(start, posed);
    _deformTime += osg::Timer::instance()->delta_m(posed, end);
}
