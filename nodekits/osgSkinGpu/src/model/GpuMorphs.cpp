// SPDX-License-Identifier: MIT
#include "model/GpuMorphs.h"

#include "model/PackTexels.h"
#include "model/PackedOnce.h"

#include <osg/Array>

#include <algorithm>
#include <vector>

namespace osgSkin {
namespace {

osg::ref_ptr<osg::Vec4uiArray> packMorphs(const MorphTargets& morphs) {
    std::vector<unsigned int> entries(morphs.vertexCount());
    bool hasTangents = false;
    for (const MorphTarget& target : morphs.targets()) {
        for (const std::uint32_t v : target.vertices) ++entries[v];
        hasTangents = hasTangents || !target.tangents.empty();
    }
    const unsigned int stride = hasTangents ? 3 : 2;
    const osg::ref_ptr<osg::Vec4uiArray> texels = new osg::Vec4uiArray;
    texels->push_back({stride, 0, 0, 0});
    auto end = static_cast<unsigned int>(1 + morphs.vertexCount());
    for (const unsigned int count : entries) {
        texels->push_back({end, count, 0, 0});
        end += stride * count;
    }
    texels->resize(end);
    std::vector<unsigned int> next;
    for (std::size_t v = 0; v < entries.size(); ++v) next.push_back((*texels)[1 + v][0]);
    for (unsigned int t = 0; t < morphs.targets().size(); ++t) {
        const MorphTarget& target = morphs.targets()[t];
        const auto offset = [](const std::vector<glm::vec3>& offsets, std::size_t k) {
            return offsets.empty() ? glm::vec3(0.0f) : offsets[k];
        };
        for (std::size_t k = 0; k < target.vertices.size(); ++k) {
            unsigned int& texel = next[target.vertices[k]];
            (*texels)[texel] = packedTexel(offset(target.positions, k), t);
            (*texels)[texel + 1] = packedTexel(offset(target.normals, k), 0);
            if (hasTangents) (*texels)[texel + 2] = packedTexel(offset(target.tangents, k), 0);
            texel += stride;
        }
    }
    return texels;
}

} // namespace

osg::ref_ptr<const GpuMorphs> GpuMorphs::of(const MorphTargets& targets) {
    return PackedOnce<MorphTargets, GpuMorphs>::find(targets,
                                                     [&] { return new GpuMorphs(targets); });
}

GpuMorphs::GpuMorphs(const MorphTargets& targets) : _targets(&targets) {
    const osg::ref_ptr<osg::Vec4uiArray> texels = packMorphs(targets);
    _texels = texels->size();
    _texture = textureOf(*texels, GL_RGBA32UI_EXT);
}

GpuMorphs::~GpuMorphs() {
    PackedOnce<MorphTargets, GpuMorphs>::forget(*_targets);
}

} // namespace osgSkin
