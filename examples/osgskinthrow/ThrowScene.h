// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/ref_ptr>

#include <string>

/// Builds the thrower from its files with the public API alone: what the `.skin` plug-in does for
/// `data/thrower.skin`, step by step. Z up, metres, throwing towards +X.
/// \param seconds the length of the throw, for pictures of it; may be null
/// \throw osgSkin::Error where a file in `folder` cannot be used
osg::ref_ptr<osg::Group> makeThrowScene(const std::string& folder, double* seconds = nullptr);
