// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "file/JsonReader.h"

#include <cstddef>
#include <map>
#include <string>

namespace osgSkin {

/// How often a description names each file: one is read again each time, so that a short
/// description could take hours over a file that is short, too.
class FileUses {
public:
    /// \param most how often a file may be named (ReadLimits::uses)
    explicit FileUses(std::size_t most) : _most(most) {}

    /// Counts one use; whatever way a path goes to a file, it is one file.
    ///
    /// \param file as the description has it, below its folder
    /// \param place what names it, for the error
    /// \throw osgSkin::Error where that is once too often
    void add(const std::string& file, const JsonReader& place);

private:
    std::size_t _most;
    std::map<std::string, std::size_t> _uses; ///< by path
};

} // namespace osgSkin
