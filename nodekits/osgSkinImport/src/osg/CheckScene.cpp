// SPDX-License-Identifier: MIT
#include "osg/CheckScene.h"

#include "files/FileText.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/GlmTypes>

#include <osg/Callback>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/StateSet>
#include <osg/Transform>
#include <osg/Uniform>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/AnimationUpdateCallback>
#include <osgAnimation/Bone>
#include <osgAnimation/CubicBezier>
#include <osgAnimation/Keyframe>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Sampler>
#include <osgAnimation/StackedTransformElement>
#include <osgAnimation/UpdateMatrixTransform>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

// Animations.

enum class Keys { NotOfThisKind, Fine, WrongTimes, WrongValues };

bool isFine(double value) {
    return std::abs(value) <= kLargestCoordinate; // false for NaN too
}

/// OSG does not normalise rotations: one of another length would scale.
bool isFine(const osg::Quat& rotation) {
    return std::abs(rotation.length() - 1.0) < 0.1; // false for NaN too
}

template <typename Value>
auto isFine(const Value& vector) -> decltype(bool(Value::num_components)) {
    for (int i = 0; i < int(Value::num_components); ++i)
        if (!isFine(double(vector.ptr()[i]))) return false;
    return true;
}

template <typename Matrix>
auto isFine(const Matrix& matrix) -> decltype(bool(matrix.isIdentity())) {
    return std::all_of(matrix.ptr(), matrix.ptr() + 16, [](auto x) { return isFine(double(x)); });
}

template <typename Value>
bool isFine(const osgAnimation::TemplateCubicBezier<Value>& bezier) {
    return isFine(bezier.getPosition()) && isFine(bezier.getControlPointIn()) &&
           isFine(bezier.getControlPointOut());
}

template <typename Value>
Keys keysOf(const osgAnimation::KeyframeContainer& container) {
    const auto* keys =
        dynamic_cast<const osgAnimation::TemplateKeyframeContainer<Value>*>(&container);
    if (keys == nullptr) return Keys::NotOfThisKind;
    double before = -HUGE_VAL;
    for (const auto& key : *keys) {
        if (!std::isfinite(key.getTime()) || key.getTime() < before) return Keys::WrongTimes;
        if (!isFine(key.getValue())) return Keys::WrongValues;
        before = key.getTime();
    }
    return Keys::Fine;
}

template <typename... Values>
Keys checkKeys(const osgAnimation::KeyframeContainer& container) {
    Keys found = Keys::NotOfThisKind;
    ((found = found == Keys::NotOfThisKind ? keysOf<Values>(container) : found), ...);
    return found;
}

/// The reason why OSG cannot play an animation; empty if it can. OSG looks up times in a channel's
/// keys without checking that there are any, or that they are in order.
std::string animationError(const osgAnimation::Animation& animation) {
    using namespace osgAnimation;
    for (const osg::ref_ptr<Channel>& channel : animation.getChannels()) {
        if (!channel) return "a null channel";
        const std::string which = "channel " + inQuotes(channel->getName()) + " of joint " +
                                  inQuotes(channel->getTargetName());
        const Sampler* sampler = channel->getSampler();
        const KeyframeContainer* keys =
            sampler != nullptr ? sampler->getKeyframeContainer() : nullptr;
        if (keys == nullptr || keys->size() == 0) return which + " without keys";
        const Keys found = checkKeys<float, double, osg::Vec2, osg::Vec3, osg::Vec4, osg::Quat,
                                     osg::Matrixf, FloatCubicBezier, DoubleCubicBezier,
                                     Vec2CubicBezier, Vec3CubicBezier, Vec4CubicBezier>(*keys);
        if (found == Keys::WrongValues)
            return which + " with values of keys that are not finite, or beyond -1e18 to 1e18, or "
                           "rotations that are not of length 1";
        if (found != Keys::Fine)
            return which + " with times of keys that are not finite or not in order";
    }
    if (!std::isfinite(animation.getDuration()) || !std::isfinite(animation.getStartTime()))
        return "a duration or a start that is not finite";
    return {};
}

