// SPDX-License-Identifier: MIT
#include "mesh/MissingTextures.h"

#include <osg/Notify>

namespace osgSkin {

MissingTextures::~MissingTextures() {
    if (_names.empty()) return;
    const std::string first = '"' + *_names.begin() + '"';
    if (_names.size() == 1)
        OSG_NOTICE << _path << ": texture " << first << " cannot be read; drawn without"
                   << std::endl;
    else
        OSG_NOTICE << _path << ": " << _names.size() << " textures cannot be read, " << first
                   << " among them; drawn without" << std::endl;
}

} // namespace osgSkin
