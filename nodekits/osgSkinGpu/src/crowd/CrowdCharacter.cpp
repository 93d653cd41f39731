// SPDX-License-Identifier: MIT
#include <osgSkinGpu/CrowdCharacter>

#include "crowd/CrowdText.h"
#include "model/PackTexels.h"

#include <osgSkin/Binding>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>
#include <osgSkinGpu/GpuCrowd>
#include <osgSkinGpu/GpuPalette>
#include <osgSkinMotion/ClipCharacter>

#include <osg/Array>
#include <osg/BufferObject>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/TriangleIndexFunctor>
#include <osg/Vec3>
#include <osg/ref_ptr>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#ifdef OSGSKIN_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace osgSkin {
namespace {

/// The texels of a GpuModel whose vertices all follow one joint fully.
///
/// \param joints of the palettes that it will be drawn with
/// \param positions rest space, as are the normals
osg::ref_ptr<osg::Vec4uiArray> packRigid(const std::vector<BoundJoint>& joints, unsigned int joint,
                                         const osg::Vec3Array& positions,
                                         const osg::Vec3Array& normals) {
    osg::ref_ptr<osg::Vec4uiArray> texels = new osg::Vec4uiArray;
    packJoints(joints, *texels);
    const auto chain = static_cast<unsigned int>(texels->size());
    texels->push_back(osg::Vec4ui(joint, 0, 0, 0));
    texels->front() = osg::Vec4ui(static_cast<unsigned int>(joints.size()), chain + 1,
                                  static_cast<unsigned int>(positions.size()), 0u);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        texels->push_back(packedTexel(*asGlm(&positions[v]), chain));
        texels->push_back(packedTexel(*asGlm(&normals[v]), 0));
    }
    return texels;
}

struct CollectTriangles {
    std::vector<GLuint> indices;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
    }
};

/// Indices of the triangles that a geometry draws.
///
/// \throw osgSkin::Error where a primitive is broken (brokenPrimitive())
std::vector<GLuint> trianglesOf(const osg::Geometry& geometry) {
    const std::string broken =
        brokenPrimitive(geometry, geometry.getVertexArray()->getNumElements());
    if (!broken.empty())
        throw Error("crowd: the geometry \"" + geometry.getName() + "\" has " + broken);
    osg::TriangleIndexFunctor<CollectTriangles> collect;
    geometry.accept(collect);
    return collect.indices;
}

/// The vertices of all parts, in the character's space.
struct Vertices {
    std::vector<osg::Vec3> positions, normals;
};

#ifdef OSGSKIN_HAS_MESHOPTIMIZER
constexpr bool kHasLevels = true;

/// Simplifies triangles as simplified() does, with all vertices of one position joined: those at
/// hard edges and at seams of textures, too. Of these, a triangle then has the vertices whose
/// normals fit it best.
std::vector<GLuint> simplifiedJoined(const Vertices& vertices, const std::vector<GLuint>& indices,
                                     std::size_t most, bool isFar, float error) {
    std::map<osg::Vec3, GLuint> known;
    std::vector<osg::Vec3> positions;
    std::vector<std::vector<GLuint>> alike;
    std::vector<GLuint> joined;
    for (std::size_t v = 0; v < vertices.positions.size(); ++v) {
        const osg::Vec3& at = vertices.positions[v];
        const GLuint place = known.emplace(at, static_cast<GLuint>(alike.size())).first->second;
        if (place == alike.size()) {
            positions.push_back(at);
            alike.emplace_back();
        }
        alike[place].push_back(static_cast<GLuint>(v));
    }
    joined.reserve(indices.size());
    for (const GLuint index : indices) joined.push_back(known.at(vertices.positions[index]));
    std::vector<GLuint> result(joined.size());
    const float* first = positions.front().ptr();
    std::size_t size =
        meshopt_simplify(result.data(), joined.data(), joined.size(), first, positions.size(),
                         sizeof(osg::Vec3), most, error, 0, nullptr);
    if (isFar && size > most)
        size = meshopt_simplifySloppy(result.data(), joined.data(), joined.size(), first,
                                      positions.size(), sizeof(osg::Vec3), most, error, nullptr);
    result.resize(size);
    for (std::size_t i = 0; i < size; i += 3) {
        const osg::Vec3& origin = positions[result[i]];
        const osg::Vec3 normal =
            (positions[result[i + 1]] - origin) ^ (positions[result[i + 2]] - origin);
        for (std::size_t k = i; k < i + 3; ++k) {
            const std::vector<GLuint>& choice = alike[result[k]];
            result[k] = *std::max_element(choice.begin(), choice.end(), [&](GLuint p, GLuint q) {
                return vertices.normals[p] * normal < vertices.normals[q] * normal;
            });
        }
    }
    return result;
}

