// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/ConvertRigs>

#include "scene/RigBody.h"
#include "scene/RigCollector.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinBind/MakeSkins>
#include <osgSkinBind/NonUniformScale>
#include <osgSkinBind/ShowRegions>
#include <osgSkinRig/ReadSkeleton>

#include <osg/LOD>
#include <osg/Notify>
#include <osg/Sequence>
#include <osg/Switch>
#include <osg/Transform>
#include <osgAnimation/RigGeometry>

#include <algorithm>
#include <iterator>
#include <map>

namespace osgSkin {
namespace {

using Rig = RigCollector::Rig;

std::string nameOf(const Rig& rig) {
    return "rig \"" + rig.geometry->getName() + "\"";
}

BindOptions optionsFor(const RestSkeleton& skeleton, const BindOptions& wanted) {
    BindOptions options = wanted;
    for (auto joint = options.joints.begin(); joint != options.joints.end();)
        joint = skeleton.find(joint->first) < 0 ? options.joints.erase(joint) : std::next(joint);
    return options;
}

Binding bindBody(const RigBody& body, const RestSkeleton& skeleton, const ConvertOptions& options,
                 BindReport& report) {
    const BindOptions own = optionsFor(skeleton, options.bind);
    const bool painted =
        options.ratios == ConvertOptions::Ratios::Painted ||
        (options.ratios == ConvertOptions::Ratios::Best && isWellPainted(body.weights));
    Binding binding = painted ? bindWeights(body.mesh, skeleton, body.weights, own, &report)
                              : bind(body.mesh, skeleton, own, &report);
    OSG_INFO << "osgSkin: bound by " << (painted ? "painted weights" : "regions") << "\n"
             << report.text();
    return binding;
}

/// Whether a node of the path says when what is below it is drawn.
bool isChosen(const osg::NodePath& path) {
    return std::any_of(path.begin(), path.end(), [](const osg::Node* node) {
        return node->getNodeMask() != ~0u || node->getCullCallback() != nullptr ||
               dynamic_cast<const osg::Switch*>(node) != nullptr ||
               dynamic_cast<const osg::LOD*>(node) != nullptr ||
               dynamic_cast<const osg::Sequence*>(node) != nullptr;
    });
}

/// Throws osgSkin::Error where the skin would be drawn when the rig is not: it leaves transforms.
void requireDrawnAsBefore(const Rig& rig) {
    for (const osg::NodePath& path : rig.nodePaths)
        if (isChosen(path) && !osg::computeLocalToWorld(path).isIdentity())
            throw Error(
                "it stands under a transform and a switch, a level of detail, a node mask or "
                "a cull callback");
}

/// Whether the rig stands away from its skeleton, by transforms some of which callbacks move.
bool isMovedApart(const Rig& rig) {
    return std::any_of(rig.nodePaths.begin(), rig.nodePaths.end(), [](const osg::NodePath& path) {
        const bool moves = std::any_of(path.begin(), path.end(), [](const osg::Node* node) {
            return node->asTransform() != nullptr && node->getUpdateCallback() != nullptr;
        });
        return moves && !osg::computeLocalToWorld(path).isIdentity();
    });
}

/// What an application has set on a rig that its skin does not take over, for a note; empty:
/// nothing.
std::string whatIsLost(const osgAnimation::RigGeometry& rig) {
    const auto isOwn = [](const osg::Callback* callback) {
        return dynamic_cast<const osgAnimation::UpdateRigGeometry*>(callback) != nullptr;
    };
    bool updates = false;
    for (const osg::Callback* c = rig.getUpdateCallback(); c != nullptr; c = c->getNestedCallback())
        updates = updates || !isOwn(c);
    const osg::Drawable::ComputeBoundingBoxCallback* box = rig.getComputeBoundingBoxCallback();
    std::string result = updates ? "update callback" : "";
    if (box != nullptr &&
        dynamic_cast<const osgAnimation::RigComputeBoundingBoxCallback*>(box) == nullptr)
        result += result.empty() ? "bounding box callback" : " and bounding box callback";
    return result;
}

/// Puts the skin where the rig is.
void replace(const Rig& rig, DeformableSkin& skin) {
    skin.setName(rig.geometry->getName());
    skin.setNodeMask(rig.geometry->getNodeMask());
    skin.setUserDataContainer(rig.geometry->getUserDataContainer());
    skin.setCullCallback(rig.geometry->getCullCallback());
    skin.setEventCallback(rig.geometry->getEventCallback());
    skin.setCullingActive(rig.geometry->getCullingActive());
    if (rig.geometry->getDrawCallback()) skin.setDrawCallback(rig.geometry->getDrawCallback());
    const osg::ref_ptr<osg::Node> keep = rig.geometry;
    for (const osg::NodePath& path : rig.nodePaths) {
        osg::Group* parent = path.empty() ? rig.skeleton : path.back()->asGroup();
        if (osg::computeLocalToWorld(path).isIdentity()) {
            parent->replaceChild(rig.geometry, &skin);
            continue;
        }
        parent->removeChild(rig.geometry);
        // Its space is the skeleton's now: what the path sets beside transforms comes along.
        osg::ref_ptr<osg::StateSet> state;
        for (const osg::Node* node : path) {
            if (node->getStateSet() == nullptr) continue;
            if (!state) state = new osg::StateSet;
            state->merge(*node->getStateSet());
        }
        osg::Group* holder = rig.skeleton;
        if (state) {
            const osg::ref_ptr<osg::Group> group = new osg::Group;
            group->setStateSet(state);
            rig.skeleton->addChild(group);
            holder = group;
        }
        if (!holder->containsNode(&skin)) holder->addChild(&skin);
    }
}

void convertSkeleton(osgAnimation::Skeleton& skeleton, const std::vector<const Rig*>& rigs,
                     const ConvertOptions& options, ConvertReport& report) {
    ConvertedBody made;
    made.skeleton = &skeleton;
    made.rest = readSkeleton(skeleton);
    RigBody body;
    std::vector<const Rig*> taken;
    for (const Rig* rig : rigs) {
        try {
            requireDrawnAsBefore(*rig);
            body.add(*rig->geometry, osg::computeLocalToWorld(rig->nodePaths.front()), made.rest);
            taken.push_back(rig);
        } catch (const Error& error) {
            report.notes.push_back(nameOf(*rig) + " is left as it is: " + error.what());
        }
    }
    if (taken.empty()) return;
    made.binding = bindBody(body, made.rest, options, made.report);
    if (options.showRegions) showRegions(body.parts, made.binding);
    RigidSplit whole;
    whole.faceJoint.assign(body.mesh.faceSizes.size(), RigidSplit::kSkin);
    made.skins = makeSkins(body.mesh, body.parts, made.binding, whole).skins;
    for (std::size_t i = 0; i < taken.size(); ++i) {
        DeformableSkin& skin = *made.skins[i].drawable;
        const std::string lost = whatIsLost(*taken[i]->geometry);
        if (!lost.empty()) report.notes.push_back(nameOf(*taken[i]) + " loses its own " + lost);
        if (isMovedApart(*taken[i]))
            report.notes.push_back(nameOf(*taken[i]) + " stands where its transforms are now, "
                                                       "which callbacks may move: it does not "
                                                       "follow them");
        replace(*taken[i], skin);
        report.skins.push_back(&skin);
    }
    made.mesh = std::move(body.mesh);
    made.parts = std::move(body.parts);
    report.bodies.push_back(std::move(made));
}

void noteNonUniformScale(osgAnimation::Skeleton& skeleton, const osgAnimation::AnimationList& clips,
                         ConvertReport& report) {
    const std::vector<std::string> bones = findNonUniformScale(skeleton, clips);
    if (bones.empty()) return;
    std::string note = "skeleton \"" + skeleton.getName() + "\": " + bones.front();
    if (bones.size() > 1) note += " and " + std::to_string(bones.size() - 1) + " more";
    report.notes.push_back(
        note + " scaled non-uniformly, mirrored or to nothing, which skins do not follow");
}

} // namespace

ConvertReport convertRigs(osg::Node& scene, const ConvertOptions& options) {
    RigCollector collector;
    collector.lookAbove(scene);
    scene.accept(collector);
    ConvertReport report;
    std::vector<osgAnimation::Skeleton*> skeletons; // in the scene's order
    std::map<osgAnimation::Skeleton*, std::vector<const Rig*>> rigs;
    for (const Rig& rig : collector.rigs) {
        if (rig.skeleton == nullptr || rig.severalSkeletons) {
            report.notes.push_back(nameOf(rig) + " is left as it is: it stands under " +
                                   (rig.skeleton == nullptr ? "no skeleton" : "several skeletons"));
            continue;
        }
        if (rigs[rig.skeleton].empty()) skeletons.push_back(rig.skeleton);
        rigs[rig.skeleton].push_back(&rig);
    }
    double done = 0.0;
    const double each = 1.0 / std::max(1.0, double(skeletons.size()));
    for (osgAnimation::Skeleton* skeleton : skeletons) {
        ConvertOptions own = options;
        own.bind.progress = subProgress(options.bind.progress, done, done + each);
        done += each;
        try {
            const std::size_t before = report.skins.size();
            convertSkeleton(*skeleton, rigs[skeleton], own, report);
            if (report.skins.size() > before)
                noteNonUniformScale(*skeleton, collector.clips, report);
        } catch (const Error& error) {
            for (const Rig* rig : rigs[skeleton])
                report.notes.push_back(nameOf(*rig) + " is left as it is: " + error.what());
        }
    }
    for (const std::string& note : report.notes)
        OSG_NOTICE << "osgSkin: " << onOneLine(note) << std::endl;
    return report;
}

} // namespace osgSkin
