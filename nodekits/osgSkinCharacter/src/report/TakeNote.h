// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osg/Notify>

#include <string>
#include <vector>

namespace osgSkin {

/// Keeps a line on something unusual for the caller, and tells OSG's notify handler too.
inline void takeNote(std::vector<std::string>& notes, const std::string& line) {
    OSG_NOTICE << line << std::endl;
    notes.push_back(line);
}

} // namespace osgSkin