/// Simplifies triangles, without moving vertices.
///
/// \param most the wanted number of indices
/// \param isFar for figures of a few pixels: `most` is reached, even if parts that do not touch are
///        joined
std::vector<GLuint> simplified(const Vertices& vertices, const std::vector<GLuint>& indices,
                               std::size_t most, bool isFar) {
    std::vector<GLuint> result(indices.size());
    if (indices.empty()) return result;
    // Relative to the extent; allowed, since the character is small in the picture.
    const float error = isFar ? 1.0f : 0.05f;
    result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(),
                                   vertices.positions.front().ptr(), vertices.positions.size(),
                                   sizeof(osg::Vec3), most, error, 0, nullptr));
    // Hard edges and seams stay, which may be all that there is.
    return result.size() <= (isFar ? most : 2 * most)
               ? result
               : simplifiedJoined(vertices, indices, most, isFar, error);
}
#else
constexpr bool kHasLevels = false;

std::vector<GLuint> simplified(const Vertices&, const std::vector<GLuint>&, std::size_t, bool) {
    throw Error("levels of detail: this osgSkinGpu was built without meshoptimizer");
}
#endif

/// The size below which the last level is used: figures of 13 pixels in a picture of 1080.
constexpr float kFarSize = 0.012f;

/// The vertex of a range that is nearest to another one, or that one if it is in the range.
GLuint nearestTo(GLuint vertex, const std::vector<osg::Vec3>& positions, GLuint first, GLuint end) {
    if (vertex >= first && vertex < end) return vertex;
    const auto nearest = std::min_element(positions.begin() + first, positions.begin() + end,
                                          [&](const osg::Vec3& a, const osg::Vec3& b) {
                                              return (a - positions[vertex]).length2() <
                                                     (b - positions[vertex]).length2();
                                          });
    return static_cast<GLuint>(nearest - positions.begin());
}

/// Texel indices that are exact in a float.
constexpr std::size_t kMaxTexels = std::size_t(1) << 24;
/// Clip numbers of CrowdInstance.
constexpr std::size_t kMaxClips = 65536;

void expandBy(osg::BoundingBox& all, const osg::BoundingBox& box, const osg::Matrixd& matrix) {
    if (!box.valid()) return;
    for (unsigned int corner = 0; corner < 8; ++corner) all.expandBy(box.corner(corner) * matrix);
}

bool isUsable(const osg::Matrixd& matrix) {
    const auto row = [&](int i) { return osg::Vec3d(matrix(i, 0), matrix(i, 1), matrix(i, 2)); };
    return std::all_of(matrix.ptr(), matrix.ptr() + 16,
                       [](double x) { return std::isfinite(x); }) &&
           std::isnormal((row(0) ^ row(1)) * row(2));
}

const osg::Vec3Array* vectors(const osg::Array* array) {
    return dynamic_cast<const osg::Vec3Array*>(array);
}