// Rigs and morphs.

constexpr float kRounding = -1e-3f; ///< slightly negative weights come from rounding
constexpr auto kMaxWeight = static_cast<float>(kLargestCoordinate);

/// Why an array does not contain `count` vectors of three floats; empty if it does.
std::string arrayError(const osg::Array* array, std::size_t count, const std::string& what) {
    if (dynamic_cast<const osg::Vec3Array*>(array) == nullptr)
        return what + " that are not of three floats each";
    const unsigned found = array->getNumElements();
    if (found == count) return {};
    return std::to_string(found) + " " + what + ", expected " + std::to_string(count);
}

std::string rigError(const osgAnimation::RigGeometry& rig) {
    const osg::Geometry* const source = rig.getSourceGeometry();
    if (source == nullptr) return "no source geometry";
    if (rig.getRigTransformImplementation() == nullptr) return "no RigTransform";
    const osgAnimation::VertexInfluenceMap* const influences = rig.getInfluenceMap();
    if (influences == nullptr) return "no bones";
    const osg::Array* const places = source->getVertexArray();
    const std::size_t vertices = places != nullptr ? places->getNumElements() : 0;
    for (const auto& [bone, entries] : *influences)
        for (const auto& [vertex, weight] : entries)
            if (vertex >= vertices || !(weight >= kRounding && weight <= kMaxWeight))
                return "bone " + inQuotes(bone) + ": weight of vertex " + std::to_string(vertex) +
                       ", expected a vertex below " + std::to_string(vertices) +
                       " and a number of 0 or more, up to 1e18";
    return {};
}

std::string morphError(const osgAnimation::MorphGeometry& morph) {
    const osg::Array* const places = morph.getVertexArray();
    const std::size_t vertices = places != nullptr ? places->getNumElements() : 0;
    std::string wrong = arrayError(places, vertices, "vertices");
    const osg::Array* const normals = morph.getNormalArray();
    if (wrong.empty() && normals != nullptr) // a single overall normal is not morphed
        wrong = arrayError(normals, normals->getNumElements(), "normals");
    const osg::Array *const atRest = morph.getVertexSource(), *const turned =
                                                                  morph.getNormalSource();
    if (wrong.empty() && atRest != nullptr && atRest->getNumElements() > 0)
        wrong = arrayError(atRest, vertices, "vertices at rest");
    if (wrong.empty() && turned != nullptr && normals != nullptr && turned->getNumElements() > 0)
        wrong = arrayError(turned, normals->getNumElements(), "normals at rest");
    for (const auto& target : morph.getMorphTargetList()) {
        if (!wrong.empty()) break;
        const osg::Geometry* const shape = target.getGeometry();
        if (shape == nullptr) return "a morph target without a geometry";
        wrong = arrayError(shape->getVertexArray(), vertices, "vertices of a morph target");
        if (!wrong.empty() || normals == nullptr || shape->getNormalArray() == nullptr) continue;
        wrong = arrayError(shape->getNormalArray(), vertices, "normals of a morph target");
        if (wrong.empty()) wrong = arrayError(normals, vertices, "normals");
    }
    return wrong;
}

/// Why osgAnimation would access memory out of range when it deforms a rig or morph; empty if it
/// would not, and for other geometries.
std::string deformError(const osg::Geometry& geometry) {
    if (const auto* rig = dynamic_cast<const osgAnimation::RigGeometry*>(&geometry))
        return rigError(*rig);
    if (const auto* morph = dynamic_cast<const osgAnimation::MorphGeometry*>(&geometry))
        return morphError(*morph);
    return {};
}

/// Whether a drawable has a rig's bounding box callback but is not a rig, for which osgAnimation
/// throws.
bool hasRigBox(const osg::Drawable& drawable) {
    const auto* box = dynamic_cast<const osgAnimation::RigComputeBoundingBoxCallback*>(
        drawable.getComputeBoundingBoxCallback());
    return box != nullptr && dynamic_cast<const osgAnimation::RigGeometry*>(&drawable) == nullptr;
}

// Geometries and transforms.

