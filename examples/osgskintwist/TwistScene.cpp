// SPDX-License-Identifier: MIT
#include "TwistScene.h"

#include "Blending.h"

#include <osgSkin/GlmOsg>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinRig/Clip>
#include <osgSkinRig/MakeSkeleton>

#include <Ground.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>
#include <osg/Camera>
#include <osg/Image>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osg/Vec3>
#include <osg/ref_ptr>
#include <osgAnimation/BoneMapVisitor>
#include <osgAnimation/UpdateBone>
#include <osgText/Text>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace twist {

namespace {

/// A row of drawn vertices: one circle of the surface of revolution.
struct Row {
    double radius, z;
    double along;       ///< length of the outline up to here
    glm::dvec2 normal;  ///< radial component, and along z
    std::uint32_t ring; ///< index in the mesh; a cap's rim and the end of the side share a ring
    bool startsSurface; ///< not connected to the previous row
};

/// The outline from the centre of the lower cap along the side to the centre of the upper cap.
std::vector<Row> outline() {
    constexpr double half = Cylinder::kHalfLength;
    constexpr std::uint32_t caps = Cylinder::kCapRings;
    constexpr std::uint32_t steps = Cylinder::kSteps;
    std::vector<Row> rows;
    for (std::uint32_t i = 0; i <= caps; ++i) {
        const double radius = double(i) / caps;
        rows.push_back({radius, -half, radius, {0, -1}, i, i == 0});
    }
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const double up = 2.0 * half * i / steps;
        rows.push_back({1.0, up - half, up, {1, 0}, caps + i, i == 0});
    }
    for (std::uint32_t i = 0; i <= caps; ++i) {
        const double inwards = double(i) / caps;
        rows.push_back({1.0 - inwards, half, inwards, {0, 1}, caps + steps + i, i == 0});
    }
    return rows;
}

constexpr std::uint32_t kRings = 2 * Cylinder::kCapRings + Cylinder::kSteps + 1;

/// Index of a mesh vertex: one vertex at the centre of each cap, kSegments on every ring in
/// between.
std::uint32_t meshVertex(std::uint32_t ring, std::uint32_t column) {
    if (ring == 0) return 0;
    if (ring == kRings - 1) return 1 + (kRings - 2) * Cylinder::kSegments;
    return 1 + (ring - 1) * Cylinder::kSegments + column % Cylinder::kSegments;
}

void addFace(osgSkin::SkinMesh& mesh, const Row& low, const Row& high, std::uint32_t column) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t vertex :
         {meshVertex(low.ring, column), meshVertex(low.ring, column + 1),
          meshVertex(high.ring, column + 1), meshVertex(high.ring, column)})
        if (corners.empty() || (vertex != corners.back() && vertex != corners.front()))
            corners.push_back(vertex);
    mesh.faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
    mesh.faceVertices.insert(mesh.faceVertices.end(), corners.begin(), corners.end());
}

} // namespace

Cylinder::Cylinder() {
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::Vec2Array> texture = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    mesh.positions.resize(2 + (kRings - 2) * kSegments);
    rings.resize(kSteps + 1);

    const std::vector<Row> rows = outline();
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const Row& row = rows[r];
        const auto start = static_cast<std::uint32_t>(vertices->size());
        // The first column is duplicated, because the texture wraps around there.
        for (std::uint32_t i = 0; i <= kSegments; ++i) {
            const double angle = glm::two_pi<double>() * (i % kSegments) / kSegments;
            const glm::dvec2 way(std::cos(angle), std::sin(angle));
            const glm::dvec3 position(row.radius * way, row.z);
            const std::uint32_t vertex = meshVertex(row.ring, i);
            mesh.positions[vertex] = position;
            vertices->push_back(osgSkin::toOsg(position));
            normals->push_back(osgSkin::toOsg(glm::dvec3(row.normal.x * way, row.normal.y)));
            texture->push_back(osg::Vec2(float(i) / kSegments,
                                         static_cast<float>(row.along / (2.0 * kChequerLength))));
            part.sourceVertex.push_back(vertex);
            if (i == kSegments) continue;
            if (row.normal.y == 0.0) rings[row.ring - kCapRings].push_back(vertex);
            if (row.startsSurface) continue;
            const std::uint32_t c = start + i;
            const std::uint32_t b = c - (kSegments + 1);
            const auto face = static_cast<std::uint32_t>(mesh.faceSizes.size());
            addFace(mesh, rows[r - 1], row, i);
            const bool lowPoint = rows[r - 1].radius == 0.0;
            const bool highPoint = row.radius == 0.0;
            if (!lowPoint) {
                for (const std::uint32_t v : {b, b + 1, c}) triangles->push_back(v);
                part.sourceFace.push_back(face);
            }
            if (!highPoint) {
                for (const std::uint32_t v : {b + 1, c + 1, c}) triangles->push_back(v);
                part.sourceFace.push_back(face);
            }
        }
    }
    part.geometry = new osg::Geometry;
    part.geometry->setVertexArray(vertices);
    part.geometry->setNormalArray(normals);
    part.geometry->setTexCoordArray(0, texture);
    part.geometry->addPrimitiveSet(triangles);
}

