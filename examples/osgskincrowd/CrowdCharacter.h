// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/ClipCharacter>

#include <osg/ref_ptr>

#include <cstddef>
#include <string>

/// A character read from a file, with the first of its clips sampled 60 times a second and baked: a
/// member of the crowd copies poses and asks no animation manager and no bone.
struct CrowdCharacter {
    /// \throw std::runtime_error where the file cannot be read, osgSkin::Error where it has no
    ///        skin
    explicit CrowdCharacter(const std::string& file);

    osg::ref_ptr<osgSkin::ClipCharacter> character;
    osg::ref_ptr<const osgSkin::SampledClip> clip;
    std::size_t vertices = 0; ///< of its skins
};