bool isPerVertex(const osg::Array* array) {
    return array != nullptr && array->getBinding() == osg::Array::BIND_PER_VERTEX;
}

/// The number of vertices that primitives may use; unlimited if the geometry has no array.
std::size_t vertexCountOf(const osg::Geometry& geometry) {
    if (geometry.getVertexArray() != nullptr) return geometry.getVertexArray()->getNumElements();
    std::size_t count = std::numeric_limits<std::size_t>::max();
    for (const osg::ref_ptr<osg::Array>& array : geometry.getVertexAttribArrayList())
        if (isPerVertex(array)) count = std::min<std::size_t>(count, array->getNumElements());
    return count;
}

/// False if an array of any of these types has a vector that is not fine.
template <typename... Arrays>
bool areFine(const osg::Array& array) {
    const auto isFineAs = [&array](const auto* vectors) {
        vectors = dynamic_cast<decltype(vectors)>(&array);
        return vectors == nullptr || std::all_of(vectors->begin(), vectors->end(),
                                                 [](const auto& v) { return isFine(v); });
    };
    return (isFineAs(static_cast<const Arrays*>(nullptr)) && ...);
}

std::string geometryError(const osg::Geometry& geometry) {
    const std::size_t vertices = vertexCountOf(geometry);
    std::string broken = brokenPrimitive(geometry, vertices);
    if (!broken.empty()) return broken;
    if (const osg::Array* places = geometry.getVertexArray())
        if (!areFine<osg::Vec2Array, osg::Vec3Array, osg::Vec4Array, osg::Vec2dArray,
                     osg::Vec3dArray, osg::Vec4dArray>(*places))
            return "vertices that are not finite, or beyond -1e18 to 1e18";
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (geometry.getVertexArray() != nullptr && isPerVertex(array) &&
            array->getNumElements() < vertices)
            return "an array of " + std::to_string(array->getNumElements()) +
                   " elements, expected one for each of " + std::to_string(vertices) + " vertices";
    return deformError(geometry);
}

/// Whether the matrix of a transform, or of an element of an animated one, is in range.
bool hasFiniteMatrix(const osg::Object& object) {
    osg::Matrixd matrix;
    if (const auto* transform = dynamic_cast<const osg::Transform*>(&object))
        transform->computeLocalToWorldMatrix(matrix, nullptr);
    else if (const auto* part = dynamic_cast<const osgAnimation::StackedTransformElement*>(&object))
        part->applyToMatrix(matrix);
    const auto* bone = dynamic_cast<const osgAnimation::Bone*>(&object);
    return isFine(matrix) && (bone == nullptr || (isFine(bone->getMatrixInSkeletonSpace()) &&
                                                  isFine(bone->getInvBindMatrixInSkeletonSpace())));
}

// The whole scene.

/// Collects the objects of a scene to check, each once.
class SceneObjects : public osg::NodeVisitor {
public:
    SceneObjects() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        if (!_known.insert(&node).second) return;
        if (auto* drawable = dynamic_cast<osg::Drawable*>(&node)) drawables.push_back(drawable);
        if (osg::Geometry* geometry = node.asGeometry()) addGeometry(*geometry);
        if (const auto* skin = dynamic_cast<const DeformableSkin*>(&node))
            if (skin->getRestGeometry() != nullptr) geometries.push_back(skin->getRestGeometry());
        if (const auto* transform = node.asTransform()) placed.push_back(transform);
        add(node.getUpdateCallback());
        if (const osg::StateSet* state = node.getStateSet()) add(*state);
        traverse(node);
    }

    std::vector<const osg::Drawable*> drawables;
    std::vector<const osg::Geometry*> geometries;
    std::vector<const osg::Object*> placed; ///< transforms, and elements of animated ones
    std::vector<osgAnimation::Animation*> animations;
    std::map<std::string, std::vector<osgAnimation::AnimationUpdateCallbackBase*>> moved;
    bool hasNullAnimation = false;

