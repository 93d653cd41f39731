// SPDX-License-Identifier: MIT
#include <osgSkinMotion/ClipCharacter>

#include "clips/BakedClip.h"
#include "players/FigureClips.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>
#include <osgSkin/RigidPart>
#include <osgSkinMotion/SpringBones>

#include <glm/common.hpp>
#include <osg/LOD>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/Switch>
#include <osgAnimation/Bone>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// A skin at one time.
struct SkinMoment {
    Pose pose;
    std::vector<glm::vec3> positions; ///< of all vertices
};

constexpr std::size_t kIntervalParts = BakedClip::kParts;
constexpr double kHalfTurn = 2.9;       ///< radians, nearly
constexpr double kTwistJump = 1.0;      ///< of a twist, radians in a step
constexpr float kSweepMargin = 0.25f;   ///< of a second difference: twice an eighth
constexpr float kSweepRounding = 1e-5f; ///< of a coordinate

using Moments = std::array<SkinMoment, kIntervalParts + 1>;

/// Whether all splits change continuously. The root's does not count: no vertex follows it in part.
bool isSmooth(const Moments& moments) {
    for (std::size_t j = 1; j < moments.front().pose.size(); ++j) {
        double before = moments.front().pose.transform(j).split.twistAngle;
        for (const SkinMoment& moment : moments) {
            const BendTwist split = moment.pose.transform(j).split;
            if (split.bendAngle > kHalfTurn || std::abs(split.twistAngle) > kHalfTurn ||
                std::abs(split.twistAngle - before) > kTwistJump)
                return false;
            before = split.twistAngle;
        }
    }
    return true;
}

/// How far a vertex may be from the lines between its positions.
glm::vec3 marginOf(const Moments& moments, std::size_t vertex) {
    glm::vec3 most(0.0f);
    for (std::size_t k = 1; k < kIntervalParts; ++k)
        most = glm::max(most, glm::abs(moments[k - 1].positions[vertex] -
                                       2.0f * moments[k].positions[vertex] +
                                       moments[k + 1].positions[vertex]));
    return kSweepMargin * most + kSweepRounding * glm::abs(moments[0].positions[vertex]);
}

/// Adds boxes that hold a skin between one sample and the next, one for each part of the interval.
///
/// Within a part, a vertex leaves the straight line between the part's ends by an eighth of its
/// second derivative at most, which second differences estimate; twice that is added to the box.
/// The estimate fails where the path is not smooth: near half a turn a joint's bend axis or twist
/// may jump. Then the boxes are invalid.
///
/// \param moments at even steps, both ends included
/// \param boxes gets one for each part
void sweptBounds(const Moments& moments, std::vector<osg::BoundingBox>& boxes) {
    std::array<osg::BoundingBox, kIntervalParts> sweeps;
    const std::size_t vertices =
        isSmooth(moments) ? moments.front().positions.size() : std::size_t{0};
    for (std::size_t v = 0; v < vertices; ++v) {
        const glm::vec3 margin = marginOf(moments, v);
        for (std::size_t k = 0; k < kIntervalParts; ++k)
            for (const std::size_t end : {k, k + 1}) {
                const glm::vec3& p = moments[end].positions[v];
                const glm::vec3 low = p - margin, high = p + margin;
                sweeps[k].expandBy(low.x, low.y, low.z);
                sweeps[k].expandBy(high.x, high.y, high.z);
            }
    }
    boxes.insert(boxes.end(), sweeps.begin(), sweeps.end());
}

osgAnimation::Bone* boneAbove(const osg::NodePath& path, osg::NodePath* below = nullptr) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(*node)) {
            if (below) below->assign(node.base(), path.end());
            return bone;
        }
    return nullptr;
}

/// Finds skins and rigid parts below a node, and what else hangs on bones.
class CharacterParts : public osg::NodeVisitor {
public:
    CharacterParts() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override {
        if (dynamic_cast<RigidPart*>(&node))
            rigids.push_back(getNodePath());
        else
            traverse(node);
    }
    void apply(osg::Drawable& drawable) override {
        if (dynamic_cast<DeformableSkin*>(&drawable))
            skins.push_back(getNodePath());
        else if (boneAbove(getNodePath()))
            hung.push_back(getNodePath());
    }

    std::vector<osg::NodePath> skins, rigids, hung;
};

/// The path up to the nearest skeleton; empty where there is none.
osg::NodePath toSkeleton(osg::NodePath path) {
    while (!path.empty() && !dynamic_cast<osgAnimation::Skeleton*>(path.back())) path.pop_back();
    return path;
}

