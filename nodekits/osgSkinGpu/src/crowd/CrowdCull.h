// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/CrowdDraws.h"

#include <osg/Drawable>
#include <osg/StateSet>

namespace osgSkin {

/// Fills the commands and the list of a crowd's draws when it is drawn itself, for the camera that
/// it is drawn by.
class CrowdCull : public osg::Drawable {
public:
    /// \param draws indirect ones, which outlive this
    CrowdCull(const CrowdCharacter& character, const CrowdDraws& draws,
              osg::TextureBuffer* instances);

    osg::StateSet& state() const { return *_state; }

    /// In no thread's draw.
    ///
    /// \param count members
    void setCount(std::size_t count) { _count = static_cast<int>(count); }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    const CrowdDraws& _draws;
    osg::Vec4f _sphere;
    std::vector<float> _sizes;
    int _parts, _capacity, _count = 0;
    osg::ref_ptr<osg::StateSet> _state;
};

} // namespace osgSkin
