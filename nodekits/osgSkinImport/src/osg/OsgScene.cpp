// SPDX-License-Identifier: MIT
#include "osg/OsgScene.h"

#include "files/FileText.h"
#include "mesh/Material.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinImport/ReadScene>
#include <osgSkinRig/ReadSkeleton>

#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/Transform>
#include <osg/TriangleIndexFunctor>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>

#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

struct TriangleCollector {
    std::vector<unsigned> corners;
    void operator()(unsigned a, unsigned b, unsigned c) {
        corners.insert(corners.end(), {a, b, c});
    }
};

bool positionsOf(const osg::Array* array, std::vector<glm::dvec3>& positions) {
    if (const auto* floats = dynamic_cast<const osg::Vec3Array*>(array)) {
        for (const osg::Vec3& p : *floats) positions.push_back(toGlm(osg::Vec3d(p)));
        return true;
    }
    if (const auto* doubles = dynamic_cast<const osg::Vec3dArray*>(array)) {
        for (const osg::Vec3d& p : *doubles) positions.push_back(toGlm(p));
        return true;
    }
    return false;
}

template <typename Array>
const Array* perVertex(const osg::Array* array, std::size_t vertices) {
    const auto* typed = dynamic_cast<const Array*>(array);
    const bool fits = typed != nullptr && typed->getBinding() == osg::Array::BIND_PER_VERTEX &&
                      typed->size() >= vertices;
    return fits ? typed : nullptr;
}

/// A geometry's vertex colours; empty if they are not per vertex.
std::vector<glm::vec4> coloursOf(const osg::Geometry& geometry, std::size_t vertices) {
    std::vector<glm::vec4> result;
    if (const auto* floats = perVertex<osg::Vec4Array>(geometry.getColorArray(), vertices))
        for (const osg::Vec4& c : *floats) result.emplace_back(c.r(), c.g(), c.b(), c.a());
    else if (const auto* bytes = perVertex<osg::Vec4ubArray>(geometry.getColorArray(), vertices))
        for (const osg::Vec4ub& c : *bytes)
            result.push_back(glm::vec4(c.r(), c.g(), c.b(), c.a()) / 255.0f);
    return result;
}

/// Collects the triangles of all geometries, in the scene's space.
class GeometryCollector : public osg::NodeVisitor {
public:
    GeometryCollector(const std::string& path, CornerMesh& result)
        : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN), _path(path), _result(result) {}

    void apply(osg::Geometry& drawable) override {
        auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(&drawable);
        // A rig deforms into its own arrays; its source geometry stays at rest.
        const bool hasSource = rig != nullptr && rig->getSourceGeometry() != nullptr;
        osg::Geometry& geometry = hasSource ? *rig->getSourceGeometry() : drawable;
        std::vector<glm::dvec3> positions;
        if (!positionsOf(geometry.getVertexArray(), positions)) return;
        const std::string broken = brokenPrimitive(geometry, positions.size());
        if (!broken.empty())
            failFile(_path, "geometry " + inQuotes(geometry.getName()) + " has " + broken);
        osg::TriangleIndexFunctor<TriangleCollector> triangles;
        geometry.accept(triangles);
        if (triangles.corners.empty()) return; // points and lines

        const glm::dmat4 toScene = toGlm(osg::computeLocalToWorld(getNodePath()));
        const auto first = static_cast<std::uint32_t>(_result.mesh.positions.size());
        if (first + positions.size() > std::numeric_limits<std::uint32_t>::max())
            failFile(_path, "more vertices than 32-bit indices reach");
        for (const glm::dvec3& p : positions)
            _result.mesh.positions.emplace_back(toScene * glm::dvec4(p, 1.0));
        addTriangles(geometry, triangles.corners, toScene, first, positions.size());
        if (rig != nullptr && rig->getInfluenceMap() != nullptr)
            addWeights(*rig->getInfluenceMap(), first, positions.size());
    }

