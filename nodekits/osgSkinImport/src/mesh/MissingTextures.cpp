// SPDX-License-Identifier: MIT
#include "mesh/MissingTextures.h"

#include <osg/Notify>

namespace osgSkin {

MissingTextures::~MissingTextures() {
    if (_names.empty()) return;
    std::string what = "texture \"" + *_names.begin() + '"';
    if (_names.size() > 1)
        what = std::to_string(_names.size()) + " textures, \"" + *_names.begin() + "\" among them,";
    OSG_NOTICE << _path << ": " << what << " cannot be read; drawn without" << std::endl;
}

} // namespace osgSkin
