// SPDX-License-Identifier: MIT
#include <osgSkinMotion/HitBoxes>

#include "bones/BoneCallbacks.h"
#include "hits/FitShapes.h"

#include <osgSkin/Deform>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/SkinModel>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinRig/ReadSkeleton>

#include <glm/gtc/matrix_transform.hpp>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/StateSet>
#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace osgSkin {
namespace {

using Shape = HitBoxes::Shape;
using Limb = HitBoxes::Limb;

constexpr double kCell = 1.0 / 300.0; ///< of the figure's size; vertices nearer are one

constexpr double kBend = 0.3; ///< radians, of all joints, in which the shapes contain the skin, too

/// A figure's triangles at rest, and the joint of each vertex.
struct Figure {
    std::vector<glm::dvec3> vertices; ///< the figure's space
    std::vector<std::size_t> joints;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The last joint in the skeleton's order whose bend each vertex takes by half or more, as in
/// SkinHit.
std::vector<std::uint32_t> jointsOf(const SkinModel& model) {
    std::vector<std::uint32_t> result(model.vertexCount());
    for (const SkinModel::Group& group : model.groups())
        for (std::uint32_t i = 0; i < group.vertexCount; ++i) {
            std::uint32_t& joint = result[model.order()[group.firstVertex + i]];
            std::size_t partial = group.firstRatio + std::size_t(i) * group.partialCount;
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model.links()[group.firstLink + k];
                if (!link.partial || model.ratios()[partial++].bend >= 0.5f)
                    joint = std::max(joint, link.joint);
            }
        }
    return result;
}

struct TriangleList {
    std::uint32_t first = 0; ///< of the geometry's vertices in the figure
    std::size_t count = 0;
    std::vector<std::array<std::uint32_t, 3>>* triangles = nullptr;

    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        if (a < count && b < count && c < count)
            triangles->push_back({first + a, first + b, first + c});
    }
};

/// Adds a geometry.
/// \param jointOf of each vertex
void add(const osg::Geometry& geometry, const osg::Matrixd& toFigure,
         const std::function<std::size_t(std::size_t)>& jointOf, Figure& figure) {
    const auto* array = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
    if (!array) return;
    osg::TriangleIndexFunctor<TriangleList> list;
    list.first = static_cast<std::uint32_t>(figure.vertices.size());
    list.count = array->size();
    list.triangles = &figure.triangles;
    geometry.accept(list);
    for (std::size_t v = 0; v < array->size(); ++v) {
        figure.vertices.push_back(toGlm(osg::Vec3d((*array)[v]) * toFigure));
        figure.joints.push_back(jointOf(v));
    }
}

/// Adds where vertices are, seen from their joint, while all joints bend to one side.
///
/// \param joints in the skeleton, of the model's joints
/// \param own joint of each vertex, in the model
void addBent(const SkinModel& model, const osg::Matrixd& toFigure,
             const std::vector<std::size_t>& joints, const std::vector<std::uint32_t>& own,
             Figure& figure) {
    for (int side = 0; side < 4; ++side) {
        std::vector<glm::dmat4> skinning;
        for (const BoundJoint& joint : model.joints()) {
            const glm::dvec3 across = anyPerpendicular(joint.boneAxis);
            const glm::dvec3 axis = side / 2 ? glm::cross(joint.boneAxis, across) : across;
            const glm::dmat4 bend = glm::translate(glm::dmat4(1.0), joint.centre) *
                                    glm::rotate(glm::dmat4(1.0), side % 2 ? -kBend : kBend, axis) *
                                    glm::translate(glm::dmat4(1.0), -joint.centre);
            skinning.push_back(joint.parent < 0 ? bend
                                                : skinning[std::size_t(joint.parent)] * bend);
        }
        const std::vector<glm::vec3> bent = deform(model, skinning).positions;
        for (glm::dmat4& matrix : skinning) matrix = glm::inverse(matrix);
        for (std::size_t v = 0; v < bent.size(); ++v) {
            const glm::dvec3 seen(skinning[own[v]] * glm::dvec4(glm::dvec3(bent[v]), 1.0));
            figure.vertices.push_back(toGlm(toOsg(seen) * toFigure));
            figure.joints.push_back(joints[own[v]]);
        }
    }
}

