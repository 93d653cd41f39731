// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/ref_ptr>

#include <cstddef>
#include <string>

/// Facts about a throw.
struct ThrowFacts {
    std::size_t frames = 0; ///< of the motion
    double frameTime = 0.0; ///< seconds per frame
    std::string feet;       ///< how far the feet slide, one line per foot
};

/// Builds the thrower from its files with the public API alone. These are the steps that the
/// `.skin` plug-in takes for `data/thrower.skin`. Metres, Z up; the throw goes towards +X.
/// \param folder contains the files
/// \param facts set if not null
/// \throw osgSkin::Error if a file in `folder` cannot be used
osg::ref_ptr<osg::Group> makeThrowScene(const std::string& folder, ThrowFacts* facts = nullptr);