/// The name of the bone that a rigid part moves with; empty where there is none.
std::string boneOf(const osg::NodePath& path) {
    osg::NodePath below;
    const osgAnimation::Bone* bone = boneAbove(path, &below);
    if (!bone) return {};
    below.pop_back();
    if (!osg::computeLocalToWorld(below).isIdentity())
        throw Error("clip character: there is a transform between the rigid part \"" +
                    path.back()->getName() + "\" and its bone \"" + bone->getName() + "\"");
    return bone->getName();
}

/// The transform of a copy's rigid part. A cull tests its sphere in the parent's space: a matrix
/// and a frustum of its own, as transforms push them, cost more than all else of the part.
class RigidCopy : public osg::MatrixTransform {
public:
    /// \param parts in rest space
    /// \param matrix from rest space to the parent's
    RigidCopy(const std::vector<osg::ref_ptr<osg::Node>>& parts, const osg::Matrixd& matrix)
        : osg::MatrixTransform(matrix) {
        setDataVariance(osg::Object::DYNAMIC);
        for (const osg::ref_ptr<osg::Node>& part : parts) addChild(part);
    }

    void accept(osg::NodeVisitor& nv) override {
        osgUtil::CullVisitor* cv = nv.asCullVisitor();
        if (!cv || !isPlainFor(*cv)) {
            osg::MatrixTransform::accept(nv);
            return;
        }
        const osg::BoundingSphere& sphere = getBound();
        if (!nv.validNodeMask(*this) || (isCullingActive() && cv->isCulled(sphere))) return;
        const osg::Matrixd& above = *cv->getModelViewMatrix();
        const double distance = -(osg::Vec3d(sphere.center()) * above).z();
        if (!addToNearAndFar(*cv, distance, double(sphere.radius()))) return;
        osg::RefMatrix* matrix = (cv->*&Matrices::createOrReuseMatrix)(getMatrix() * above);
        if (getStateSet()) cv->pushStateSet(getStateSet());
        for (const auto& child : _children) {
            if (!nv.validNodeMask(*child)) continue;
            if (child->getStateSet()) cv->pushStateSet(child->getStateSet());
            cv->addDrawableAndDepth(child->asDrawable(), matrix, static_cast<float>(distance));
            if (child->getStateSet()) cv->popStateSet();
        }
        if (getStateSet()) cv->popStateSet();
    }

private:
    /// Opens the visitor's pool of matrices, which keeps them until they are drawn.
    struct Matrices : osgUtil::CullVisitor {
        using osgUtil::CullVisitor::createOrReuseMatrix;
    };

    /// Whether nothing here needs the traversal of transforms and drawables.
    bool isPlainFor(const osgUtil::CullVisitor& cv) const {
        return !getCullCallback() && getReferenceFrame() == RELATIVE_RF &&
               cv.getComputeNearFarMode() <=
                   osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES &&
               std::all_of(_children.begin(), _children.end(), [](const auto& child) {
                   return child->asGeometry() && !child->getCullCallback();
               });
    }

    /// \return false where the sphere is behind the eye
    static bool addToNearAndFar(osgUtil::CullVisitor& cv, double distance, double radius) {
        if (cv.getComputeNearFarMode() == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR) return true;
        const double size = radius * double(cv.getLookVectorLocal().length());
        if (distance + size < 0.0) return false;
        cv.setCalculatedNearPlane(std::min(cv.getCalculatedNearPlane(), distance - size));
        cv.setCalculatedFarPlane(std::max(cv.getCalculatedFarPlane(), distance + size));
        return true;
    }
};

/// The node of a copy. A crowd's nodes have left the caches when a cull visits them: it asks for
/// all of a member's nodes at once, instead of waiting for one after the other.
class CopyRoot : public osg::MatrixTransform {
public:
    /// Adds a part of the figure.
    ///
    /// \param skin below it; null: none
    void addPart(osg::MatrixTransform& part, const DeformableSkin* skin) {
        addChild(&part);
        remember(&part, sizeof(RigidCopy));
        if (skin) remember(skin, sizeof(DeformableSkin));
    }

    void traverse(osg::NodeVisitor& nv) override {
        if (nv.getVisitorType() == osg::NodeVisitor::CULL_VISITOR)
            for (const char* line : _lines) prefetch(line);
        osg::MatrixTransform::traverse(nv);
    }

private:
    static constexpr std::size_t kLine = 64;

