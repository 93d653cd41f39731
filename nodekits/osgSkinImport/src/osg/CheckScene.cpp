// SPDX-License-Identifier: MIT
#include "osg/CheckScene.h"

#include "text/FileText.h"

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

bool isFine(const osg::Matrixf& matrix) {
    return std::all_of(matrix.ptr(), matrix.ptr() + 16, [](double x) { return isFine(x); });
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
Keys lookAt(const osgAnimation::KeyframeContainer& container) {
    Keys found = Keys::NotOfThisKind;
    ((found = found == Keys::NotOfThisKind ? keysOf<Values>(container) : found), ...);
    return found;
}

/// Why OSG cannot play an animation; empty if it can. OSG looks up times in a channel's keys
/// without checking that there are any, or that they are in order.
std::string whyNotPlayed(const osgAnimation::Animation& animation) {
    using namespace osgAnimation;
    for (const osg::ref_ptr<Channel>& channel : animation.getChannels()) {
        if (!channel) return "a channel that is none";
        const std::string which = "channel " + inQuotes(channel->getName()) + " of joint " +
                                  inQuotes(channel->getTargetName());
        const Sampler* sampler = channel->getSampler();
        const KeyframeContainer* keys =
            sampler != nullptr ? sampler->getKeyframeContainer() : nullptr;
        if (keys == nullptr || keys->size() == 0) return which + " without keys";
        const Keys found = lookAt<float, double, osg::Vec2, osg::Vec3, osg::Vec4, osg::Quat,
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

constexpr float kRounding = -1e-3f; ///< the least weight that exporters round from 0
constexpr auto kMaxWeight = static_cast<float>(kLargestCoordinate);

/// Why an array does not contain `count` vectors of three floats; empty if it does.
std::string wrongWith(const osg::Array* array, std::size_t count, const std::string& what) {
    if (dynamic_cast<const osg::Vec3Array*>(array) == nullptr)
        return what + " that are not of three floats each";
    const unsigned found = array->getNumElements();
    if (found == count) return {};
    return std::to_string(found) + " " + what + ", expected " + std::to_string(count);
}

std::string whyNotRigged(const osgAnimation::RigGeometry& rig) {
    const osg::Geometry* const source = rig.getSourceGeometry();
    if (source == nullptr) return "no geometry that it is made of, expected one";
    if (rig.getRigTransformImplementation() == nullptr) return "no way to be moved, expected one";
    const osgAnimation::VertexInfluenceMap* const influences = rig.getInfluenceMap();
    if (influences == nullptr) return "no bones, expected some";
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

std::string whyNotMorphed(const osgAnimation::MorphGeometry& morph) {
    const osg::Array* const places = morph.getVertexArray();
    const std::size_t vertices = places != nullptr ? places->getNumElements() : 0;
    std::string wrong = wrongWith(places, vertices, "vertices");
    const osg::Array* const normals = morph.getNormalArray();
    if (wrong.empty() && normals != nullptr) // a single overall normal is not morphed
        wrong = wrongWith(normals, normals->getNumElements(), "normals");
    const osg::Array *const atRest = morph.getVertexSource(), *const turned =
                                                                  morph.getNormalSource();
    if (wrong.empty() && atRest != nullptr && atRest->getNumElements() > 0)
        wrong = wrongWith(atRest, vertices, "vertices at rest");
    if (wrong.empty() && turned != nullptr && normals != nullptr && turned->getNumElements() > 0)
        wrong = wrongWith(turned, normals->getNumElements(), "normals at rest");
    for (const auto& target : morph.getMorphTargetList()) {
        if (!wrong.empty()) break;
        const osg::Geometry* const shape = target.getGeometry();
        if (shape == nullptr) return "a morph target without a geometry";
        wrong = wrongWith(shape->getVertexArray(), vertices, "vertices of a morph target");
        if (!wrong.empty() || normals == nullptr || shape->getNormalArray() == nullptr) continue;
        wrong = wrongWith(shape->getNormalArray(), vertices, "normals of a morph target");
        if (wrong.empty()) wrong = wrongWith(normals, vertices, "normals");
    }
    return wrong;
}

/// Why osgAnimation would access memory out of range when it deforms a rig or morph; empty if it
/// would not, and for other geometries.
std::string whyNotDeformed(const osg::Geometry& geometry) {
    if (const auto* rig = dynamic_cast<const osgAnimation::RigGeometry*>(&geometry))
        return whyNotRigged(*rig);
    if (const auto* morph = dynamic_cast<const osgAnimation::MorphGeometry*>(&geometry))
        return whyNotMorphed(*morph);
    return {};
}

/// Whether a drawable has a rig's bounding box callback but is not a rig, for which osgAnimation
/// throws.
bool hasBoxOfARig(const osg::Drawable& drawable) {
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

std::string wrongIn(const osg::PrimitiveSet& set, std::size_t vertices) {
    if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(&set)) {
        double end = lengths->getFirst();
        for (const GLsizei length : *lengths) {
            if (length < 0) return "a primitive of " + std::to_string(length) + " corners";
            end += length;
        }
        if (lengths->getFirst() < 0 || end > double(vertices))
            return "primitives beyond its " + std::to_string(vertices) + " vertices";
        return {};
    }
    if (const auto* range = dynamic_cast<const osg::DrawArrays*>(&set)) {
        if (range->getFirst() < 0 || range->getCount() < 0 ||
            double(range->getFirst()) + range->getCount() > double(vertices))
            return "primitives beyond its " + std::to_string(vertices) + " vertices";
        return {};
    }
    const unsigned count = set.getNumIndices();
    if (set.getMode() == GL_TRIANGLES &&
        count % 3 != 0) // OSG reads all corners of an incomplete triangle
        return std::to_string(count) + " corners of triangles, expected a multiple of 3";
    for (unsigned i = 0; i < count; ++i)
        if (set.index(i) >= vertices)
            return "a primitive that names vertex " + std::to_string(set.index(i)) +
                   ", expected less than " + std::to_string(vertices);
    return {};
}

bool isFinePlace(double number) {
    return std::abs(number) <= kLargestCoordinate; // false for NaN
}

template <typename Array>
bool areInRange(const osg::Array& array) {
    const auto* vectors = dynamic_cast<const Array*>(&array);
    if (vectors == nullptr) return true;
    return std::all_of(vectors->begin(), vectors->end(), [](const auto& v) {
        for (unsigned i = 0; i < Array::ElementDataType::num_components; ++i)
            if (!isFinePlace(double(v.ptr()[i]))) return false;
        return true;
    });
}

std::string wrongIn(const osg::Geometry& geometry) {
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        if (!set) return "a primitive set that is none";
    const std::size_t vertices = vertexCountOf(geometry);
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList()) {
        std::string wrong = wrongIn(*set, vertices);
        if (!wrong.empty()) return wrong;
    }
    if (const osg::Array* places = geometry.getVertexArray())
        if (!areInRange<osg::Vec2Array>(*places) || !areInRange<osg::Vec3Array>(*places) ||
            !areInRange<osg::Vec4Array>(*places) || !areInRange<osg::Vec2dArray>(*places) ||
            !areInRange<osg::Vec3dArray>(*places) || !areInRange<osg::Vec4dArray>(*places))
            return "vertices that are not finite, or beyond -1e18 to 1e18";
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (geometry.getVertexArray() != nullptr && isPerVertex(array) &&
            array->getNumElements() < vertices)
            return "an array of " + std::to_string(array->getNumElements()) +
                   " elements, expected one for each of " + std::to_string(vertices) + " vertices";
    return whyNotDeformed(geometry);
}

bool isFinePlace(const osg::Matrixd& matrix) {
    return std::all_of(matrix.ptr(), matrix.ptr() + 16,
                       [](double number) { return isFinePlace(number); });
}

/// Whether the matrix of a transform, or of an element of an animated one, is in range.
bool hasPlace(const osg::Object& object) {
    osg::Matrixd matrix;
    if (const auto* transform = dynamic_cast<const osg::Transform*>(&object))
        transform->computeLocalToWorldMatrix(matrix, nullptr);
    else if (const auto* part = dynamic_cast<const osgAnimation::StackedTransformElement*>(&object))
        part->applyToMatrix(matrix);
    const auto* bone = dynamic_cast<const osgAnimation::Bone*>(&object);
    return isFinePlace(matrix) &&
           (bone == nullptr || (isFinePlace(bone->getMatrixInSkeletonSpace()) &&
                                isFinePlace(bone->getInvBindMatrixInSkeletonSpace())));
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
                                       which + " is of another kind than what it moves");
            }
        if (!moves && idle++ == 0) first = which;
    }
    if (idle > 0)
        tellOf(path, "animation " + inQuotes(animation.getName()) + ": " + std::to_string(idle) +
                         " of its " + std::to_string(animation.getChannels().size()) +
                         " channels move nothing that is here, the first " + first);
}

} // namespace

