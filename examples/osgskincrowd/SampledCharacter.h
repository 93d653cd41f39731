// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/DeformableSkin>

#include <osg/Matrix>
#include <osg/Node>
#include <osg/ref_ptr>

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

/// A character read from a file, with the first of its clips sampled once: whoever plays it in any
/// phase copies matrices and asks no animation manager and no bone.
struct SampledCharacter {
    /// \throw std::runtime_error where the file cannot be read, or has no skin
    explicit SampledCharacter(const std::string& file);

    struct Skin {
        osg::ref_ptr<osgSkin::DeformableSkin> skin;
        osg::Matrix toCharacter;                      ///< to the character's space, upright
        std::vector<std::vector<glm::dmat4>> samples; ///< [sample][joint], see BoneReader
    };
    struct Rigid {
        std::vector<osg::ref_ptr<osg::Node>> parts;
        std::vector<osg::Matrix> samples; ///< to the character's space
    };

    static constexpr double kSamplesPerSecond = 60.0;
    std::size_t sampleCount = 0; ///< at least 1; a clip that begins again after its last one
    std::vector<Skin> skins;
    std::vector<Rigid> rigids;
    osg::BoundingBox box; ///< of the skins in all samples
};
