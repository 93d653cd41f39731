// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_FILES_FILETEXT_H
#define OSGSKINIMPORT_FILES_FILETEXT_H

#include <osgSkinImport/ReadLimits>

#include <osgDB/Options>

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

namespace osgSkin {

/// The length of a text's byte order mark; 0 if it has none.
inline std::size_t byteOrderMark(std::string_view text) {
    return text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;
}

/// The maximum length of a file name (PATH_MAX).
constexpr std::size_t kMaxPath = 4096;

/// Throws osgSkin::Error for a name of more than kMaxPath bytes, or with a byte 0, which ends
/// the name for some readers only.
void requireName(const std::string& path);

/// Whether OpenSceneGraph only reads a file with this extension.
///
/// OpenSceneGraph runs scripts (`.lua`) to load a model, unpacks archives by a shell command that
/// contains the file's name (`.tgz`), reads their contents without our checks (`.gz`, `.osga`, also
/// before a slash), and opens ports (`.osc`) and network databases (`.gdal`).
/// \param path as passed to OpenSceneGraph
bool isOnlyRead(const std::string& path);

/// Throws osgSkin::Error if isOnlyRead() is false, or as requireName() does.
void requireOnlyRead(const std::string& path);

/// Whether a name may be that of an OSG pseudo-loader, which loads the file named before its
/// arguments: "x.osgb.2.scale".
bool isPseudoLoader(const std::string& name);

/// The extension of a scene that only OSG reads (`.osgb`, `.osgt`, `.osgx`, `.osg`, `.ive`), also
/// before that of a pseudo-loader; empty for other files.
std::string osgSceneFormat(const std::string& path);

/// Throws osgSkin::Error "PATH: MESSAGE", always on one line.
[[noreturn]] void failFile(const std::string& path, const std::string& message);

/// Throws osgSkin::Error "PATH: line N: MESSAGE".
[[noreturn]] void failLine(const std::string& path, std::size_t line, const std::string& message);

/// Reads a whole file of any format; throws osgSkin::Error with the reason if it cannot be read or
/// is too large.
std::string readText(const std::string& path, const ReadLimits& limits);

/// Opens a regular file of less than `maxMegabytes`.
/// \param path of the file
/// \param maxMegabytes limit on its size
/// \param raisedBy the option that raises this limit, for the error
/// \param[out] size of the file, in bytes
/// \throw osgSkin::Error
std::ifstream openFile(const std::string& path, std::size_t maxMegabytes, const char* raisedBy,
                       std::size_t& size);

/// Throws osgSkin::Error unless `path` is a regular file that can be opened, passes
/// requireOnlyRead(), and is not too large; returns its size.
std::size_t requireReadable(const std::string& path, const ReadLimits& limits);

/// Whether `path` is a regular file: opening anything else may block forever.
bool isRegularFile(const std::string& path);

/// Parses all of `token` as a decimal number, in any locale; false if it is not a number. The value
/// may be NaN or infinity.
bool parseNumber(std::string_view token, double& value);

/// Reports what is ignored or changed in a file to OSG's notify handler, on one line.
void warn(const std::string& path, const std::string& message);

/// `token` in quotes for an error message: truncated, and with control characters replaced.
std::string inQuotes(std::string_view token);

} // namespace osgSkin

#endif