Figure figureOf(const ClipCharacter& character, const RestSkeleton& rest) {
    Figure figure;
    const std::map<std::string, int> byName = rest.byName();
    const auto find = [&](const std::string& joint) {
        const auto found = byName.find(joint);
        return found == byName.end() ? std::size_t{0} : std::size_t(found->second);
    };
    for (const ClipCharacter::Skin& skin : character.skins()) {
        if (skin.appearance.mask == 0) continue;
        const SkinModel& model = *skin.skin->getModel();
        const std::vector<std::uint32_t> own = jointsOf(model);
        std::vector<std::size_t> joints;
        for (const BoundJoint& joint : model.joints()) joints.push_back(find(joint.name));
        add(
            *skin.skin->getRestGeometry(), skin.toWorld,
            [&](std::size_t v) { return joints[own[v]]; }, figure);
        addBent(model, skin.toWorld, joints, own, figure);
    }
    for (const ClipCharacter::Rigid& rigid : character.rigids())
        for (const osg::ref_ptr<osg::Node>& part : rigid.parts)
            if (rigid.appearance.mask != 0 && part->asGeometry()) // of the skin; props are not
                add(
                    *part->asGeometry(), character.toWorld(),
                    [joint = find(rigid.joint)](std::size_t) { return joint; }, figure);
    if (figure.triangles.empty()) throw Error("hit boxes: the character has no triangles");
    return figure;
}

double volumeOf(const Figure& figure) {
    double volume = 0.0;
    const glm::dvec3& origin = figure.vertices[figure.triangles[0][0]];
    for (const auto& [a, b, c] : figure.triangles)
        volume += glm::dot(figure.vertices[a] - origin,
                           glm::cross(figure.vertices[b] - origin, figure.vertices[c] - origin));
    return std::abs(volume) / 6.0;
}

/// Joins vertices of one joint that are very near, such as those of a seam: fewer to fit to.
void simplify(Figure& figure) {
    osg::BoundingBoxd box;
    for (const glm::dvec3& v : figure.vertices) box.expandBy(toOsg(v));
    const double cell = kCell * 2.0 * box.radius();
    if (!(cell > 0.0)) return;
    std::map<std::tuple<std::size_t, long, long, long>, std::uint32_t> cells;
    std::vector<std::uint32_t> index;
    Figure result;
    for (std::size_t v = 0; v < figure.vertices.size(); ++v) {
        const glm::dvec3& p = figure.vertices[v];
        const auto at = [&](double x) { return std::lround(x / cell); };
        const auto [found, isNew] =
            cells.try_emplace({figure.joints[v], at(p.x), at(p.y), at(p.z)},
                              static_cast<std::uint32_t>(result.vertices.size()));
        index.push_back(found->second);
        if (!isNew) continue;
        result.vertices.push_back(p);
        result.joints.push_back(figure.joints[v]);
    }
    for (const auto& [a, b, c] : figure.triangles)
        result.triangles.push_back({index[a], index[b], index[c]});
    figure = std::move(result);
}

/// Gives the vertices of joints without a limb of their own to the joints above.
void joinSmallJoints(const RestSkeleton& rest, double smallest, Figure& figure) {
    const std::size_t count = rest.joints.size();
    std::vector<LimbSurface> surfaces(count);
    for (std::size_t v = 0; v < figure.vertices.size(); ++v)
        surfaces[figure.joints[v]].points.push_back(figure.vertices[v]);
    std::vector<double> volumes(count);
    double sum = 0.0;
    const auto measure = [&](std::size_t joint) {
        return surfaces[joint].points.empty() ? 0.0 : fitShape(surfaces[joint], 1.0).volume();
    };
    for (std::size_t j = 0; j < count; ++j) sum += volumes[j] = measure(j);
    std::vector<std::size_t> limb(count);
    for (std::size_t j = count; j-- > 1;) {
        limb[j] = j;
        std::vector<glm::dvec3>& own = surfaces[j].points;
        if (own.empty() || volumes[j] >= smallest * sum) continue;
        limb[j] = std::size_t(rest.joints[j].parent);
        std::vector<glm::dvec3>& above = surfaces[limb[j]].points;
        above.insert(above.end(), own.begin(), own.end());
        volumes[limb[j]] += volumes[j];
    }
    for (std::size_t j = 1; j < count; ++j) limb[j] = limb[limb[j]]; // parents come first
    for (std::size_t& joint : figure.joints) joint = limb[joint];
}

