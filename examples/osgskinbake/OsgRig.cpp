// SPDX-License-Identifier: MIT
#include "OsgRig.h"

#include "SceneFile.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateMorphs>
#include <osgSkinImport/ImportRig>

#include <osg/Geode>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Channel>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/FileNameUtils>

#include <cstdint>
#include <vector>

namespace bake {
namespace {

using osgSkin::ImportedRig;
using osgSkin::MeshPart;
using osgSkin::MorphTarget;

/// The geometry with its morph targets. Their weights are added to the rest, where all are 0.
osg::ref_ptr<osgAnimation::MorphGeometry> morphed(const MeshPart& part) {
    const osg::ref_ptr<osgAnimation::MorphGeometry> result =
        new osgAnimation::MorphGeometry(*part.geometry);
    result->setMethod(osgAnimation::MorphGeometry::RELATIVE);
    auto& positions = static_cast<osg::Vec3Array&>(*result->getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*result->getNormalArray());
    for (const MorphTarget& morph : part.morphs) {
        const auto count = static_cast<unsigned int>(positions.size());
        const osg::ref_ptr<osg::Vec3Array> moves = new osg::Vec3Array(count);
        const osg::ref_ptr<osg::Vec3Array> turns = new osg::Vec3Array(count);
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            const std::uint32_t v = morph.vertices[i];
            (*moves)[v] = osgSkin::toOsg(morph.positions[i]);
            if (!morph.normals.empty()) (*turns)[v] = osgSkin::toOsg(morph.normals[i]);
            positions[v] -= (*moves)[v] * morph.initial;
            normals[v] -= (*turns)[v] * morph.initial;
        }
        const osg::ref_ptr<osg::Geometry> target = new osg::Geometry;
        target->setName(morph.name);
        target->setVertexArray(moves);
        target->setNormalArray(turns, osg::Array::BIND_PER_VERTEX);
        result->addMorphTarget(target, morph.initial);
    }
    return result;
}

/// Each vertex of a part follows the bones that its mesh vertex does.
osg::ref_ptr<osgAnimation::VertexInfluenceMap> influencesOf(const ImportedRig& rig,
                                                            const MeshPart& part) {
    std::vector<std::vector<unsigned int>> copies(rig.body.mesh.positions.size());
    for (unsigned int v = 0; v < part.sourceVertex.size(); ++v)
        copies[part.sourceVertex[v]].push_back(v);
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> result =
        new osgAnimation::VertexInfluenceMap;
    for (const osgSkin::BoneWeights& bone : rig.body.weights) {
        osgAnimation::VertexInfluence influence;
        influence.setName(bone.bone);
        for (const auto& entry : bone.entries)
            for (const unsigned int v : copies[entry.vertex])
                if (entry.weight > 0.0) influence.push_back({v, float(entry.weight)});
        if (!influence.empty()) (*result)[bone.bone] = influence;
    }
    return result;
}

/// Gives the channels of morph targets' weights, which are for UpdateMorphs, to the parts'
/// osgAnimation::UpdateMorph: one for each part that has the target.
void splitMorphChannels(const ImportedRig& rig, const std::vector<std::string>& names,
                        osgAnimation::Animation& animation) {
    osgAnimation::ChannelList channels;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : animation.getChannels()) {
        if (channel->getTargetName() != osgSkin::UpdateMorphs::kName) {
            channels.push_back(channel);
            continue;
        }
        for (std::size_t p = 0; p < rig.body.parts.size(); ++p) {
            const std::vector<MorphTarget>& morphs = rig.body.parts[p].morphs;
            for (std::size_t i = 0; i < morphs.size(); ++i) {
                if (morphs[i].name != channel->getName()) continue;
                channels.emplace_back(channel->clone());
                channels.back()->setName(std::to_string(i));
                channels.back()->setTargetName(names[p]);
            }
        }
    }
    animation.getChannels() = channels;
}

} // namespace

void writeOsgRig(const std::string& glb, const std::string& file) {
    const ImportedRig rig = osgSkin::importRig(glb);
    std::vector<std::string> names; // of the parts
    for (const MeshPart& part : rig.body.parts) {
        const osg::ref_ptr<osgAnimation::RigGeometry> drawn = new osgAnimation::RigGeometry;
        osg::ref_ptr<osg::Geometry> source = part.geometry;
        if (!part.morphs.empty()) source = morphed(part);
        drawn->setSourceGeometry(source);
        drawn->setInfluenceMap(influencesOf(rig, part));
        drawn->setName(part.geometry->getName());
        const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        names.push_back("morphs " + std::to_string(names.size() + 1));
        if (!part.morphs.empty()) {
            const osg::ref_ptr<osgAnimation::UpdateMorph> update =
                new osgAnimation::UpdateMorph(names.back());
            update->addTarget(names.back());
            geode->setUpdateCallback(update);
        }
        geode->addDrawable(drawn);
        rig.skeleton->addChild(geode);
    }
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    for (const osg::ref_ptr<osgAnimation::Animation>& animation : rig.animations) {
        splitMorphChannels(rig, names, *animation);
        manager->registerAnimation(animation);
    }
    rig.skeleton->setUpdateCallback(nullptr); // osgSkin's
    rig.skeleton->setDefaultUpdateCallback();
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(rig.toWorld);
    scene->setName(osgDB::getStrippedName(file));
    scene->setUpdateCallback(manager);
    scene->addChild(rig.skeleton);
    writeScene(file, *scene);
}

} // namespace bake