namespace {

/// Transforms a normal by the cofactor matrix. It equals the inverse transpose up to a factor, and
/// also exists if linear blending has flattened the skin.
glm::dvec3 turnNormal(const glm::dmat4& matrix, const glm::dvec3& normal) {
    const glm::dvec3 x(matrix[0]);
    const glm::dvec3 y(matrix[1]);
    const glm::dvec3 z(matrix[2]);
    const glm::dvec3 turned =
        glm::dmat3(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)) * normal;
    const double length = glm::length(turned);
    return length > 1e-12 ? turned / length : normal;
}

} // namespace

PeerSkin::PeerSkin(const osgSkin::MeshPart& part, std::vector<glm::dvec3> rest,
                   compare::SkinWeights weights, Blend blend)
    : _part(part), _rest(std::move(rest)), _weights(std::move(weights)), _blend(std::move(blend)),
      _positions(_rest),
      _geometry(new osg::Geometry(*part.geometry, osg::CopyOp::DEEP_COPY_ARRAYS)) {
    _geometry->setUseDisplayList(false);
    _geometry->setUseVertexBufferObjects(true);
    // Updates write the arrays in place, so they must wait for the draw to finish.
    _geometry->setDataVariance(osg::Object::DYNAMIC);
}

void PeerSkin::setPose(const std::vector<glm::dmat4>& skinning) {
    const std::vector<glm::dmat4> matrices = _blend(_weights, skinning);
    _positions = compare::transformPoints(matrices, _rest);
    const auto& rest = static_cast<const osg::Vec3Array&>(*_part.geometry->getNormalArray());
    auto& vertices = static_cast<osg::Vec3Array&>(*_geometry->getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*_geometry->getNormalArray());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::uint32_t v = _part.sourceVertex[i];
        vertices[i] = osgSkin::toOsg(_positions[v]);
        normals[i] = osgSkin::toOsg(turnNormal(matrices[v], osgSkin::toGlm(osg::Vec3d(rest[i]))));
    }
    vertices.dirty();
    normals.dirty();
    _geometry->dirtyBound();
}

namespace {

constexpr char kUpperBone[] = "upper";

/// Two bones; the upper one rotates about the origin. Both ends of the chain lie inside the skin,
/// like a body's hips and wrists. The end joint never rotates, but defines the upper bone's length.
osgSkin::RestSkeleton twoBones() {
    constexpr double end = Cylinder::kHalfLength - 0.5;
    osgSkin::RestSkeleton bones;
    bones.joints = {{"lower", -1, {0, 0, -end}, {}},
                    {kUpperBone, 0, {0, 0, 0}, {}},
                    {"end", 1, {0, 0, end}, glm::dvec3(0, 0, Cylinder::kHalfLength)}};
    return bones;
}

/// Weights of the two bones, which change within one radius on both sides of the joint.
compare::SkinWeights smoothWeights(const std::vector<glm::dvec3>& rest) {
    compare::SkinWeights weights;
    for (const glm::dvec3& position : rest) {
        const double t = std::clamp(0.5 * (position.z + 1.0), 0.0, 1.0);
        const double upper = t * t * (3.0 - 2.0 * t);
        weights.add({{0, 1.0 - upper}, {1, upper}});
    }
    return weights;
}

/// The stacked element of the bone's update callback that rotates it; an animation would change it,
/// here a key press does.
osg::ref_ptr<osgAnimation::StackedQuaternionElement> turnOf(osgAnimation::Skeleton& skeleton) {
    osgAnimation::BoneMapVisitor visitor;
    skeleton.accept(visitor);
    auto& update = dynamic_cast<osgAnimation::UpdateBone&>(
        *visitor.getBoneMap().at(kUpperBone)->getUpdateCallback());
    for (const auto& element : update.getStackedTransforms())
        if (auto* turn = dynamic_cast<osgAnimation::StackedQuaternionElement*>(element.get()))
            return turn;
    return nullptr; // never happens: makeSkeleton() adds one to every bone
}

} // namespace