/// The surfaces of all joints' limbs. Edges between two limbs end in their middle.
std::vector<LimbSurface> cutLimbs(const Figure& figure, std::size_t joints) {
    std::vector<LimbSurface> limbs(joints);
    std::vector<std::uint32_t> index;
    const auto addPoint = [&](std::size_t joint, const glm::dvec3& point) {
        limbs[joint].points.push_back(point);
        return static_cast<std::uint32_t>(limbs[joint].points.size() - 1);
    };
    for (std::size_t v = 0; v < figure.vertices.size(); ++v)
        index.push_back(addPoint(figure.joints[v], figure.vertices[v]));
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& corners : figure.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            edges.insert(std::minmax(corners[i], corners[(i + 1) % 3]));
    for (const auto& [a, b] : edges) {
        const std::size_t joint = figure.joints[a];
        if (figure.joints[b] == joint) {
            limbs[joint].edges.push_back({index[a], index[b]});
            continue;
        }
        const glm::dvec3 middle = 0.5 * (figure.vertices[a] + figure.vertices[b]);
        for (const std::uint32_t end : {a, b})
            limbs[figure.joints[end]].edges.push_back(
                {index[end], addPoint(figure.joints[end], middle)});
    }
    return limbs;
}

std::vector<Limb> fitLimbs(const ClipCharacter& character, const RestSkeleton& rest,
                           const HitBoxes::Options& options) {
    Figure figure = figureOf(character, rest);
    const double volume = volumeOf(figure);
    simplify(figure);
    joinSmallJoints(rest, options.smallest, figure);
    const std::vector<LimbSurface> all = cutLimbs(figure, rest.joints.size());
    std::vector<LimbSurface> surfaces;
    std::vector<Limb> limbs;
    std::vector<int> limbOf(all.size(), -1); // [joint], or that of the joint above
    for (std::size_t j = 0; j < all.size(); ++j) {
        const RestJoint& joint = rest.joints[j];
        if (joint.parent >= 0) limbOf[j] = limbOf[std::size_t(joint.parent)];
        if (all[j].points.empty()) continue;
        limbs.push_back({joint.name, limbOf[j], toOsg(joint.centre) * character.toWorld(), {}});
        limbOf[j] = static_cast<int>(limbs.size()) - 1;
        surfaces.push_back(all[j]);
    }
    const auto shapes = fitShapes(surfaces, volume, options);
    for (std::size_t i = 0; i < limbs.size(); ++i) limbs[i].shapes = shapes[i];
    findHinges(rest, character.toWorld(), limbs);
    return limbs;
}

/// Without scale and shear.
osg::Matrixd rigid(const osg::Matrixd& m) {
    osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2));
    x.normalize();
    y -= x * (x * y);
    y.normalize();
    const osg::Vec3d z = x ^ y;
    return {x.x(), x.y(), x.z(), 0.0, y.x(),   y.y(),   y.z(),   0.0,
            z.x(), z.y(), z.z(), 0.0, m(3, 0), m(3, 1), m(3, 2), 1.0};
}

osg::Vec3d directionIn(const osg::Matrixd& frame, const osg::Vec3d& v) {
    return osg::Matrixd::transform3x3(frame, v); // a rigid matrix's transpose is its inverse
}
osg::Vec3d pointIn(const osg::Matrixd& frame, const osg::Vec3d& p) {
    return directionIn(frame, p - frame.getTrans());
}

/// The signed distance of a point in a shape's frame, and the nearest point of its surface.
double distanceTo(const Shape& shape, const osg::Vec3d& p, osg::Vec3d& nearest,
                  osg::Vec3d& normal) {
    if (shape.kind == Shape::Kind::Capsule) {
        const osg::Vec3d axis(0.0, 0.0, std::clamp(p.z(), -shape.half.z(), shape.half.z()));
        normal = p - axis;
        const double away = normal.normalize();
        if (!(away > 0.0)) normal.set(1.0, 0.0, 0.0);
        nearest = axis + normal * shape.half.x();
        return away - shape.half.x();
    }
    int face = 0;
    double deepest = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const double over = std::abs(p[i]) - shape.half[i];
        nearest[i] = std::clamp(p[i], -shape.half[i], shape.half[i]);
        if (over > deepest) {
            deepest = over;
            face = i;
        }
    }
    if (deepest > 0.0) {
        normal = p - nearest;
        return normal.normalize();
    }
    normal.set(0.0, 0.0, 0.0);
    normal[face] = p[face] < 0.0 ? -1.0 : 1.0;
    nearest[face] = normal[face] * shape.half[face];
    return deepest;
}