    void remember(const void* node, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; i += kLine)
            _lines.push_back(static_cast<const char*>(node) + i);
    }
    static void prefetch([[maybe_unused]] const char* line) {
#if defined(__GNUC__)
        __builtin_prefetch(line);
#endif
    }

    std::vector<const char*> _lines; ///< of the parts' memory, never read
};

SkinMoment momentOf(const DeformableSkin& skin) {
    return {skin.getPose(), deform(*skin.getModel(), skin.getPose()).positions};
}

osg::BoundingBox boundsOf(const SkinMoment& moment) {
    osg::BoundingBox box;
    for (const glm::vec3& p : moment.positions) box.expandBy(p.x, p.y, p.z);
    return box;
}

} // namespace

ClipCharacter::ClipCharacter() = default;
ClipCharacter::~ClipCharacter() = default;

ClipCharacter::Appearance ClipCharacter::appearanceOf(const osg::NodePath& path) {
    Appearance result;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const osg::Node& node = *path[i];
        if (dynamic_cast<const DeformableSkin*>(&node))
            break; // the skin's copies keep its own state
        result.mask &= node.getNodeMask();
        if (i + 1 < path.size()) {
            const auto* choice = dynamic_cast<const osg::Switch*>(&node);
            if (choice && !choice->getChildValue(path[i + 1])) result.mask = 0;
            if (dynamic_cast<const osg::LOD*>(&node))
                OSG_NOTICE << onOneLine("osgSkin: clip character: \"" + path.back()->getName() +
                                        "\" is drawn at all distances, not by its level of detail")
                           << std::endl;
        }
        if (!node.getStateSet()) continue;
        if (!result.state) result.state = new osg::StateSet;
        result.state->merge(*node.getStateSet());
    }
    return result;
}

osg::ref_ptr<ClipCharacter> ClipCharacter::create(osg::Node& character) {
    CharacterParts found;
    character.accept(found);
    const osg::ref_ptr<ClipCharacter> result = new ClipCharacter;
    result->_character = &character;
    result->_animations = animationsOf(character);
    for (const osg::NodePath& path : found.skins) {
        auto* skin = static_cast<DeformableSkin*>(path.back());
        if (!skin->getModel()) continue;
        const osg::NodePath above = toSkeleton(path);
        if (above.empty() || (result->_skeleton && result->_skeleton != above.back()))
            throw Error("clip character: the skin \"" + skin->getName() +
                        "\" is not below the character's skeleton");
        result->_skeleton = static_cast<osgAnimation::Skeleton*>(above.back());
        result->_toWorld = osg::computeLocalToWorld(above);
        result->_skins.push_back({skin, osg::computeLocalToWorld(path), appearanceOf(path)});
    }
    if (result->_skins.empty())
        throw Error("clip character: no skin below \"" + character.getName() +
                    "\", expected a DeformableSkin");
    for (const osg::NodePath& path : found.rigids) {
        osg::Group& part = *path.back()->asGroup();
        Rigid rigid{{}, part.getName(), appearanceOf(path)};
        rigid.joint = boneOf(path);
        for (unsigned int i = 0; i < part.getNumChildren(); ++i)
            rigid.parts.emplace_back(part.getChild(i));
        result->_rigids.push_back(rigid);
    }
    for (const osg::NodePath& path : found.hung) {
        osg::NodePath below;
        const osgAnimation::Bone& bone = *boneAbove(path, &below);
        const osg::ref_ptr<osg::MatrixTransform> toRest =
            new osg::MatrixTransform(osg::computeLocalToWorld(below) *
                                     osg::Matrixd::inverse(bone.getInvBindMatrixInSkeletonSpace()));
        toRest->addChild(path.back());
        result->_rigids.push_back({{toRest}, bone.getName(), appearanceOf(path)});
    }
    return result;
}

osg::ref_ptr<const SampledClip> ClipCharacter::clip(const std::string& name) {
    osg::ref_ptr<const SampledClip>& sampled = _clips[name];
    if (!sampled) sampled = sampleNamed(name, _animations, *_skeleton, "clip character: ");
    return sampled;
}

osg::ref_ptr<const SampledClip> ClipCharacter::sample(const osgAnimation::Animation& animation,
                                                      double samplesPerSecond) const {
    return sampleOf(animation, *_skeleton, samplesPerSecond);
}

