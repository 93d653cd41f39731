// SPDX-License-Identifier: MIT
#include "saved/CheckSaved.h"

#include "saved/checks/CheckAnimation.h"
#include "saved/checks/CheckChoices.h"
#include "saved/checks/CheckDeformed.h"
#include "text/FileText.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/GlmTypes>

#include <osg/Callback>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/Transform>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Bone>
#include <osgAnimation/StackedTransformElement>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace osgSkin {
namespace {

bool isPerVertex(const osg::Array* array) {
    return array != nullptr && array->getBinding() == osg::Array::BIND_PER_VERTEX;
}

/// The vertices that primitives may name; any number where a geometry has no array to say so.
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
    if (set.getMode() == GL_TRIANGLES && count % 3 != 0) // OSG reads all corners of one begun
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

/// Whether a transform, or a part of one that moves, has a place for what is below it.
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

/// Whether OSG read a node, callback or animation and has not put it anywhere: it drops without a
/// word what is of another class than it looks for, and a character would stand still.
bool isDropped(const osg::Object* object) {
    const bool isKept = dynamic_cast<const osg::Node*>(object) != nullptr ||
                        dynamic_cast<const osg::Callback*>(object) != nullptr ||
                        dynamic_cast<const osgAnimation::Animation*>(object) != nullptr;
    return isKept && object->referenceCount() == 1; // by the list of what was read
}

/// Nodes, vertices and corners, as often as they are shown.
double costOf(const osg::Node& node, std::map<const osg::Node*, double>& known) {
    const auto found = known.find(&node);
    if (found != known.end()) return found->second;
    double cost = 1.0;
    const auto* skin = dynamic_cast<const DeformableSkin*>(&node);
    if (const osg::Geometry* geometry = skin ? skin->getRestGeometry() : node.asGeometry()) {
        if (geometry->getVertexArray() != nullptr)
            cost += geometry->getVertexArray()->getNumElements();
        for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry->getPrimitiveSetList())
            cost += double(set->getNumIndices()) * std::max(1, set->getNumInstances());
    }
    if (const osg::Group* group = node.asGroup())
        for (unsigned c = 0; c < group->getNumChildren(); ++c)
            cost += costOf(*group->getChild(c), known);
    known.emplace(&node, cost);
    return cost;
}

} // namespace

void checkSavedObjects(const SavedStream::IdentifierMap& objects, const std::string& path) {
    CheckChoices choices;
    for (const auto& [id, object] : objects) {
        if (!object) continue; // a picture that could not be read
        if (isDropped(object.get()))
            failFile(path, "object " + std::to_string(id) + " of class " +
                               inQuotes(object->getCompoundClassName()) +
                               ", expected one of a class that can stand there");
        const std::string unknown = choices.wrongIn(*object);
        if (!unknown.empty())
            failFile(path, "object " + std::to_string(id) + " of class " +
                               inQuotes(object->getCompoundClassName()) + " has " + unknown);
        if (const auto* geometry = dynamic_cast<const osg::Geometry*>(object.get())) {
            const std::string wrong = wrongIn(*geometry);
            if (!wrong.empty())
                failFile(path, "geometry " + inQuotes(geometry->getName()) + " (object " +
                                   std::to_string(id) + ") has " + wrong);
        }
        if (!hasPlace(*object))
            failFile(path, "transform " + inQuotes(object->getName()) + " (object " +
                               std::to_string(id) +
                               ") has a matrix with numbers that are not finite, or beyond -1e18 "
                               "to 1e18");
        const auto* drawable = dynamic_cast<const osg::Drawable*>(object.get());
        if (drawable != nullptr && hasBoxOfARig(*drawable))
            failFile(path, "drawable " + inQuotes(drawable->getName()) + " (object " +
                               std::to_string(id) + ") has the box of a rig, expected a rig");
        if (auto* animation = dynamic_cast<osgAnimation::Animation*>(object.get())) {
            const std::string wrong = whyNotPlayed(*animation);
            if (!wrong.empty())
                failFile(path, "animation " + inQuotes(animation->getName()) + " has " + wrong);
            // A pose: OSG divides by its length unless it is repeated.
            if (animation->computeDurationFromChannels() == 0.0)
                animation->setPlayMode(osgAnimation::Animation::LOOP);
        }
        const auto* manager = dynamic_cast<const osgAnimation::AnimationManagerBase*>(object.get());
        if (manager == nullptr) continue;
        for (const auto& animation : manager->getAnimationList())
            if (!animation) failFile(path, "an animation that is none");
    }
}

void checkSavedScene(const osg::Node& scene, std::size_t bytes, const ReadLimits& limits,
                     const std::string& path) {
    std::map<const osg::Node*, double> known;
    if (costOf(scene, known) > double(bytes) + double(limits.samplesOf(bytes)))
        failFile(path, "nodes, vertices and corners are shown more often than " +
                           std::to_string(limits.samplesOf(bytes)) +
                           " times beside those in the file (option maxSamples)");
}

} // namespace osgSkin