/// Where a ray enters a shape.
///
/// \param p its start, outside, in the shape's frame
/// \param d unit
/// \return negative where it does not
double rayTo(const Shape& shape, const osg::Vec3d& p, const osg::Vec3d& d) {
    constexpr double none = -1.0;
    if (shape.kind == Shape::Kind::Box) {
        double in = 0.0, out = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {
            const double a = (-shape.half[i] - p[i]) / d[i], b = (shape.half[i] - p[i]) / d[i];
            if (d[i] == 0.0) {
                if (std::abs(p[i]) > shape.half[i]) return none;
                continue;
            }
            in = std::max(in, std::min(a, b));
            out = std::min(out, std::max(a, b));
        }
        return in <= out ? in : none;
    }
    const double radius = shape.half.x();
    // The smaller root of a t^2 + 2 b t + c.
    const auto root = [](double a, double b, double c) {
        const double square = b * b - a * c;
        return a > 0.0 && square >= 0.0 ? (-b - std::sqrt(square)) / a : none;
    };
    const double side = root(d.x() * d.x() + d.y() * d.y(), p.x() * d.x() + p.y() * d.y(),
                             p.x() * p.x() + p.y() * p.y() - radius * radius);
    if (side >= 0.0 && std::abs(p.z() + side * d.z()) <= shape.half.z()) return side;
    double first = none;
    for (const double end : {-shape.half.z(), shape.half.z()}) {
        const osg::Vec3d q = p - osg::Vec3d(0.0, 0.0, end);
        const double cap = root(1.0, q * d, q * q - radius * radius);
        if (cap >= 0.0 && (first < 0.0 || cap < first)) first = cap;
    }
    return first;
}

osg::ref_ptr<osg::Geometry> linesOf(const Shape& shape) {
    const osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    const auto line = [&](const osg::Vec3d& a, const osg::Vec3d& b) {
        points->push_back(osg::Vec3(a));
        points->push_back(osg::Vec3(b));
    };
    if (shape.kind == Shape::Kind::Box) {
        const auto corner = [&](unsigned int i) {
            return osg::Vec3d(i & 1 ? shape.half.x() : -shape.half.x(),
                              i & 2 ? shape.half.y() : -shape.half.y(),
                              i & 4 ? shape.half.z() : -shape.half.z());
        };
        for (unsigned int i = 0; i < 8; ++i)
            for (const unsigned int axis : {1u, 2u, 4u})
                if (!(i & axis)) line(corner(i), corner(i | axis));
    } else {
        constexpr int steps = 24;
        const double r = shape.half.x(), h = shape.half.z();
        const auto on = [&](int step) {
            const double angle = 2.0 * osg::PI * step / steps;
            return std::make_pair(r * std::cos(angle), r * std::sin(angle));
        };
        for (int i = 0; i < steps; ++i) {
            const auto [x, y] = on(i);
            const auto [nextX, nextY] = on(i + 1);
            const double cap = i < steps / 2 ? h : -h; // half circles above and below
            line({x, 0.0, y + cap}, {nextX, 0.0, nextY + cap});
            line({0.0, x, y + cap}, {0.0, nextX, nextY + cap});
            for (const double end : {-h, h}) line({x, y, end}, {nextX, nextY, end});
            if (i % 6 == 0) line({x, y, -h}, {x, y, h});
        }
    }
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(points);
    const osg::ref_ptr<osg::Vec4Array> colour = new osg::Vec4Array;
    colour->push_back({0.5f, 0.95f, 0.35f, 1.0f});
    geometry->setColorArray(colour, osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(
        new osg::DrawArrays(GL_LINES, 0, static_cast<GLsizei>(points->size())));
    return geometry;
}

/// Rotates bones to new directions, in the skeleton's space, and moves all bones below with them.
/// \param rotations from rest
void placeBones(osgAnimation::Bone& bone,
                const std::map<const osgAnimation::Bone*, osg::Quat>& rotations) {
    const osgAnimation::Bone* parent = bone.getBoneParent();
    const osg::Matrixd above =
        parent ? osg::Matrixd(parent->getMatrixInSkeletonSpace()) : osg::Matrixd();
    osg::Matrixd placed = bone.getMatrix() * above;
    const auto rotation = rotations.find(&bone);
    if (rotation != rotations.end()) {
        const osg::Vec3d joint = placed.getTrans();
        placed = osg::Matrixd::inverse(bone.getInvBindMatrixInSkeletonSpace());
        placed.postMultRotate(rotation->second);
        placed.setTrans(joint);
        bone.setMatrix(placed * osg::Matrixd::inverse(above));
    }
    bone.setMatrixInSkeletonSpace(placed);
    for (unsigned int i = 0; i < bone.getNumChildren(); ++i)
        if (auto* child = dynamic_cast<osgAnimation::Bone*>(bone.getChild(i)))
            placeBones(*child, rotations);
}

} // namespace

