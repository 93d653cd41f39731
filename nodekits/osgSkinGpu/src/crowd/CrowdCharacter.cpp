// SPDX-License-Identifier: MIT
#include <osgSkinGpu/CrowdCharacter>

#include "crowd/Levels.h"
#include "model/PackRigid.h"
#include "shader/CrowdText.h"

#include <osgSkinGpu/GpuPalette>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>

#include <osg/BufferObject>

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

/// Texels that floats can number.
constexpr std::size_t kMostTexels = std::size_t(1) << 24;

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

const osg::Vec3Array* vectors(const osg::Array* array) {
    return dynamic_cast<const osg::Vec3Array*>(array);
}

} // namespace

CrowdCharacter::CrowdCharacter() : _sizes{std::numeric_limits<float>::infinity()} {}

CrowdCharacter::~CrowdCharacter() = default;

std::size_t CrowdCharacter::addSkin(const DeformableSkin& skin, const osg::Matrixd& toCharacter) {
    if (!skin.getModel()) throw Error("crowd: the skin \"" + skin.getName() + "\" has no model");
    if (!_clips.empty()) throw Error("crowd: skins are added before clips");
    const osg::ref_ptr<const GpuModel> model = GpuModel::of(*skin.getModel());
    _skins.push_back({model, toCharacter, nullptr, nullptr});
    Part part{new osg::Geometry(*skin.getRestGeometry(), osg::CopyOp::SHALLOW_COPY),
              const_cast<osg::StateSet*>(skin.getStateSet()),
              model->texture(),
              _skins.size() - 1,
              -1,
              {}};
    addPart(part);
    return _skins.size() - 1;
}

void CrowdCharacter::addRigid(const osg::Geometry& geometry, osg::StateSet* state, std::size_t skin,
                              const std::string& joint) {
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
    Part part{new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY),
              state,
              textureOf(*texels, GL_RGBA32UI_EXT),
              skin,
              index,
              {}};
    addPart(part);
}

void CrowdCharacter::addPart(Part& part) {
    if (_sizes.size() > 1) throw Error("crowd: parts are added before levels of detail");
    part.indices.push_back(trianglesOf(*part.rest));
    _parts.push_back(part);
}

void CrowdCharacter::addBounds(const Samples& samples) {
    for (const Part& part : _parts) {
        const Skin& skin = _skins[part.skin];
        if (part.joint >= 0)
            for (const std::vector<glm::dmat4>& sample : samples[part.skin])
                expandBy(_bounds, part.rest->getBoundingBox(),
                         toOsg(sample[static_cast<std::size_t>(part.joint)]) * skin.toCharacter);
    }
}

unsigned int CrowdCharacter::addClip(const Samples& samples, double samplesPerSecond, bool loops) {
    if (_skins.empty() || samples.size() != _skins.size() || samples.front().empty() ||
        !(samplesPerSecond > 0.0))
        throw Error("crowd: a clip needs samples of each skin, and some a second");
    Clip clip{samples.front().size(), samplesPerSecond, loops, {}};
    osg::BoundingBox bounds = _bounds;
    for (std::size_t s = 0; s < _skins.size(); ++s) {
        const GpuModel& model = *_skins[s].model;
        Pose pose(model.model().joints(), model.model().inputs().size());
        clip.palettes.emplace_back(clip.samples * model.paletteSize());
        if (samples[s].size() != clip.samples)
            throw Error("crowd: a clip needs as many samples of each skin");
        for (std::size_t i = 0; i < clip.samples; ++i) {
            const std::vector<glm::dmat4>& skinning = samples[s][i];
            // So that what lies between two samples does not turn the long way round.
            if (!pose.set(skinning.data(), skinning.size(),
                          i == 0 ? Pose::Twist::Shortest : Pose::Twist::Continued))
                throw Error("crowd: sample " + std::to_string(i) + " of a clip cannot be used");
            writePalette(model, pose, &clip.palettes.back()[i * model.paletteSize()]);
            expandBy(bounds, toOsg(computePoseBounds(model.model(), pose)), _skins[s].toCharacter);
        }
    }
    _bounds = bounds;
    addBounds(samples);
    _clips.push_back(std::move(clip));
    writeClips();
    return static_cast<unsigned int>(_clips.size() - 1);
}

void CrowdCharacter::writeClips() {
    for (std::size_t s = 0; s < _skins.size(); ++s) {
        const osg::ref_ptr<osg::Vec4Array> texels =
            new osg::Vec4Array(static_cast<unsigned int>(_clips.size()));
        for (std::size_t c = 0; c < _clips.size(); ++c) {
            const Clip& clip = _clips[c];
            (*texels)[c] = {static_cast<float>(texels->size()), static_cast<float>(clip.samples),
                            static_cast<float>(clip.samplesPerSecond), clip.loops ? 1.0f : 0.0f};
            texels->insert(texels->end(), clip.palettes[s].begin(), clip.palettes[s].end());
        }
        if (texels->size() > kMostTexels)
            throw Error("crowd: all clips together have more than 16,777,216 texels");
        _skins[s].samples = texels;
        _skins[s].clips = textureOf(*texels, GL_RGBA32F_ARB);
    }
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
    return true;
}

std::size_t CrowdCharacter::addLevel(double triangles, double size) {
    if (_sizes.size() >= kMostLevels) throw Error("crowd: there are eight levels already");
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
    _sizes.push_back(static_cast<float>(size));
    return triangleCount(_sizes.size() - 1);
}

std::size_t CrowdCharacter::triangleCount(std::size_t level) const {
    std::size_t count = 0;
    for (const Part& part : _parts) count += part.indices[level].size() / 3;
    return count;
}

} // namespace osgSkin
