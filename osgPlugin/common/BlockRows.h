// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace osgDB {
class InputStream;
class OutputStream;
} // namespace osgDB

/// Writes a block of 32-bit words between brackets.
void writeWords(osgDB::OutputStream& os, const std::vector<std::uint32_t>& words);

/// Reads the same.
/// \return false where the stream has an exception, which may be set here
bool readWords(osgDB::InputStream& is, std::vector<std::uint32_t>& words);