private:
    void addWeights(const osgAnimation::VertexInfluenceMap& influences, std::uint32_t first,
                    std::size_t vertices) {
        for (const auto& [bone, entries] : influences) {
            BoneWeights& weights = _result.weightsOf(bone);
            for (const auto& [vertex, weight] : entries) {
                if (vertex >= vertices || !std::isfinite(weight) || weight < 0.0f)
                    failFile(_path, "bone " + inQuotes(bone) + ": weight of vertex " +
                                        std::to_string(vertex) + ", expected a vertex below " +
                                        std::to_string(vertices) +
                                        " and a finite number of 0 or more");
                weights.entries.push_back({first + vertex, double(weight)});
            }
        }
    }

    void addTriangles(const osg::Geometry& geometry, const std::vector<unsigned>& corners,
                      const glm::dmat4& toScene, std::uint32_t first, std::size_t vertices) {
        const auto* normals = perVertex<osg::Vec3Array>(geometry.getNormalArray(), vertices);
        const auto* texCoords = perVertex<osg::Vec2Array>(geometry.getTexCoordArray(0), vertices);
        _result.hasTexCoords = _result.hasTexCoords || texCoords != nullptr;
        const std::vector<glm::vec4> colours = coloursOf(geometry, vertices);
        const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(toScene)));
        const bool mirrored = glm::determinant(glm::dmat3(toScene)) < 0.0;
        const std::uint32_t material = materialHere(!colours.empty());
        for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
            _result.addFace(material);
            for (std::size_t k = 0; k < 3; ++k) {
                const unsigned v = corners[t + (mirrored ? 2 - k : k)];
                if (v >= vertices)
                    failFile(_path, "geometry \"" + geometry.getName() + "\": triangle " +
                                        std::to_string(t / 3) + " names vertex " +
                                        std::to_string(v) + ", expected less than " +
                                        std::to_string(vertices));
                glm::dvec3 normal(0.0);
                if (normals != nullptr) normal = normalMatrix * toGlm(osg::Vec3d((*normals)[v]));
                glm::vec2 texCoord(0.0f);
                if (texCoords != nullptr) texCoord = {(*texCoords)[v].x(), (*texCoords)[v].y()};
                _result.addCorner(first + v, glm::vec3(normal), texCoord);
                if (!colours.empty())
                    _result.colours.resize(_result.normals.size() - 1, glm::vec4(1.0f));
                if (!colours.empty()) _result.colours.push_back(colours[v]);
            }
        }
        if (!_result.colours.empty())
            _result.colours.resize(_result.normals.size(), glm::vec4(1.0f));
    }

    /// The merged state of all nodes down to the current one, shared between equal paths.
    std::uint32_t materialHere(bool coloured) {
        std::vector<const osg::StateSet*> states;
        for (const osg::Node* node : getNodePath())
            if (node->getStateSet() != nullptr) states.push_back(node->getStateSet());
        const auto [entry, isNew] = _materials.emplace(
            std::make_pair(states, coloured), static_cast<std::uint32_t>(_result.stateSets.size()));
        if (!isNew) return entry->second;
        osg::ref_ptr<osg::StateSet> merged;
        for (const osg::StateSet* state : states) {
            if (!merged) merged = new osg::StateSet;
            merged->merge(*state);
        }
        Material material;
        material.vertexColours = coloured;
        _result.stateSets.push_back(merged.valid() ? merged : makeStateSet(material));
        return entry->second;
    }

    const std::string& _path;
    CornerMesh& _result;
    /// By the state sets down to a geometry, and whether it has colours.
    std::map<std::pair<std::vector<const osg::StateSet*>, bool>, std::uint32_t> _materials;
};

} // namespace

CornerMesh readOsgMesh(const std::string& path, const osgDB::Options* options) {
    const osg::ref_ptr<osg::Node> node = readScene(path, options);
    CornerMesh result;
    GeometryCollector collector(path, result);
    node->accept(collector);
    return result;
}

namespace {

class SkeletonFinder : public osg::NodeVisitor {
public:
    SkeletonFinder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    osgAnimation::Skeleton* found = nullptr;
    osg::NodePath path;

    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Bone*>(&node) != nullptr && found == nullptr)
            for (auto above = getNodePath().begin(); above != getNodePath().end(); ++above)
                if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(*above)) {
                    found = skeleton;
                    path.assign(getNodePath().begin(), above + 1);
                }
        if (found == nullptr) traverse(node);
    }
};

} // namespace

RestSkeleton readOsgSkeleton(osg::Node& scene, const std::string& path) {
    SkeletonFinder finder;
    scene.accept(finder);
    if (finder.found == nullptr)
        failFile(path, "no skeleton, expected an osgAnimation::Skeleton with bones");
    RestSkeleton result;
    try {
        result = readSkeleton(*finder.found);
    } catch (const Error& error) {
        failFile(path, error.what());
    }
    const osg::Matrixd toScene = osg::computeLocalToWorld(finder.path);
    for (RestJoint& joint : result.joints)
        joint.centre = toGlm(osg::Vec3d(toOsg(joint.centre) * toScene));
    return result;
}

} // namespace osgSkin