void checkScene(osg::Node& scene, const std::string& path) {
    SceneObjects objects;
    scene.accept(objects);
    for (const osg::Geometry* geometry : objects.geometries) {
        const std::string wrong = wrongIn(*geometry);
        if (!wrong.empty())
            failFile(path, "geometry " + inQuotes(geometry->getName()) + " has " + wrong);
    }
    for (const osg::Object* object : objects.placed)
        if (!hasPlace(*object))
            failFile(path, "transform " + inQuotes(object->getName()) +
                               " has a matrix with numbers that are not finite, or beyond -1e18 "
                               "to 1e18");
    for (const osg::Drawable* drawable : objects.drawables)
        if (hasBoxOfARig(*drawable))
            failFile(path, "drawable " + inQuotes(drawable->getName()) +
                               " has the box of a rig, expected a rig");
    if (objects.hasNullAnimation) failFile(path, "an animation that is none");
    for (osgAnimation::Animation* animation : objects.animations) {
        const std::string wrong = whyNotPlayed(*animation);
        if (!wrong.empty())
            failFile(path, "animation " + inQuotes(animation->getName()) + " has " + wrong);
        if (animation->computeDurationFromChannels() == 0.0) // a pose
            animation->setPlayMode(osgAnimation::Animation::LOOP);
        checkLinks(*animation, objects, path);
    }
}

} // namespace osgSkin