const char* nameOf(Method method) {
    switch (method) {
    case Method::Linear:
        return "linear blending";
    case Method::DualQuaternion:
        return "dual quaternions";
    default:
        return "osgSkin";
    }
}

Comparison::Comparison()
    : _update(new osgUtil::UpdateVisitor),
      _linear(_cylinder.part, _cylinder.mesh.positions, smoothWeights(_cylinder.mesh.positions),
              compare::linearBlendMatrices),
      _dualQuaternion(_cylinder.part, _cylinder.mesh.positions,
                      smoothWeights(_cylinder.mesh.positions),
                      compare::dualQuaternionBlendMatrices) {
    const osgSkin::RestSkeleton bones = twoBones();
    _skeleton = osgSkin::makeSkeleton(bones);
    osgSkin::BindOptions
        options; // the paper's model alone, because shapes flatten the fold and lose volume
    options.shapes = osgSkin::BindOptions::Shapes::None;
    const osgSkin::AttachedSkin attached =
        osgSkin::attachSkin(*_skeleton, _cylinder.mesh, {_cylinder.part},
                            osgSkin::bind(_cylinder.mesh, bones, options));
    _skin = attached.skins.front().drawable;
    _skinSource = attached.skins.front().part.sourceVertex;
    _turn = turnOf(*_skeleton);
    setPose({});
}

void Comparison::setPose(const TwistPose& pose) {
    const glm::dquat rotation = pose.rotation();
    _turn->setQuaternion(osgSkin::toOsg(rotation));
    // The joint is at the origin, so its skinning matrix is a pure rotation.
    const std::vector<glm::dmat4> skinning{glm::dmat4(1.0), glm::mat4_cast(rotation)};
    _linear.setPose(skinning);
    _dualQuaternion.setPose(skinning);
}

osg::Node* Comparison::node(Method method) const {
    if (method == Method::Ours) return _skeleton.get();
    return (method == Method::Linear ? _linear : _dualQuaternion).geometry();
}

std::vector<glm::dvec3> Comparison::positions(Method method) {
    if (method == Method::Linear) return _linear.positions();
    if (method == Method::DualQuaternion) return _dualQuaternion.positions();
    _skeleton->accept(*_update);
    const auto& posed =
        static_cast<const osg::Vec3Array&>(*_skin->getDeformedGeometry()->getVertexArray());
    std::vector<glm::dvec3> result(_cylinder.mesh.positions.size());
    for (std::size_t i = 0; i < posed.size(); ++i)
        result[_skinSource[i]] = osgSkin::toGlm(osg::Vec3d(posed[i]));
    return result;
}

FigureMaker::FigureMaker(const Cylinder& cylinder)
    : _cylinder(cylinder), _triangles(cylinder.mesh.triangles()),
      _edges(compare::faceEdges(cylinder.mesh.faceSizes, cylinder.mesh.faceVertices)) {
    for (const auto& ring : cylinder.rings) _side.insert(_side.end(), ring.begin(), ring.end());
}

