// SPDX-License-Identifier: MIT
#include "crowd/CrowdMembers.h"

#include <osg/BufferObject>

#include <algorithm>
#include <cmath>

namespace osgSkin {

CrowdMembers::CrowdMembers(const std::vector<CrowdInstance>& instances,
                           const osg::BoundingBox& bounds)
    : _memberBounds(bounds), _texels(new osg::Vec4uiArray) {
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    buffer->setUsage(GL_DYNAMIC_DRAW_ARB);
    _texels->setVertexBufferObject(buffer);
    _texels->resize(std::max<std::size_t>(1, instances.size()) * CrowdInstance::kTexels);
    _texture = new osg::TextureBuffer(_texels);
    _texture->setInternalFormat(GL_RGBA32UI_EXT);
    set(instances);
}

void CrowdMembers::set(const std::vector<CrowdInstance>& instances) {
    const osg::Vec3d centre = _memberBounds.center();
    const float radius = _memberBounds.radius();
    _spheres.clear();
    _box.init();
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const CrowdInstance& one = instances[i];
        one.pack(&(*_texels)[i * CrowdInstance::kTexels]);
        const osg::Vec3f place(one.position + one.rotation * (centre * double(one.scale)));
        _spheres.emplace_back(place, radius * std::abs(one.scale));
        _box.expandBy(osg::BoundingSphere(place, _spheres.back().w()));
    }
    _texels->dirty();
}

} // namespace osgSkin
