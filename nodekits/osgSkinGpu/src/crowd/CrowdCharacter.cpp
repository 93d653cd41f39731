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

#include <osg/Array>
#include <osg/BufferObject>
#include <osg/Geometry>
#include <osg/Notify>
#include <osg/TriangleIndexFunctor>
#include <osg/Vec3>
#include <osg/ref_ptr>

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Simplifies triangles, without moving vertices.
///
/// \param positions of the vertices; equal ones stay joined
/// \param most the wanted number of indices
/// \throw osgSkin::Error where this kit was built without meshoptimizer
std::vector<GLuint> simplified([[maybe_unused]] const std::vector<osg::Vec3>& positions,
                               [[maybe_unused]] const std::vector<GLuint>& indices,
                               [[maybe_unused]] std::size_t most) {
#ifdef OSGSKIN_HAS_MESHOPTIMIZER
    std::vector<GLuint> result(indices.size());
    if (indices.empty()) return result;
    // Relative to the extent; allowed, since the character is small in the picture.
    const float error = 0.05f;
    const std::size_t size =
        meshopt_simplify(result.data(), indices.data(), indices.size(), positions.front().ptr(),
                         positions.size(), sizeof(osg::Vec3), most, error, 0, nullptr);
    result.resize(size);
    return result;
#else
    throw Error("levels of detail: this osgSkinGpu was built without meshoptimizer");
#endif
}

/// Texel indices that are exact in a float.
constexpr std::size_t kMaxTexels = std::size_t(1) << 24;
/// Clip numbers of CrowdInstance.
constexpr std::size_t kMaxClips = 65536;

osg::ref_ptr<osg::TextureBuffer> textureOf(osg::Array& array, GLint format) {
    array.setVertexBufferObject(new osg::VertexBufferObject);
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer(&array);
    texture->setInternalFormat(format);
    return texture;
}

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

} // namespace

CrowdCharacter::CrowdCharacter() : _sizes{std::numeric_limits<float>::infinity()} {}

CrowdCharacter::~CrowdCharacter() = default;

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
    const auto found = std::find_if(joints.begin(), joints.end(),
                                    [&](const BoundJoint& j) { return j.name == joint; });
    if (found == joints.end()) throw Error("crowd: the skin has no joint \"" + joint + "\"");
    const osg::Vec3Array* positions = vectors(geometry.getVertexArray());
    const osg::Vec3Array* normals = vectors(geometry.getNormalArray());
    if (!positions || !normals || positions->size() != normals->size())
        throw Error("crowd: the geometry \"" + geometry.getName() +
                    "\" needs Vec3Arrays of vertices and of as many normals");
    const auto index = static_cast<int>(found - joints.begin());
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

CrowdCharacter::Clip CrowdCharacter::bake(const Samples& samples, double samplesPerSecond,
                                          bool loops, osg::BoundingBox& bounds) const {
    Clip clip{samples.front().size(), samplesPerSecond, loops, {}};
    for (std::size_t s = 0; s < _skins.size(); ++s) {
        const GpuModel& model = *_skins[s].model;
        Pose pose(model.model().joints(), model.model().inputs().size());
        clip.palettes.emplace_back(clip.samples * model.paletteSize());
        for (std::size_t i = 0; i < clip.samples; ++i) {
            const std::vector<glm::dmat4>& skinning = samples[s][i];
            // Continued, so that interpolation takes the short way.
            if (!pose.set(skinning.data(), skinning.size(),
                          i == 0 ? Pose::Twist::Shortest : Pose::Twist::Continued))
                throw Error("crowd: sample " + std::to_string(i) + " of a clip cannot be used");
            writePalette(model, pose, &clip.palettes.back()[i * model.paletteSize()]);
            expandBy(bounds, toOsg(computePoseBounds(model.model(), pose)), _skins[s].toCharacter);
            expandByRigids(bounds, s, skinning);
        }
    }
    return clip;
}

unsigned int CrowdCharacter::addClip(const Samples& samples, double samplesPerSecond, bool loops) {
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
    Clip clip = bake(samples, double(rate), loops, bounds);
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
    std::vector<osg::Vec3> positions;
    std::vector<GLuint> indices;
    std::vector<std::size_t> ends;
    for (const Part& part : _parts) {
        const auto first = static_cast<GLuint>(positions.size());
        for (const osg::Vec3& p : *vectors(part.rest->getVertexArray()))
            positions.push_back(p * _skins[part.skin].toCharacter);
        for (const GLuint index : part.indices.front()) indices.push_back(first + index);
        ends.push_back(positions.size());
    }
    const std::size_t all = indices.size() / 3;
    const auto most = 3 * static_cast<std::size_t>(triangles * static_cast<double>(all));
    const std::vector<GLuint> kept = simplified(positions, indices, most);
    for (std::size_t p = 0; p < _parts.size(); ++p) {
        const std::size_t first = p == 0 ? 0 : ends[p - 1];
        const auto isHere = [&](GLuint index) { return index >= first && index < ends[p]; };
        std::vector<GLuint> own;
        for (std::size_t i = 0; i < kept.size(); i += 3)
            if (isHere(kept[i]) && isHere(kept[i + 1]) && isHere(kept[i + 2]))
                for (std::size_t k = i; k < i + 3; ++k)
                    own.push_back(kept[k] - static_cast<GLuint>(first));
        _parts[p].indices.push_back(own);
    }
    _sizes.push_back(below);
    _share = triangles;
    return triangleCount(_sizes.size() - 1);
}

std::size_t CrowdCharacter::triangleCount(std::size_t level) const {
    std::size_t count = 0;
    for (const Part& part : _parts) count += part.indices[level].size() / 3;
    return count;
}

} // namespace osgSkin
