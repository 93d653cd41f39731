// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_FBXDOCUMENT_H
#define OSGSKINIMPORT_ASSIMP_FBXDOCUMENT_H

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

constexpr double kFbxTicks = 46186158000.0; ///< times in a second

/// A value of an FBX record. Numbers are in both `number` and `integer`.
struct FbxValue {
    double number = 0.0;
    std::int64_t integer = 0;
    std::string text;
};

/// A record of an FBX file, binary or text.
struct FbxRecord {
    std::string name;
    std::vector<FbxValue> values;
    std::vector<double> numbers; ///< of an array
    std::vector<FbxRecord> records;

    /// The first record with a name; null if there is none.
    const FbxRecord* find(std::string_view name) const;

    /// The numbers of a child record that is an array of a curve's, or "TransformLink"; empty if
    /// there is none.
    const std::vector<double>& list(std::string_view name) const;

    /// A property ("Lcl Rotation") of the child record "Properties70"; null if there is none.
    const FbxRecord* property(std::string_view name) const;
};

/// The parts of an FBX file that Assimp does not expose: objects of the few kinds that place and
/// move models, and all connections.
struct FbxDocument {
    /// Models, deformers, and stacks, layers, nodes and curves of animations; geometries without
    /// their contents.
    std::vector<FbxRecord> objects;
    std::vector<FbxRecord> connections;

    /// Reads a file of version 7 or later, before Assimp does.
    /// \param bytes of the whole file
    /// \param path of the file, for errors
    /// \return an empty document if the file is older, or malformed text: Assimp reports errors
    /// \throw osgSkin::Error where Assimp would trust the file and take gigabytes, overwrite memory
    ///        or exhaust the stack: by the stated lengths of arrays, or the depth of records
    static FbxDocument read(const std::string& bytes, const std::string& path);
};

/// Ends the error of a binary file that Assimp wrote and does not read; else empty.
std::string adviceFor(std::string_view fbx);

/// Renames the connections of an object's property to another object, text or binary, to those
/// between two properties: Assimp's reader refuses the former and ignores the latter.
void renamePropertyConnections(std::string& fbx);

} // namespace osgSkin

#endif
