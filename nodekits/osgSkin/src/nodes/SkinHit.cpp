// SPDX-License-Identifier: MIT
#include <osgSkin/SkinHit>

#include <osgSkin/RigidPart>
#include <osgSkin/SkinModel>

#include <osg/Matrixd>
#include <osg/TriangleFunctor>
#include <osgAnimation/Bone>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {
namespace {

/// Finds a triangle by its index, which counts as osgUtil's intersectors do.
struct NthTriangle {
    unsigned int left = 0; ///< to skip
    std::array<const osg::Vec3*, 3> corners{};

    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false) {
        if (left-- == 0) corners = {&a, &b, &c};
    }
};

/// Barycentric ratios of a point in the triangle's plane; of its nearest corner where the triangle
/// has no area.
std::array<double, 3> ratiosAt(const osg::Vec3d& point, const std::array<osg::Vec3d, 3>& corners) {
    const osg::Vec3d normal = (corners[1] - corners[0]) ^ (corners[2] - corners[0]);
    std::array<double, 3> ratios{};
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const osg::Vec3d& next = corners[(i + 1) % 3];
        ratios[i] = std::max(0.0, ((next - point) ^ (corners[(i + 2) % 3] - point)) * normal);
        sum += ratios[i];
    }
    if (sum > 0.0) {
        for (double& ratio : ratios) ratio /= sum;
        return ratios;
    }
    const auto nearest = std::min_element(corners.begin(), corners.end(),
                                          [&](const osg::Vec3d& a, const osg::Vec3d& b) {
                                              return (a - point).length2() < (b - point).length2();
                                          });
    ratios[static_cast<std::size_t>(nearest - corners.begin())] = 1.0;
    return ratios;
}

/// Adds what a vertex takes of each joint's bend.
void addBends(const SkinModel& model, unsigned int vertex, double ratio,
              std::vector<double>& bends) {
    const auto at = static_cast<std::uint32_t>(
        std::find(model.order().begin(), model.order().end(), vertex) - model.order().begin());
    const auto group = std::find_if(
        model.groups().begin(), model.groups().end(), [at](const SkinModel::Group& one) {
            return at >= one.firstVertex && at - one.firstVertex < one.vertexCount;
        });
    if (group == model.groups().end()) return;
    std::size_t partial = group->firstRatio + (at - group->firstVertex) * group->partialCount;
    for (std::uint32_t k = 0; k < group->linkCount; ++k) {
        const SkinModel::Link& link = model.links()[group->firstLink + k];
        bends[link.joint] += ratio * (link.partial ? model.ratios()[partial++].bend : 1.0f);
    }
}

std::string jointOf(const SkinModel& model, const SkinHit& hit) {
    std::vector<double> bends(model.joints().size());
    for (std::size_t i = 0; i < 3; ++i) addBends(model, hit.vertices[i], hit.ratios[i], bends);
    const auto last =
        std::find_if(bends.rbegin(), bends.rend(), [](double bend) { return bend >= 0.5; });
    if (last == bends.rend()) return "";
    return model.joints()[static_cast<std::size_t>(bends.rend() - last - 1)].name;
}

/// From the drawable at the end of a path to rest space, by its bone.
osg::Matrixd toRest(const osg::NodePath& path, osg::NodePath::const_iterator bone) {
    osg::Matrixd matrix;
    for (auto node = bone + 1; node != path.end(); ++node) {
        // A part may be placed where a resting bone would carry it.
        if (const auto* part = dynamic_cast<const RigidPart*>(*node))
            matrix.preMult(part->getMatrix());
        else if (const osg::Transform* transform = (*node)->asTransform())
            transform->computeLocalToWorldMatrix(matrix, nullptr);
    }
    const auto& of = static_cast<const osgAnimation::Bone&>(**bone);
    return matrix * osg::Matrixd::inverse(of.getInvBindMatrixInSkeletonSpace());
}

std::optional<SkinHit> find(const osg::NodePath& path, const osg::Drawable* drawable,
                            unsigned int triangle, const osg::Vec3d& point) {
    const auto* skin = dynamic_cast<const DeformableSkin*>(drawable);
    const auto bone = std::find_if(path.rbegin(), path.rend(), [](const osg::Node* node) {
        return dynamic_cast<const osgAnimation::Bone*>(node) != nullptr;
    });
    if (!drawable || (!skin && bone == path.rend())) return std::nullopt;
    const osg::Geometry* const posed = skin ? skin->getDeformedGeometry() : drawable->asGeometry();
    const auto* vertices =
        posed ? dynamic_cast<const osg::Vec3Array*>(posed->getVertexArray()) : nullptr;
    if (!vertices) return std::nullopt;
    osg::TriangleFunctor<NthTriangle> nth;
    nth.left = triangle;
    posed->accept(nth);
    if (!nth.corners[0]) return std::nullopt;

    SkinHit hit;
    hit.skin = skin;
    hit.geometry = skin ? skin->getRestGeometry() : posed;
    std::array<osg::Vec3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        hit.vertices[i] = static_cast<unsigned int>(nth.corners[i] - vertices->asVector().data());
        corners[i] = *nth.corners[i];
    }
    hit.ratios = ratiosAt(point, corners);
    if (!skin) {
        hit.rest = point * toRest(path, bone.base() - 1);
        hit.joint = (*bone)->getName();
        return hit;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3& rest = skin->getModel()->positions()[hit.vertices[i]];
        hit.rest += osg::Vec3d(rest.x, rest.y, rest.z) * hit.ratios[i];
    }
    hit.joint = jointOf(*skin->getModel(), hit);
    return hit;
}

} // namespace

std::optional<SkinHit> skinHit(const osgUtil::LineSegmentIntersector::Intersection& hit) {
    return find(hit.nodePath, hit.drawable, hit.primitiveIndex, hit.localIntersectionPoint);
}

std::optional<SkinHit> skinHit(const osgUtil::PolytopeIntersector::Intersection& hit) {
    return find(hit.nodePath, hit.drawable, hit.primitiveIndex, hit.localIntersectionPoint);
}

} // namespace osgSkin
