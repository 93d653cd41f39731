// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Drawable>

#include <cstddef>

namespace osgSkin {

/// Draws a drawable only where the context reads buffers as large as the drawable's; elsewhere it
/// warns, once: shaders read zeros beyond what they may.
class TexelCheck : public osg::Drawable::DrawCallback {
public:
    /// \param texels of the largest buffer
    /// \param draw what draws instead of the drawable itself; may be null
    TexelCheck(std::size_t texels, osg::Drawable::DrawCallback* draw)
        : _texels(texels), _draw(draw) {}

    void drawImplementation(osg::RenderInfo& renderInfo,
                            const osg::Drawable* drawable) const override;

private:
    std::size_t _texels;
    osg::ref_ptr<osg::Drawable::DrawCallback> _draw;
};

} // namespace osgSkin
