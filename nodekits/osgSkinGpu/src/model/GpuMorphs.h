// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/MorphTargets>

#include <osg/Referenced>
#include <osg/TextureBuffer>
#include <osg/ref_ptr>

#include <cstddef>

namespace osgSkin {

/// The offsets of morph targets for shaders: a texture buffer of four 32-bit words a texel, shared
/// by all skins that have these targets.
///
///     0         texels of an entry: 2, or 3 with tangents; 0, 0, 0
///     1 + v     texel of vertex v's entries, their number, 0, 0
///     entry     offset of the position (floats), index of the target
///               offset of the normal (floats), 0
///               offset of the tangent (floats), 0
class GpuMorphs : public osg::Referenced {
public:
    /// Returns the GpuMorphs of these targets, and makes it where there is none; thread-safe.
    ///
    /// \param targets is kept alive
    static osg::ref_ptr<const GpuMorphs> of(const MorphTargets& targets);

    osg::TextureBuffer* texture() const { return _texture.get(); }
    std::size_t texelCount() const { return _texels; }

protected:
    ~GpuMorphs() override;

private:
    explicit GpuMorphs(const MorphTargets& targets);

    osg::ref_ptr<const MorphTargets> _targets;
    std::size_t _texels = 0;
    osg::ref_ptr<osg::TextureBuffer> _texture;
};

} // namespace osgSkin