double HitBoxes::Shape::volume() const {
    if (kind == Kind::Box) return 8.0 * half.x() * half.y() * half.z();
    return osg::PI * half.x() * half.x() * (2.0 * half.z() + 4.0 / 3.0 * half.x());
}

HitBoxes::HitBoxes() : _limbs(std::make_shared<std::vector<Limb>>()) {}
HitBoxes::~HitBoxes() = default;

HitBoxes::HitBoxes(const HitBoxes& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), Attachment(other, copyop),
      _limbs(other._limbs), _toFigure(other._toFigure), _toRest(other._toRest),
      _motions(other._motions) {}

osg::ref_ptr<HitBoxes> HitBoxes::create(osg::Node& root, const Options& options) {
    const osg::ref_ptr<ClipCharacter> parts = ClipCharacter::create(root);
    const RestSkeleton rest = readSkeleton(parts->skeleton());
    Options possible = options;
    possible.inside = possible.inside >= 0.5 ? std::min(possible.inside, 1.0) : 0.5;
    possible.maxShapes = std::max(options.maxShapes, 1u);
    const osg::ref_ptr<HitBoxes> result = new HitBoxes;
    result->_limbs = std::make_shared<std::vector<Limb>>(fitLimbs(*parts, rest, possible));
    result->_toFigure = parts->toWorld();
    result->_toRest = osg::Matrixd::inverse(result->_toFigure);
    result->_motions.resize(result->_limbs->size());
    return result;
}

void HitBoxes::onAttach(osg::Node& root) {
    findBones(root);
    update();
}

int HitBoxes::find(const std::string& joint) const {
    for (std::size_t i = 0; i < _limbs->size(); ++i)
        if ((*_limbs)[i].joint == joint) return static_cast<int>(i);
    return -1;
}

std::optional<HitBoxes::Hit> HitBoxes::pick(const osg::Vec3d& start, const osg::Vec3d& end) const {
    osg::Vec3d direction = end - start;
    double length = direction.normalize();
    if (!start.valid() || !end.valid() || !std::isfinite(length)) return std::nullopt;
    std::optional<Hit> first;
    for (std::size_t i = 0; i < _limbs->size(); ++i)
        for (std::size_t k = 0; k < (*_limbs)[i].shapes.size(); ++k) {
            const Shape& shape = (*_limbs)[i].shapes[k];
            const osg::Matrixd frame = shape.frame * _motions[i];
            const osg::Vec3d p = pointIn(frame, start), d = directionIn(frame, direction);
            Hit hit{i, k, {}, {}, 0.0};
            osg::Vec3d nearest, normal;
            if (distanceTo(shape, p, nearest, normal) > 0.0) {
                hit.distance = rayTo(shape, p, d);
                if (!(hit.distance >= 0.0 && hit.distance <= length)) continue;
                distanceTo(shape, p + d * hit.distance, nearest, normal);
            }
            if (first && hit.distance >= first->distance) continue;
            hit.point = start + direction * hit.distance;
            hit.normal = osg::Matrixd::transform3x3(normal, frame);
            first = hit;
        }
    return first;
}