/// The index of a joint; -1 where there is none.
int jointOf(const SkinModel& model, const std::string& name) {
    const std::vector<BoundJoint>& joints = model.joints();
    const auto found = std::find_if(joints.begin(), joints.end(),
                                    [&](const BoundJoint& joint) { return joint.name == name; });
    return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

/// A state set with those of another below it; either may be null.
osg::ref_ptr<osg::StateSet> bothOf(osg::StateSet* above, osg::StateSet* below) {
    if (!above || !below) return above ? above : below;
    osg::ref_ptr<osg::StateSet> both = new osg::StateSet(*above);
    both->merge(*below);
    return both;
}

/// A geometry whose vertices and normals are transformed; shares all else.
osg::ref_ptr<const osg::Geometry> transformed(const osg::Geometry& geometry,
                                              const osg::Matrixd& matrix) {
    const osg::Vec3Array* positions = vectors(geometry.getVertexArray());
    const osg::Vec3Array* normals = vectors(geometry.getNormalArray());
    if (matrix.isIdentity() || !positions || !normals) return &geometry;
    const osg::ref_ptr<osg::Vec3Array> moved = osg::clone(positions);
    for (osg::Vec3& p : *moved) p = p * matrix;
    const osg::ref_ptr<osg::Vec3Array> turned = osg::clone(normals);
    const osg::Matrixd back = osg::Matrixd::inverse(matrix);
    for (osg::Vec3& n : *turned) {
        n = osg::Matrixd::transform3x3(back, n);
        n.normalize();
    }
    const osg::ref_ptr<osg::Geometry> result =
        new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY);
    result->setVertexArray(moved);
    result->setNormalArray(turned);
    return result;
}

/// The geometries below a node in its space, with the states above each. Those of skins are at
/// rest.
class FindGeometries : public osg::NodeVisitor {
public:
    struct Found {
        osg::ref_ptr<const osg::Geometry> geometry;
        osg::ref_ptr<osg::StateSet> state; ///< of the nodes above; may be null
    };

    explicit FindGeometries(osg::Node& below) : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {
        below.accept(*this);
    }
    void apply(osg::Drawable& drawable) override {
        const auto* skin = dynamic_cast<const DeformableSkin*>(&drawable);
        const osg::Geometry* geometry = skin ? skin->getRestGeometry() : drawable.asGeometry();
        if (!geometry || !geometry->getVertexArray()) return;
        osg::ref_ptr<osg::StateSet> state;
        for (const osg::Node* node : getNodePath())
            if (node != &drawable || skin)
                state = bothOf(state, const_cast<osg::StateSet*>(node->getStateSet()));
        all.push_back({transformed(*geometry, osg::computeLocalToWorld(getNodePath())), state});
    }

    std::vector<Found> all;
};

} // namespace

CrowdCharacter::CrowdCharacter() : _sizes{std::numeric_limits<float>::infinity()} {}

CrowdCharacter::~CrowdCharacter() = default;

osg::ref_ptr<CrowdCharacter> CrowdCharacter::create(osg::Node& character, double samplesPerSecond) {
    osg::ref_ptr<CrowdCharacter> result = new CrowdCharacter;
    result->addCharacter(*ClipCharacter::create(character), samplesPerSecond);
    result->addUsualLevels();
    return result;
}

void CrowdCharacter::addCharacter(const ClipCharacter& character, double samplesPerSecond) {
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    for (const ClipCharacter::Skin& source : character.skins()) {
        if (source.appearance.mask == 0 || source.skin->getNodeMask() == 0) continue;
        // A copy, since a player poses it, and its state is that of the nodes above, too.
        skins.push_back(osg::clone(source.skin.get(), osg::CopyOp::SHALLOW_COPY));
        skins.back()->setStateSet(bothOf(source.appearance.state, source.skin->getStateSet()));
        addSkin(*skins.back(), source.toWorld);
        player->addSkin(skins.back());
    }
    for (const ClipCharacter::Rigid& rigid : character.rigids()) {
        if (rigid.appearance.mask == 0) continue;
        std::size_t skin = 0;
        while (skin + 1 < _skins.size() && jointOf(_skins[skin].model->model(), rigid.joint) < 0)
            ++skin;
        for (const osg::ref_ptr<osg::Node>& part : rigid.parts)
            for (const FindGeometries::Found& found : FindGeometries(*part).all)
                addRigid(*found.geometry, bothOf(rigid.appearance.state, found.state), skin,
                         rigid.joint);
    }
    const auto sampled = [&](const SampledClip* clip) {
        Samples samples(skins.size());
        const std::size_t count = clip ? clip->sampleCount() : 1;
        for (std::size_t i = 0; i < count; ++i) {
            if (clip) player->setLayer(0, {clip, static_cast<double>(i) * clip->step()});
            if (clip && !player->pose())
                throw Error("crowd: the clip \"" + clip->name() + "\" cannot pose its skins");
            for (std::size_t s = 0; s < skins.size(); ++s)
                samples[s].push_back(skins[s]->getPose().skinning());
        }
        return samples;
    };
    for (const auto& animation : character.animations()) {
        const auto clip = character.sample(*animation, samplesPerSecond);
        addClip(sampled(clip), 1.0 / clip->step(),
                animation->getPlayMode() == osgAnimation::Animation::LOOP, clip->name());
    }
    if (_clips.empty()) addClip(sampled(nullptr), samplesPerSecond, true);
}

