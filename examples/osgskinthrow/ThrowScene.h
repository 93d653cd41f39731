// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/ref_ptr>

#include <string>

/// What there is to tell about a throw.
struct ThrowFacts {
    double seconds = 0.0; ///< its length
    std::string feet;     ///< how far they slide: a line a foot
};

/// Builds the thrower from its files with the public API alone: what the `.skin` plug-in does for
/// `data/thrower.skin`, step by step. Z up, metres, throwing towards +X.
/// \param facts of the throw; may be null
/// \throw osgSkin::Error where a file in `folder` cannot be used
osg::ref_ptr<osg::Group> makeThrowScene(const std::string& folder, ThrowFacts* facts = nullptr);
