// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinCharacter/Character>

#include <osg/ref_ptr>
#include <osgSkin/DeformableSkin>
#include <osgSkin/SkinModel>

#include <vector>

namespace viewer {

/// Lets a character's skins show the normals of their surface, or those that turn with vertices.
class NormalsSwitch {
public:
    /// \param character whose skins' parts and binding are known; else it can't be switched
    explicit NormalsSwitch(const osgSkin::Character& character);

    bool canSwitch() const { return !_skins.empty(); }
    /// The skins come to their rest pose; the next update traversal poses them.
    void showTurned(bool turned);

private:
    struct Skin {
        osg::ref_ptr<osgSkin::DeformableSkin> drawable;
        osg::ref_ptr<osg::Geometry> rest;
        osg::ref_ptr<const osgSkin::SkinModel> surface, turned;
    };
    std::vector<Skin> _skins;
};

} // namespace viewer
