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

/// Draws a drawable only where the context supports buffers as large as the drawable's, where else
/// shaders would read zeros, and warns once.
class TexelCheck : public osg::Drawable::DrawCallback {
public:
    /// \param texels of the largest buffer
    /// \param draw the drawable's own draw callback; may be null
    TexelCheck(std::size_t texels, osg::Drawable::DrawCallback* draw)
        : _texels(texels), _draw(draw) {}

    void drawImplementation(osg::RenderInfo& renderInfo,
                            const osg::Drawable* drawable) const override;

private:
    std::size_t _texels;
    osg::ref_ptr<osg::Drawable::DrawCallback> _draw;
};

/// The geometries of a crowd, one for each part and level of detail, and the list of the members to
/// draw.
class CrowdDraws {
public:
    enum class Count { Direct, Indirect };

    /// \param capacity the most members
    /// \param count where the counts of members come from: the processor, or a buffer of commands
    CrowdDraws(const CrowdCharacter& character, std::size_t capacity, Count count);

    /// `capacity` entries for each level.
    osg::UIntArray& list() const { return *_list; }
    /// Sets the number of members drawn in a level; Direct only.
    void setCount(std::size_t level, std::size_t members);
    /// A command for each part and level, without members; Indirect only.
    osg::DefaultIndirectCommandDrawElements* commands() const { return _commands.get(); }

    /// Whether no cull's render leaves hold them any more; a cull releases those of its last frame.
    bool isFree() const;

    void setBound(const osg::BoundingBox& box);
    void cull(osgUtil::CullVisitor& cv) const;
    /// Compiles the programs below the states that are pushed, uploads textures and buffers, and
    /// draws one member of each level unseen: drivers translate shaders at their first draw.
    /// Indirect only.
    void compileGLObjects(osg::RenderInfo& renderInfo) const;
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
    /// Writes the commands of a context with so many members each.
    void setCommands(osg::State& state, unsigned int members) const;
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
