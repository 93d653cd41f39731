// SPDX-License-Identifier: MIT
#include "saved/checks/CheckDeformed.h"

#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>

namespace osgSkin {
namespace {

constexpr float kRounding = -1e-3f; ///< the least weight that exporters make of 0
constexpr auto kMostWeight = static_cast<float>(kLargestCoordinate);

/// Why an array is not one of so many places or directions in floats; empty where it is.
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
            if (vertex >= vertices || !(weight >= kRounding && weight <= kMostWeight))
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
    if (wrong.empty() && normals != nullptr) // one for all stays where it is
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

} // namespace

std::string whyNotDeformed(const osg::Geometry& geometry) {
    if (const auto* rig = dynamic_cast<const osgAnimation::RigGeometry*>(&geometry))
        return whyNotRigged(*rig);
    if (const auto* morph = dynamic_cast<const osgAnimation::MorphGeometry*>(&geometry))
        return whyNotMorphed(*morph);
    return {};
}

bool hasBoxOfARig(const osg::Drawable& drawable) {
    const auto* box = dynamic_cast<const osgAnimation::RigComputeBoundingBoxCallback*>(
        drawable.getComputeBoundingBoxCallback());
    return box != nullptr && dynamic_cast<const osgAnimation::RigGeometry*>(&drawable) == nullptr;
}

} // namespace osgSkin