std::size_t CrowdCharacter::addSkin(const DeformableSkin& skin, const osg::Matrixd& toCharacter) {
    requireNoCrowd();
    if (!skin.getModel()) throw Error("crowd: the skin \"" + skin.getName() + "\" has no model");
    if (!_clips.empty()) throw Error("crowd: add skins before clips");
    if (!isUsable(toCharacter))
        throw Error("crowd: the matrix of the skin \"" + skin.getName() +
                    "\" is singular or not finite");
    if (skin.getMorphTargets() && !_hasToldMorphs) {
        OSG_NOTICE << onOneLine("osgSkin: crowd: the skin \"" + skin.getName() +
                                "\" has morph targets, which members are drawn without")
                   << std::endl;
        _hasToldMorphs = true;
    }
    const osg::ref_ptr<const GpuModel> model = GpuModel::of(*skin.getModel());
    addPart({new osg::Geometry(*skin.getRestGeometry(), osg::CopyOp::SHALLOW_COPY),
             const_cast<osg::StateSet*>(skin.getStateSet()),
             model->texture(),
             _skins.size(),
             -1,
             {}});
    _skins.push_back({model, toCharacter, nullptr, nullptr});
    return _skins.size() - 1;
}

void CrowdCharacter::addRigid(const osg::Geometry& geometry, osg::StateSet* state, std::size_t skin,
                              const std::string& joint) {
    requireNoCrowd();
    if (skin >= _skins.size()) throw Error("crowd: there is no skin " + std::to_string(skin));
    const std::vector<BoundJoint>& joints = _skins[skin].model->model().joints();
    const int index = jointOf(_skins[skin].model->model(), joint);
    if (index < 0) throw Error("crowd: the skin has no joint \"" + joint + "\"");
    const osg::Vec3Array* positions = vectors(geometry.getVertexArray());
    const osg::Vec3Array* normals = vectors(geometry.getNormalArray());
    if (!positions || !normals || positions->size() != normals->size())
        throw Error("crowd: the geometry \"" + geometry.getName() +
                    "\" needs Vec3Arrays of vertices and of as many normals");
    const osg::ref_ptr<osg::Vec4uiArray> texels =
        packRigid(joints, static_cast<unsigned int>(index), *positions, *normals);
    addPart({new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY),
             state,
             textureOf(*texels, GL_RGBA32UI_EXT),
             skin,
             index,
             {}});
}

void CrowdCharacter::addPart(Part part) {
    if (_sizes.size() > 1) throw Error("crowd: add parts before levels of detail");
    part.indices.push_back(trianglesOf(*part.rest));
    _parts.push_back(std::move(part));
}

void CrowdCharacter::expandByRigids(osg::BoundingBox& bounds, std::size_t skin,
                                    const std::vector<glm::dmat4>& skinning) const {
    for (const Part& part : _parts)
        if (part.skin == skin && part.joint >= 0)
            expandBy(bounds, part.rest->getBoundingBox(),
                     toOsg(skinning[static_cast<std::size_t>(part.joint)]) *
                         _skins[skin].toCharacter);
}

void CrowdCharacter::requireRoomFor(std::size_t samples) const {
    if (_clips.size() >= kMaxClips) throw Error("crowd: there are 65,536 clips already");
    for (const Skin& skin : _skins) {
        std::size_t all = samples;
        for (const Clip& clip : _clips) all += clip.samples;
        const std::size_t texels = skin.model->paletteSize();
        if (all > (kMaxTexels - _clips.size() - 1) / texels)
            throw Error("crowd: all clips together have more than 16,777,216 texels");
    }
}