Figures FigureMaker::measure(const std::vector<glm::dvec3>& posed, const TwistPose& pose) const {
    const std::vector<glm::dvec3>& rest = _cylinder.mesh.positions;
    Figures figures;
    figures.volume =
        compare::enclosedVolume(posed, _triangles) / compare::enclosedVolume(rest, _triangles);
    const auto area = [&](const std::vector<std::uint32_t>& ring) {
        return compare::loopArea(posed, ring) / compare::loopArea(rest, ring);
    };
    for (const auto& ring : _cylinder.rings)
        figures.leastArea = std::min(figures.leastArea, area(ring));
    figures.jointArea = area(_cylinder.jointRing());
    const glm::dvec3 joint(0.0);
    const glm::dvec3 up(0.0, 0.0, Cylinder::kHalfLength);
    figures.bulge = compare::bulge(rest, posed, _side, {{-up, joint}, {joint, up}},
                                   {{-up, joint}, {joint, pose.rotation() * up}});
    figures.strain = compare::edgeStrain(rest, posed, _edges);
    return figures;
}

double linearBlendJointArea(const TwistPose& pose) {
    // (1 + R) / 2 rotates by theta / 2 and scales by c = cos(theta / 2) perpendicular to R's axis.
    // Vector areas are transformed by the cofactors: c perpendicular to the axis, c^2 along it.
    const glm::dquat q = pose.rotation();
    const double c = std::abs(q.w);
    const double sine = glm::length(glm::dvec3(q.x, q.y, q.z));
    const double along = sine > 0.0 ? q.z / sine : 1.0;
    return std::hypot(c * c * along, c * std::sqrt(std::max(0.0, 1.0 - along * along)));
}

namespace {

// Units of the overlay: pixels at the initial size of the window.
constexpr double kWidth = 1280.0;
constexpr double kHeight = 640.0;

constexpr int kTexels = 32; ///< along a chequer's edge

void paint(osg::Image& image, int column, int row, const osg::Vec3& colour) {
    for (int y = 0; y < kTexels; ++y)
        for (int x = 0; x < kTexels; ++x)
            image.setColor(osg::Vec4(colour, 1.0f), static_cast<unsigned int>(column * kTexels + x),
                           static_cast<unsigned int>(row * kTexels + y));
}

/// Text in OSG's built-in font, which needs no font file.
osg::ref_ptr<osgText::Text> makeText(float size, osgText::Text::AlignmentType alignment) {
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setCharacterSize(size);
    text->setAlignment(alignment);
    text->setColor(osg::Vec4(0.93f, 0.94f, 0.95f, 1.0f));
    text->setDataVariance(osg::Object::DYNAMIC); // its numbers change with every pose
    text->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return text;
}

/// Text in the scene that always faces the camera, centred below `position`.
osg::ref_ptr<osgText::Text> makeLabel(const osg::Vec3& position) {
    osg::ref_ptr<osgText::Text> label = makeText(0.37f, osgText::Text::CENTER_TOP);
    label->setAxisAlignment(osgText::Text::SCREEN);
    label->setPosition(position);
    // The text extends below the floor, so it is drawn last, over everything.
    osg::StateSet& state = *label->getOrCreateStateSet();
    state.setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    state.setRenderBinDetails(10, "RenderBin");
    return label;
}

/// Draws `title` at the upper left corner and `lines` below it, over the scene.
osg::ref_ptr<osg::Camera> makeOverlay(osgText::Text* title, osgText::Text* lines) {
    osg::ref_ptr<osg::Camera> overlay = new osg::Camera;
    overlay->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    overlay->setProjectionMatrixAsOrtho2D(0.0, kWidth, 0.0, kHeight);
    overlay->setViewMatrix(osg::Matrix::identity());
    overlay->setClearMask(GL_DEPTH_BUFFER_BIT);
    overlay->setRenderOrder(osg::Camera::POST_RENDER);
    overlay->setAllowEventFocus(false);
    title->setPosition(osg::Vec3(20.0f, float(kHeight) - 16.0f, 0.0f));
    lines->setPosition(osg::Vec3(20.0f, float(kHeight) - 60.0f, 0.0f));
    lines->setDrawMode(osgText::Text::TEXT | osgText::Text::FILLEDBOUNDINGBOX);
    lines->setBoundingBoxMargin(8.0f);
    lines->setBoundingBoxColor(osg::Vec4(0.08f, 0.09f, 0.10f, 1.0f)); // readable over a cylinder
    overlay->addChild(title);
    overlay->addChild(lines);
    return overlay;
}

/// Chequers in white and `colour`, with one dark stripe along the limb to show the twist.
osg::ref_ptr<osg::Texture2D> makeChequers(unsigned int around, const osg::Vec3& colour) {
    const osg::Vec3 white(0.93f, 0.92f, 0.89f);
    const int columns = static_cast<int>(around);
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns * kTexels, 2 * kTexels, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int column = 0; column < columns; ++column)
        for (int row = 0; row < 2; ++row)
            paint(*image, column, row, (column + row) % 2 == 0 ? white : colour);
    // The column that faces the camera at rest.
    for (int row = 0; row < 2; ++row)
        paint(*image, 3 * columns / 4, row, osg::Vec3(0.12f, 0.13f, 0.16f));
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    texture->setMaxAnisotropy(8.0f);
    return texture;
}

