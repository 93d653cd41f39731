// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/CrowdDraws.h"
#include "shader/CrowdText.h"

#include <osg/Drawable>
#include <osg/StateSet>

namespace osgSkin {

/// Fills the commands and the list of a crowd's draws when it is drawn itself, for the camera that
/// it is drawn by.
class CrowdCull : public osg::Drawable {
public:
    /// \param draws indirect ones
    CrowdCull(const CrowdCharacter& character, const CrowdDraws& draws,
              osg::TextureBuffer* instances);

    /// What one dispatch can look at, in every driver.
    static constexpr std::size_t kMostMembers = std::size_t{65535} * kCullThreads;

    osg::StateSet& state() const { return *_state; }

    /// In no thread's draw.
    ///
    /// \param count members
    void setCount(std::size_t count) { _count = static_cast<int>(count); }
    /// In no thread's draw.
    ///
    /// \param bounds of a member about its place
    void setBounds(const osg::BoundingBox& bounds) {
        _sphere = osg::Vec4f(bounds.center(), bounds.radius());
    }

    /// Whether a cull's render stage has this already: what it would write is one place's.
    bool isIn(osgUtil::CullVisitor& cv) const;

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    osg::ref_ptr<osg::DefaultIndirectCommandDrawElements> _commands;
    osg::Vec4f _sphere;
    std::vector<float> _sizes;
    int _parts, _capacity, _count = 0;
    osg::ref_ptr<osg::StateSet> _state;
};

} // namespace osgSkin