void CrowdCharacter::bake(const Samples& samples, Clip& clip, osg::BoundingBox& bounds) const {
    for (std::size_t s = 0; s < _skins.size(); ++s) {
        const GpuModel& model = *_skins[s].model;
        Pose pose(model.model().joints(), model.model().inputs().size());
        clip.palettes.emplace_back(clip.samples * model.paletteSize());
        for (std::size_t i = 0; i < clip.samples; ++i) {
            const std::vector<glm::dmat4>& skinning = samples[s][i];
            // Continued, so that interpolation takes the shorter rotation.
            if (!pose.set(skinning.data(), skinning.size(),
                          i == 0 ? Pose::Twist::Shortest : Pose::Twist::Continued))
                throw Error("crowd: sample " + std::to_string(i) + " of a clip cannot be used");
            writePalette(model, pose, &clip.palettes.back()[i * model.paletteSize()]);
            expandBy(bounds, toOsg(computePoseBounds(model.model(), pose)), _skins[s].toCharacter);
            expandByRigids(bounds, s, skinning);
        }
    }
}

unsigned int CrowdCharacter::addClip(const Samples& samples, double samplesPerSecond, bool loops,
                                     const std::string& name) {
    requireNoCrowd();
    const auto rate = static_cast<float>(samplesPerSecond); // as shaders have it
    if (_skins.empty() || samples.size() != _skins.size() || samples.front().empty() ||
        !std::isnormal(rate) || rate < 0.0f)
        throw Error("crowd: a clip needs samples for each skin, and a rate above 0");
    for (const auto& ofSkin : samples)
        if (ofSkin.size() != samples.front().size())
            throw Error("crowd: a clip needs equally many samples for each skin");
    requireRoomFor(samples.front().size());
    osg::BoundingBox bounds = _bounds;
    Clip clip{samples.front().size(), double(rate), loops, name, {}};
    bake(samples, clip, bounds);
    std::vector<Skin> skins = _skins;
    writeClips(clip, skins);
    _clips.push_back(std::move(clip));
    _skins.swap(skins);
    _bounds = bounds;
    return static_cast<unsigned int>(_clips.size() - 1);
}

void CrowdCharacter::writeClips(const Clip& last, std::vector<Skin>& skins) const {
    std::vector<const Clip*> clips;
    for (const Clip& clip : _clips) clips.push_back(&clip);
    clips.push_back(&last);
    for (std::size_t s = 0; s < skins.size(); ++s) {
        const osg::ref_ptr<osg::Vec4Array> texels =
            new osg::Vec4Array(static_cast<unsigned int>(clips.size()));
        for (std::size_t c = 0; c < clips.size(); ++c) {
            const Clip& clip = *clips[c];
            (*texels)[c] = {static_cast<float>(texels->size()), static_cast<float>(clip.samples),
                            static_cast<float>(clip.samplesPerSecond), clip.loops ? 1.0f : 0.0f};
            texels->insert(texels->end(), clip.palettes[s].begin(), clip.palettes[s].end());
        }
        skins[s].samples = texels;
        skins[s].clips = textureOf(*texels, GL_RGBA32F_ARB);
    }
}

unsigned int CrowdCharacter::clip(const std::string& name) const {
    std::string known;
    for (const Clip& clip : _clips) {
        if (clip.name == name) return static_cast<unsigned int>(&clip - _clips.data());
        known += (known.empty() ? "\"" : ", \"") + clip.name + "\"";
    }
    throw Error("crowd: no clip \"" + name + "\", expected one of " + known);
}

double CrowdCharacter::loopSeconds(unsigned int clip) const {
    const Clip& of = _clips[clip];
    return of.loops ? static_cast<double>(of.samples) / of.samplesPerSecond : 0.0;
}

bool CrowdCharacter::setSample(unsigned int clip, std::size_t sample, std::size_t skin,
                               const Pose& pose) {
    if (clip >= _clips.size() || sample >= _clips[clip].samples || skin >= _skins.size())
        return false;
    const GpuModel& model = *_skins[skin].model;
    osg::Vec4Array& texels = *_skins[skin].samples;
    const auto first = static_cast<std::size_t>(texels[clip].x());
    if (!writePalette(model, pose, &texels[first + sample * model.paletteSize()])) return false;
    texels.dirty();
    const osg::BoundingBox before = _bounds;
    expandBy(_bounds, toOsg(computePoseBounds(model.model(), pose)), _skins[skin].toCharacter);
    expandByRigids(_bounds, skin, pose.skinning());
    if (_bounds == before) return true;
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const osg::observer_ptr<GpuCrowd>& crowd : _crowds) {
        osg::ref_ptr<GpuCrowd> living;
        if (crowd.lock(living)) living->boundsChanged();
    }
    return true;
}

