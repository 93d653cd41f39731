// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_FILES_FILEFORMAT_H
#define OSGSKINIMPORT_FILES_FILEFORMAT_H

#include <string>

namespace osgSkin {

/// A file format, as the extension of a file's name states it.
struct FileFormat {
    enum Reader { Obj, Ply, Off, Bvh, Gltf, Assimp, Osg, Character };

    std::string extension; ///< in lower case
    Reader reader;
    bool hasMesh, hasSkeleton; ///< whether files of this format can contain them

    /// Whether the file is read into a SourceScene: mesh, skeleton and clips.
    bool isScene() const { return (reader == Gltf || reader == Assimp) && hasMesh && hasSkeleton; }

    /// Whether this kit has a reader of its own. OSG's readers of these formats trust their input,
    /// and are never used.
    bool hasOwnReader() const { return reader < Assimp; }
};

/// The format of a file, which is not opened. Unknown extensions are left to Assimp if it has a
/// reader for them, or else to OSG.
FileFormat formatOf(const std::string& path);

/// Ends the refusal of a recording of motion capture that is no rig: what to convert it to. Else
/// empty.
/// \param extension in lower case
std::string adviceForCapture(const std::string& extension);

} // namespace osgSkin

#endif
