// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/CrowdInstance>

#include <osg/Array>
#include <osg/BoundingBox>
#include <osg/TextureBuffer>
#include <osg/Vec4f>

#include <vector>

namespace osgSkin {

/// The members of a crowd, for shaders and for the processor's culling.
class CrowdMembers {
public:
    /// \param bounds of a member about its place
    CrowdMembers(const std::vector<CrowdInstance>& instances, const osg::BoundingBox& bounds);

    std::size_t size() const { return _spheres.size(); }
    osg::TextureBuffer* texture() const { return _texture.get(); }
    /// The same number of them.
    void set(const std::vector<CrowdInstance>& instances);

    const std::vector<osg::Vec4f>& spheres() const { return _spheres; } ///< centre, radius
    const osg::BoundingBox& box() const { return _box; }                ///< of all of them

private:
    osg::BoundingBox _memberBounds;
    osg::ref_ptr<osg::Vec4uiArray> _texels;
    osg::ref_ptr<osg::TextureBuffer> _texture;
    std::vector<osg::Vec4f> _spheres;
    osg::BoundingBox _box;
};

} // namespace osgSkin