private:
    void addGeometry(const osg::Geometry& geometry) {
        geometries.push_back(&geometry);
        if (const auto* rig = dynamic_cast<const osgAnimation::RigGeometry*>(&geometry))
            if (rig->getSourceGeometry() != nullptr) geometries.push_back(rig->getSourceGeometry());
    }

    void add(osg::Callback* callback) {
        for (; callback != nullptr; callback = callback->getNestedCallback()) {
            if (!_known.insert(callback).second) return;
            if (auto* update = dynamic_cast<osgAnimation::AnimationUpdateCallbackBase*>(callback))
                moved[update->getName()].push_back(update);
            if (auto* update = dynamic_cast<osgAnimation::UpdateMatrixTransform*>(callback))
                for (const auto& element : update->getStackedTransforms())
                    if (element.valid()) placed.push_back(element.get());
            auto* manager = dynamic_cast<osgAnimation::AnimationManagerBase*>(callback);
            if (manager == nullptr) continue;
            for (const auto& animation : manager->getAnimationList())
                if (!animation)
                    hasNullAnimation = true;
                else if (_known.insert(animation.get()).second)
                    animations.push_back(animation.get());
        }
    }

    void add(const osg::StateSet& state) {
        if (!_known.insert(&state).second) return;
        for (const auto& [type, attribute] : state.getAttributeList())
            add(attribute.first->getUpdateCallback());
        for (const auto& [name, uniform] : state.getUniformList())
            add(uniform.first->getUpdateCallback());
    }

    std::set<const osg::Referenced*> _known;
};

/// Links a copy of each channel like osgAnimation does. A channel of another type than its target,
/// such as a rotation that names a translation, gets no target, and osgAnimation would still write
/// to it.
void checkLinks(const osgAnimation::Animation& animation, const SceneObjects& scene,
                const std::string& path) {
    std::size_t idle = 0;
    std::string first;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : animation.getChannels()) {
        const std::string which =
            inQuotes(channel->getName()) + " of " + inQuotes(channel->getTargetName());
        const auto found = scene.moved.find(channel->getTargetName());
        bool moves = false;
        if (found != scene.moved.end() && !found->first.empty())
            for (osgAnimation::AnimationUpdateCallbackBase* callback : found->second) {
                const osg::ref_ptr<osgAnimation::Channel> tried = channel->clone();
                moves = callback->link(tried.get()) || moves;
                if (tried->getTarget() == nullptr)
                    failFile(path, "animation " + inQuotes(animation.getName()) + ": channel " +
                                       which + " does not match the type of its target");
            }
        if (!moves && idle++ == 0) first = which;
    }
    if (idle > 0)
        warn(path, "animation " + inQuotes(animation.getName()) + ": " + std::to_string(idle) +
                       " of its " + std::to_string(animation.getChannels().size()) +
                       " channels have no target in this scene, the first " + first);
}

} // namespace

void checkScene(osg::Node& scene, const std::string& path) {
    SceneObjects objects;
    scene.accept(objects);
    for (const osg::Geometry* geometry : objects.geometries) {
        const std::string wrong = geometryError(*geometry);
        if (!wrong.empty())
            failFile(path, "geometry " + inQuotes(geometry->getName()) + " has " + wrong);
    }
    for (const osg::Object* object : objects.placed)
        if (!hasFiniteMatrix(*object))
            failFile(path, "transform " + inQuotes(object->getName()) +
                               " has a matrix with numbers that are not finite, or beyond -1e18 "
                               "to 1e18");
    for (const osg::Drawable* drawable : objects.drawables)
        if (hasRigBox(*drawable))
            failFile(path, "drawable " + inQuotes(drawable->getName()) +
                               " has the bounding box callback of a rig, but is not a rig");
    if (objects.hasNullAnimation) failFile(path, "a null animation");
    for (osgAnimation::Animation* animation : objects.animations) {
        const std::string wrong = animationError(*animation);
        if (!wrong.empty())
            failFile(path, "animation " + inQuotes(animation->getName()) + " has " + wrong);
        if (animation->computeDurationFromChannels() == 0.0) // a pose
            animation->setPlayMode(osgAnimation::Animation::LOOP);
        checkLinks(*animation, objects, path);
    }
}

} // namespace osgSkin