constexpr float kSpacing = 6.4f; ///< a copy bent by 90 degrees does not reach the next one
const std::array<osg::Vec3, kMethods.size()> kColours{
    osg::Vec3(0.10f, 0.55f, 0.45f), osg::Vec3(0.85f, 0.42f, 0.12f), osg::Vec3(0.25f, 0.42f, 0.80f)};

float placeOf(std::size_t copy) {
    return kSpacing * (static_cast<float>(copy) - 1.0f);
}

/// A light from the camera's side, so that chequers in the shade are visible.
osg::ref_ptr<osg::Node> makeFillLight() {
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::Light& light = *source->getLight();
    light.setLightNum(1);
    light.setPosition(osg::Vec4(0.1f, -1.0f, 0.1f, 0.0f));
    light.setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light.setDiffuse(osg::Vec4(0.42f, 0.42f, 0.44f, 1.0f));
    return source;
}

void show(osg::Node& node, bool visible) {
    node.setNodeMask(visible ? ~0u : 0u);
}

} // namespace

example::View sceneView() {
    return {{1.4, -54.0, 11.0}, {1.4, 0.0, 3.3}, {0, 0, 1}, 11.5};
}

TwistScene::TwistScene()
    : _figures(_comparison.cylinder()), _root(new osg::Group),
      _title(makeText(26.0f, osgText::Text::LEFT_TOP)),
      _help(makeText(18.0f, osgText::Text::LEFT_TOP)) {
    const osg::ref_ptr<osg::Group> figures = new osg::Group;
    const osg::ref_ptr<osg::Group> labels = new osg::Group;
    for (std::size_t i = 0; i < kMethods.size(); ++i) {
        _copies[i] = makeCopy(kMethods[i], kColours[i], placeOf(i));
        figures->addChild(_copies[i]);
        _labels[i] = makeLabel(osg::Vec3(placeOf(i), -1.6f, 0.0f));
        labels->addChild(_labels[i]);
    }
    const osg::ref_ptr<osg::Group> lit = example::withShadow(figures);
    lit->addChild(makeFillLight());
    lit->addChild(example::makeFloor(40.0f));
    lit->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    _root->addChild(lit);
    _root->addChild(labels);
    _root->addChild(makeOverlay(_title, _help));
    setPose({});
}

osg::ref_ptr<osg::Node> TwistScene::makeCopy(Method method, const osg::Vec3& colour, float x) {
    osg::ref_ptr<osg::MatrixTransform> copy = new osg::MatrixTransform(
        osg::Matrix::translate(x, 0.0, Cylinder::kHalfLength)); // on the floor
    copy->setDataVariance(osg::Object::DYNAMIC);
    copy->addChild(_comparison.node(method));
    const osg::ref_ptr<osg::Material> white = new osg::Material; // the texture has the colours
    white->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0.85f, 0.85f, 0.85f, 1.0f));
    white->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.85f, 0.85f, 0.85f, 1.0f));
    copy->getOrCreateStateSet()->setAttributeAndModes(white);
    copy->getOrCreateStateSet()->setTextureAttributeAndModes(
        0, makeChequers(Cylinder::kChequersAround, colour));
    return copy;
}

