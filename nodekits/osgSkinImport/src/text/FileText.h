// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_TEXT_FILETEXT_H
#define OSGSKINIMPORT_TEXT_FILETEXT_H

#include <osgSkinImport/ReadLimits>

#include <osgDB/Options>

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

namespace osgSkin {

/// The length of the byte order mark that a text begins with; 0 where it has none.
inline std::size_t byteOrderMark(std::string_view text) {
    return text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;
}

/// No file has a longer name (PATH_MAX).
constexpr std::size_t kLongestPath = 4096;

/// Throws osgSkin::Error for names of more than kLongestPath bytes, or with a byte 0, at which some
/// readers end a name and others do not.
void requireName(const std::string& path);

/// Whether OpenSceneGraph does no more with a file, by its extension, than read it.
///
/// It runs scripts (`.lua`) when a model is asked for, unpacks archives by a shell command that
/// contains the file's name (`.tgz`) or reads what is in them past our guard (`.gz`, `.osga`, also
/// before a slash), and opens ports (`.osc`) and databases in a network (`.gdal`).
/// \param path as it would be given to OpenSceneGraph
bool isOnlyRead(const std::string& path);

/// Throws osgSkin::Error where isOnlyRead() is false, and as requireName().
void requireOnlyRead(const std::string& path);

/// Whether a name may be no file's, but hold one, which a pseudo-loader of OSG asks for in turn:
/// "x.osgb.2.scale".
bool isPseudoLoader(const std::string& name);

/// The extension of a scene that only OSG reads (`.osgb`, `.osgt`, `.osgx`, `.osg`, `.ive`), also
/// before that of a pseudo-loader; empty for other files.
std::string osgSceneFormat(const std::string& path);

/// Throws osgSkin::Error "PATH: MESSAGE", on one line whatever the message holds.
[[noreturn]] void failFile(const std::string& path, const std::string& message);

/// Throws osgSkin::Error "PATH: line N: MESSAGE".
[[noreturn]] void failLine(const std::string& path, std::size_t line, const std::string& message);

/// The whole content of a file, for any reader; throws osgSkin::Error with the reason where it
/// cannot be read or is larger than allowed.
std::string readText(const std::string& path, const ReadLimits& limits);

/// Opens a regular file of less than so many megabytes.
/// \param raisedBy the option that raises this limit, for the error
/// \param[out] size of the file, in bytes
/// \throw osgSkin::Error
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

/// Reports to OSG's notify handler, on one line, what is left out of a file or read otherwise.
void tellOf(const std::string& path, const std::string& message);

/// `token` in quotes, cut short and with control characters replaced, for an error message.
std::string inQuotes(std::string_view token);

} // namespace osgSkin

#endif
