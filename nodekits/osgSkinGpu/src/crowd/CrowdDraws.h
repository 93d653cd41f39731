// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/CrowdCharacter>

#include <osg/Array>
#include <osg/Drawable>
#include <osg/PrimitiveSetIndirect>
#include <osgUtil/CullVisitor>

#include <cstddef>
#include <vector>

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

/// The geometries of a crowd, each of one part in one level of detail, and the list of members that
/// they draw.
class CrowdDraws {
public:
    enum class Count { Direct, Indirect };

    /// \param capacity most members
    /// \param count who knows how many members there are of a level: the processor, or commands in
    ///        a buffer
    CrowdDraws(const CrowdCharacter& character, std::size_t capacity, Count count);

    /// Of each level, so many places one level after the other.
    osg::UIntArray& list() const { return *_list; }
    /// How many there are of a level; Direct alone.
    void setCount(std::size_t level, std::size_t members);
    /// A command for each part in each level, all of no member; Indirect alone.
    osg::DefaultIndirectCommandDrawElements* commands() const { return _commands.get(); }

    /// Whether no cull's leaves hold them any more: they are let go when the cull traversal that
    /// they were added by begins anew, after its draw.
    bool isFree() const;

    void setBound(const osg::BoundingBox& box);
    void cull(osgUtil::CullVisitor& cv) const;
    void resizeGLObjectBuffers(unsigned int maxSize);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Draw {
        osg::ref_ptr<osg::StateSet> material; ///< may be null
        osg::ref_ptr<osg::StateSet> own;      ///< of a rigid part's geometry; may be null
        osg::ref_ptr<osg::Geometry> geometry;
        std::size_t level;
        bool isEmpty;
    };
    static void cullDraw(const Draw& draw, osgUtil::CullVisitor& cv);
    Draw makeDraw(const CrowdCharacter& character, const CrowdCharacter::Part& part,
                  std::size_t level, Count count);

    std::size_t _capacity;
    osg::ref_ptr<osg::UIntArray> _list;
    osg::ref_ptr<osg::TextureBuffer> _visible;
    osg::ref_ptr<osg::DefaultIndirectCommandDrawElements> _commands;
    std::vector<Draw> _draws;
};

} // namespace osgSkin