void CrowdCharacter::requireNoCrowd() const {
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_hasCrowd) throw Error("crowd: a character with a crowd cannot be changed");
}

void CrowdCharacter::addCrowd(GpuCrowd& crowd) {
    const std::lock_guard<std::mutex> lock(_mutex);
    _crowds.erase(std::remove_if(_crowds.begin(), _crowds.end(),
                                 [](const auto& known) { return !known.valid(); }),
                  _crowds.end());
    _crowds.emplace_back(&crowd);
    _hasCrowd = true;
}

std::size_t CrowdCharacter::addLevel(double triangles, double size) {
    requireNoCrowd();
    if (_sizes.size() >= kMaxLevels) throw Error("crowd: there are eight levels already");
    const auto below = static_cast<float>(size); // as shaders have it
    if (!(triangles >= 0.0 && triangles < _share && below >= 0.0f && below < _sizes.back()))
        throw Error("crowd: a level of detail needs fewer triangles, and a smaller size, than the "
                    "one before");
    const std::size_t count = appendLevel(
        static_cast<std::size_t>(triangles * static_cast<double>(triangleCount(0))), false, below);
    _share = triangles;
    return count;
}

void CrowdCharacter::addUsualLevels() {
    if (_sizes.size() > 1) throw Error("crowd: there are levels of detail already");
    if (!kHasLevels) return;
    addLevel(0.4, 0.25);
    addLevel(0.15, 0.1);
    addLevel(0.05, 0.04);
    _hasFar = triangleCount(levelCount() - 1) > kFarTriangles;
    if (_hasFar) appendLevel(kFarTriangles, true, kFarSize);
    _share = 0.0;
}

std::size_t CrowdCharacter::appendLevel(std::size_t triangles, bool isFar, float size) {
    Vertices vertices;
    std::vector<osg::Vec3>& positions = vertices.positions;
    std::vector<GLuint> indices;
    std::vector<GLuint> firsts; // vertices of the parts, then their end
    for (const Part& part : _parts) {
        firsts.push_back(static_cast<GLuint>(positions.size()));
        const osg::Matrixd& toCharacter = _skins[part.skin].toCharacter;
        for (const osg::Vec3& p : *vectors(part.rest->getVertexArray()))
            positions.push_back(p * toCharacter);
        for (const osg::Vec3& n : *vectors(part.rest->getNormalArray()))
            vertices.normals.push_back(osg::Matrixd::transform3x3(n, toCharacter));
        for (const GLuint index : part.indices.front()) indices.push_back(firsts.back() + index);
    }
    firsts.push_back(static_cast<GLuint>(positions.size()));
    const std::vector<GLuint> kept = simplified(vertices, indices, 3 * triangles, isFar);
    const auto partOf = [&](GLuint vertex) {
        return static_cast<std::size_t>(std::upper_bound(firsts.begin(), firsts.end(), vertex) -
                                        firsts.begin() - 1);
    };
    for (Part& part : _parts) part.indices.emplace_back();
    for (std::size_t i = 0; i < kept.size(); i += 3) {
        // A triangle between two parts is drawn by one of them, with its nearest vertex.
        const std::size_t p =
            partOf(kept[i]) == partOf(kept[i + 1]) ? partOf(kept[i]) : partOf(kept[i + 2]);
        std::array<GLuint, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = nearestTo(kept[i + k], positions, firsts[p], firsts[p + 1]) - firsts[p];
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            continue;
        std::vector<GLuint>& own = _parts[p].indices.back();
        own.insert(own.end(), corners.begin(), corners.end());
    }
    _sizes.push_back(size);
    return triangleCount(_sizes.size() - 1);
}

std::size_t CrowdCharacter::triangleCount(std::size_t level) const {
    std::size_t count = 0;
    for (const Part& part : _parts) count += part.indices[level].size() / 3;
    return count;
}

} // namespace osgSkin
