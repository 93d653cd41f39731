// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace osgSkin {

/// A character's file, while it is loaded. Any reader of OSG may come to load another one
/// meanwhile, as a part of it; files that name themselves or each other are found out here.
class OpenFile {
public:
    /// \throw Error where the file is being loaded already in this thread, or is a part of a part of
    ///        too many others
    explicit OpenFile(const std::string& file);
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
};

} // namespace osgSkin
