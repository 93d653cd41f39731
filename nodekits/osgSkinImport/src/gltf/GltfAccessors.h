// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFACCESSORS_H
#define OSGSKINIMPORT_GLTFACCESSORS_H 1

#include "gltf/GltfFile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// The numbers of a glTF file, read as its specification says: normalised integers, sparse
/// accessors, strides.
///
/// What is malformed throws nlohmann::json::exception or osgSkin::Error.
class GltfAccessors {
public:
    /// \param file is read, and added to, after loadBuffers(); must outlive this
    explicit GltfAccessors(GltfFile& file) : _file(file) {}

    /// How many elements, and numbers in each.
    std::size_t count(std::size_t accessor) const;
    std::size_t width(std::size_t accessor) const;

    /// How many bytes a number has.
    std::size_t componentBytes(std::size_t accessor) const;

    /// Whether it stands in a view, is not sparse, and the view goes on for a stride behind where
    /// its last element begins: Assimp takes no others for whole numbers.
    bool isWhole(std::size_t accessor) const;

    /// Whether it isWhole(), and has floats: no integers.
    bool isPlain(std::size_t accessor) const;

    /// Whether the file holds its values, not only in a compressed form of some extension.
    bool hasValues(std::size_t accessor) const;

    /// All numbers of an accessor, element by element.
    std::vector<double> values(std::size_t accessor);

    /// The same of an accessor of joints or indices, which are whole numbers even where the file
    /// calls them normalised.
    std::vector<double> stored(std::size_t accessor);

    /// What a buffer holds.
    /// \param index of the buffer
    const std::string& buffer(std::size_t index) const;

    /// Adds an accessor of floats.
    /// \param type of its elements, as "VEC3"
    /// \return its index
    std::size_t add(const std::string& type, const std::vector<double>& values);
    /// The same of whole numbers of two bytes.
    std::size_t addShorts(const std::string& type, const std::vector<double>& values);
    /// The same of whole numbers of four bytes.
    std::size_t addInts(const std::string& type, const std::vector<double>& values);

private:
    const nlohmann::json& accessor(std::size_t index) const;
    std::size_t addBytes(const std::string& type, int component, std::size_t numbers,
                         std::string bytes);
    void read(std::size_t view, std::size_t offset, int type, std::size_t wide, std::size_t many,
              std::vector<double>& result);

    GltfFile& _file;
};

} // namespace osgSkin

#endif