void TwistScene::setPose(const TwistPose& pose) {
    _pose = pose;
    _comparison.setPose(pose);
    char text[120];
    for (std::size_t i = 0; i < kMethods.size(); ++i) {
        const Figures figures = _figures.measure(_comparison.positions(kMethods[i]), pose);
        std::snprintf(text, sizeof text, "%s\nvolume %.2f\nleast area %.2f\nedge strain %.2f",
                      nameOf(kMethods[i]), figures.volume, figures.leastArea, figures.strain.rms);
        _labels[i]->setText(text);
    }
    std::snprintf(text, sizeof text, "bend %.0f    twist %.0f", pose.bend, pose.twist);
    _title->setText(text);
}

void TwistScene::toggle(std::size_t copy) {
    const bool visible = _copies[copy]->getNodeMask() == 0u;
    show(*_copies[copy], visible);
    show(*_labels[copy], visible);
}

void TwistScene::setHelp(const std::string& lines) {
    _help->setText(lines);
}

namespace {

constexpr double kStep = 5.0; ///< degrees per key press
constexpr double kMaxBend = 150.0;
constexpr double kMaxTwist = 330.0;
constexpr double kSwing = 170.0;     ///< amplitude of the twist; it would jump at 180 degrees
constexpr double kBendSeconds = 5.0; ///< there and back
constexpr double kTwistSeconds = 7.0;

const char kHelp[] = "left, right   bend\n"
                     "up, down      twist\n"
                     "b, t          animate bend, twist\n"
                     "space         pause\n"
                     "r             reset\n"
                     "1, 2, 3       show or hide a copy\n"
                     "w             wireframe\n"
                     "h             hide this help\n"
                     "Escape        leave";
const char kHint[] = "h  help";

} // namespace

TwistKeys::TwistKeys(TwistScene& scene) : _scene(scene) {
    _scene.setHelp(kHint);
}

bool TwistKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) {
    if (event.getHandled()) return false;
    if (event.getEventType() == osgGA::GUIEventAdapter::FRAME) {
        if (_lastFrame >= 0.0) advance(event.getTime() - _lastFrame);
        _lastFrame = event.getTime();
        return false; // other handlers also need the event
    }
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN || !press(event.getKey()))
        return false;
    action.requestRedraw();
    return true; // OSG's own handlers must not receive b, t and space
}

bool TwistKeys::press(int key) {
    switch (key) {
    case osgGA::GUIEventAdapter::KEY_Left:
        turn(-kStep, 0.0);
        return true;
    case osgGA::GUIEventAdapter::KEY_Right:
        turn(kStep, 0.0);
        return true;
    case osgGA::GUIEventAdapter::KEY_Up:
        turn(0.0, kStep);
        return true;
    case osgGA::GUIEventAdapter::KEY_Down:
        turn(0.0, -kStep);
        return true;
    case 'b':
        _bending = !_bending;
        return true;
    case 't':
        _twisting = !_twisting;
        return true;
    case ' ':
        _paused = !_paused;
        return true;
    case 'r':
        _bending = _twisting = _paused = false;
        _bendTime = _twistTime = 0.0;
        _scene.setPose({});
        return true;
    case 'h':
        _help = !_help;
        _scene.setHelp(_help ? kHelp : kHint);
        return true;
    case '1':
    case '2':
    case '3':
        _scene.toggle(static_cast<std::size_t>(key - '1'));
        return true;
    default:
        return false;
    }
}

void TwistKeys::advance(double seconds) {
    if (_paused || !(_bending || _twisting)) return;
    TwistPose pose = _scene.pose();
    if (_bending) {
        _bendTime += seconds;
        pose.bend = 0.5 * kMaxBend * (1.0 - std::cos(2.0 * osg::PI * _bendTime / kBendSeconds));
    }
    if (_twisting) {
        _twistTime += seconds;
        pose.twist = kSwing * std::sin(2.0 * osg::PI * _twistTime / kTwistSeconds);
    }
    _scene.setPose(pose);
}

void TwistKeys::turn(double bend, double twist) {
    const TwistPose& pose = _scene.pose();
    _scene.setPose({std::clamp(pose.bend + bend, -kMaxBend, kMaxBend),
                    std::clamp(pose.twist + twist, -kMaxTwist, kMaxTwist)});
}

} // namespace twist
