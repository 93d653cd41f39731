// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/Error>

#include <osg/Notify>

#include <string>
#include <vector>

namespace osgSkin {

/// Keeps a line on something unusual for the caller, and tells OSG's notify handler too.
inline void takeNote(std::vector<std::string>& notes, const std::string& line) {
    notes.push_back(onOneLine(line));
    OSG_NOTICE << notes.back() << std::endl;
}

} // namespace osgSkin