void ClipCharacter::bake(const SampledClip* clip) {
    if (!clip) throw Error("clip character: no clip to bake");
    for (const Skin& skin : _skins)
        for (const std::string& input : skin.skin->getModel()->inputs())
            if (skin.skin->getActivation(input) != 0.0f)
                throw Error("clip character: the skin \"" + skin.skin->getName() +
                            "\" has an activation, expected none in what is baked");
    const Instance model = makeInstance(false);
    ClipPlayer& player = *model.player;
    const osg::ref_ptr<BakedClip> baked = new BakedClip;
    baked->clip = clip;
    baked->skins.resize(_skins.size());
    baked->rigids.resize(_rigids.size());
    for (std::size_t i = 0; i < _skins.size(); ++i)
        baked->skins[i].model = _skins[i].skin->getModel();
    player._baked.clear();
    // Twists are continuous from the first sample on.
    const auto poseAt = [&](double samples) {
        player.setLayer(0, {clip, samples * clip->step(), 0.0, true});
        if (!player.poseAs(samples == 0.0 ? Pose::Twist::Shortest : Pose::Twist::Continued))
            throw Error("clip character: the clip \"" + clip->name() + "\" cannot pose its skins");
    };
    constexpr std::size_t parts = BakedClip::kParts;
    std::vector<std::array<SkinMoment, parts + 1>> moments(_skins.size());
    const auto record = [&](std::size_t k) {
        for (std::size_t i = 0; i < _skins.size(); ++i)
            moments[i][k] = momentOf(*player._skins[i].skin);
    };
    osg::BoundingBox bounds = _bakedBounds;
    poseAt(0.0);
    record(parts);
    for (std::size_t sample = 0; sample < clip->sampleCount(); ++sample) {
        for (std::size_t i = 0; i < _rigids.size(); ++i)
            baked->rigids[i].push_back(player._rigids[i].transform->getMatrix());
        for (auto& skin : moments) std::swap(skin.front(), skin.back()); // the last interval's end
        for (std::size_t k = 1; k <= parts; ++k) { // up to the next sample, or the first one again
            poseAt(double(sample) + double(k) / double(parts));
            record(k);
        }
        for (std::size_t i = 0; i < _skins.size(); ++i) {
            BakedClip::Skin& skin = baked->skins[i];
            skin.poses.push_back(moments[i].front().pose);
            skin.bounds.push_back(boundsOf(moments[i].front()));
            sweptBounds(moments[i], skin.sweeps);
            const osg::BoundingBox& box = skin.bounds.back();
            for (unsigned int corner = 0; corner < 8; ++corner)
                bounds.expandBy(box.corner(corner) * _skins[i].toWorld);
        }
    }
    _baked.push_back(baked);
    _bakedBounds = bounds;
}

ClipCharacter::Instance ClipCharacter::makeInstance(bool updates) const {
    if (!std::exchange(_hasNoticed, true) && find<SpringBones>(*_character))
        OSG_NOTICE << "osgSkin: clip character: springs do not swing in copies without bones"
                   << std::endl;
    const osg::ref_ptr<CopyRoot> root = new CopyRoot;
    Instance result{root, new ClipPlayer};
    result.node->setName(_character->getName());
    for (const Skin& source : _skins) {
        const osg::ref_ptr<DeformableSkin> skin =
            osg::clone(source.skin.get(), osg::CopyOp::SHALLOW_COPY);
        skin->setUpdateCallback(nullptr); // the player sets its pose
        const std::vector<glm::dmat4> rest(skin->getModel()->joints().size(), glm::dmat4(1.0));
        skin->setPose(rest.data(), rest.size());
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(source.toWorld);
        place->setStateSet(source.appearance.state);
        place->setNodeMask(source.appearance.mask);
        place->addChild(skin);
        root->addPart(*place, skin);
        result.player->addSkin(skin);
    }
    for (const Rigid& source : _rigids) {
        std::vector<osg::ref_ptr<osg::Node>> parts = source.parts;
        for (osg::ref_ptr<osg::Node>& part : parts)
            if (const auto* skin = dynamic_cast<const DeformableSkin*>(part.get()))
                part = osg::clone(skin, osg::CopyOp::SHALLOW_COPY);
        const osg::ref_ptr<osg::MatrixTransform> rigid = new RigidCopy(parts, _toWorld);
        rigid->setStateSet(source.appearance.state);
        rigid->setNodeMask(source.appearance.mask);
        root->addPart(*rigid, nullptr);
        result.player->addRigid(rigid, source.joint, _toWorld);
    }
    result.player->_baked = _baked;
    result.player->_toWorld = _toWorld;
    result.node->getBound(); // now: threads that pose copies may ask for bounds of what they share
    if (updates) result.node->setUpdateCallback(result.player);
    return result;
}

} // namespace osgSkin
