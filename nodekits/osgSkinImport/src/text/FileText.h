// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_FILETEXT_H
#define OSGSKINIMPORT_FILETEXT_H 1

#include <osgSkinImport/ReadLimits>

#include <fstream>
#include <string>
#include <string_view>

namespace osgSkin {

/// Throws osgSkin::Error "PATH: MESSAGE", on one line whatever the message holds.
[[noreturn]] void failFile(const std::string& path, const std::string& message);

/// Throws osgSkin::Error "PATH: line N: MESSAGE".
[[noreturn]] void failLine(const std::string& path, std::size_t line, const std::string& message);

/// The whole content of a file, for any reader; throws osgSkin::Error with the reason where it
/// cannot be read or is larger than allowed.
std::string readText(const std::string& path, const ReadLimits& limits);

/// Opens a regular file of less than so many megabytes and tells its size; throws osgSkin::Error,
/// which names the option that raises the limit.
std::ifstream openFile(const std::string& path, std::size_t mostMegabytes, const char* raisedBy,
                       std::size_t& size);

/// Throws osgSkin::Error unless `path` is a regular file that can be opened, only has to be read
/// (requireOnlyRead()) and is no larger than allowed; returns its size.
std::size_t requireReadable(const std::string& path, const ReadLimits& limits);

/// Whether `path` is a regular file: opening anything else may take for ever.
bool isRegularFile(const std::string& path);

/// Reads all of `token` as a decimal number, in any locale; false where it is none. May give NaN
/// or infinity.
bool parseNumber(std::string_view token, double& value);

/// Tells OSG's notify handler what of a file is left out or read otherwise, on one line.
void tellOf(const std::string& path, const std::string& message);

/// `token` in quotes, cut short and with control characters replaced, for an error message.
std::string inQuotes(std::string_view token);

} // namespace osgSkin

#endif