std::optional<HitBoxes::Hit> HitBoxes::nearest(const osg::Vec3d& point) const {
    if (!std::isfinite(point.length2())) return std::nullopt;
    std::optional<Hit> best;
    for (std::size_t i = 0; i < _limbs->size(); ++i)
        for (std::size_t k = 0; k < (*_limbs)[i].shapes.size(); ++k) {
            const Shape& shape = (*_limbs)[i].shapes[k];
            const osg::Matrixd frame = shape.frame * _motions[i];
            osg::Vec3d on, normal;
            const double distance = distanceTo(shape, pointIn(frame, point), on, normal);
            if (best && distance >= best->distance) continue;
            best = Hit{i, k, on * frame, osg::Matrixd::transform3x3(normal, frame), distance};
        }
    return best;
}

osg::ref_ptr<osg::Node> HitBoxes::makeLines() {
    const osg::ref_ptr<osg::Group> lines = new osg::Group;
    lines->setName("hit boxes");
    lines->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    for (const Limb& limb : *_limbs)
        for (const Shape& shape : limb.shapes) {
            const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
            place->setDataVariance(osg::Object::DYNAMIC);
            place->setName(limb.joint);
            place->addChild(linesOf(shape));
            lines->addChild(place);
        }
    _lines = lines;
    update();
    return lines;
}

void HitBoxes::findBones(osg::Node& character) {
    if (_character == &character) return;
    const std::map<std::string, osgAnimation::Bone*> bones = bonesBelow(character);
    _bones.assign(_limbs->size(), {});
    for (std::size_t i = 0; i < _bones.size(); ++i) {
        const auto bone = bones.find((*_limbs)[i].joint);
        if (bone != bones.end()) _bones[i] = bone->second;
    }
    _character = &character;
}

void HitBoxes::update() {
    for (std::size_t i = 0; i < _bones.size(); ++i) {
        const int parent = (*_limbs)[i].parent;
        if (const osgAnimation::Bone* bone = _bones[i].get()) {
            const osg::Matrixd motion = rigid(_toRest * bone->getInvBindMatrixInSkeletonSpace() *
                                              bone->getMatrixInSkeletonSpace() * _toFigure);
            if (motion.valid()) _motions[i] = motion;
        } else if (parent >= 0) {
            _motions[i] = _motions[std::size_t(parent)];
        }
    }
    osg::ref_ptr<osg::Group> lines;
    if (!_lines.lock(lines)) return;
    unsigned int next = 0;
    for (std::size_t i = 0; i < _limbs->size(); ++i)
        for (const Shape& shape : (*_limbs)[i].shapes)
            static_cast<osg::MatrixTransform&>(*lines->getChild(next++))
                .setMatrix(shape.frame * _motions[i]);
}

bool HitBoxes::takePose(const std::vector<osg::Matrixd>& motions) {
    const auto isValid = [](const osg::Matrixd& motion) { return motion.valid(); };
    if (motions.size() != _limbs->size() || _bones.size() != _limbs->size() ||
        !std::all_of(motions.begin(), motions.end(), isValid))
        return false;
    std::map<const osgAnimation::Bone*, osg::Quat> rotations;
    for (std::size_t i = 0; i < motions.size(); ++i)
        if (const osgAnimation::Bone* bone = _bones[i].get())
            rotations[bone] = rigid(_toFigure * rigid(motions[i]) * _toRest).getRotate();
    for (std::size_t i = 0; i < motions.size(); ++i) {
        osgAnimation::Bone* bone = _bones[i].get();
        if (!bone || (*_limbs)[i].parent >= 0) continue;
        const osg::Vec3d joint =
            osg::Matrixd::inverse(bone->getInvBindMatrixInSkeletonSpace()).getTrans() *
            (_toFigure * motions[i] * _toRest);
        const osgAnimation::Bone* parent = bone->getBoneParent();
        osg::Matrixd placed = bone->getMatrixInSkeletonSpace();
        placed.setTrans(joint);
        bone->setMatrix(parent ? placed * osg::Matrixd::inverse(parent->getMatrixInSkeletonSpace())
                               : placed);
        placeBones(*bone, rotations);
    }
    return true;
}

void HitBoxes::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    traverse(node, nv); // bones are posed
    if (!node) return;
    findBones(*node);
    update();
}

} // namespace osgSkin
