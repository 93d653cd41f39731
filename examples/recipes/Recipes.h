// SPDX-License-Identifier: MIT
#pragma once

#include "Snapshots.h"

#include <osg/Node>
#include <osg/ref_ptr>

#include <string>
#include <vector>

/// The ground of a recipe's picture.
enum class Floor { Own, Plain, Shadowed };

/// Flags of a recipe's picture, to be added up.
enum Needs : unsigned {
    kNothing = 0,
    kWireframe = 1,
    kFirstFrame = 2, ///< at time 0, before the picture's: something fades
    kHead = 4,       ///< the view moves with the character's head
};

/// A recipe, and how it is shown.
struct Recipe {
    const char* name; ///< of its function and its file
    /// \param size of the character, in heights of the samples
    osg::ref_ptr<osg::Node> (*make)(const std::string& file, double size);
    const char* sample; ///< the character that it shows, see writeSamples()
    double time;        ///< of its picture, seconds
    example::View view; ///< of its picture, in metres above `place`, for the samples' size
    Floor floor = Floor::Shadowed;
    unsigned needs = kNothing;
    osg::Matrixd place{}; ///< from the view to the world
};

/// All recipes, in the order of the page.
const std::vector<Recipe>& recipes();

/// A recipe's scene, and where to look at it from.
struct Stage {
    osg::ref_ptr<osg::Node> scene; ///< with a light, and a floor where it has none of its own
    example::View view;            ///< in the world
};

/// \param file of a character; empty for the recipe's own
/// \param samples folder of writeSamples()
/// \throw std::exception with a sentence where the recipe cannot show the character
Stage stageOf(const Recipe& recipe, const std::string& file, const std::string& samples);

/// A recipe's picture, of 320 x 240 pixels.
/// \param file of a character; empty for the recipe's own
/// \param samples folder of writeSamples()
osg::ref_ptr<osg::Image> pictureOf(const Recipe& recipe, const std::string& file,
                                   const std::string& samples);
