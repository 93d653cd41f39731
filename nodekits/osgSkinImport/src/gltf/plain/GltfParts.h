// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFPARTS_H
#define OSGSKINIMPORT_GLTFPARTS_H 1

#include "gltf/GltfFile.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

/// The lists of a glTF file, read with every index, number and size checked; what checkedGltf() is
/// made of. Numbers in messages are the file's own.
class GltfParts {
public:
    /// \param file after loadBuffers(); must outlive this
    explicit GltfParts(const GltfFile& file);

    const ReadLimits& limits() const { return _file.limits; }
    const std::string& path() const { return _file.path; }
    /// Of the file and its buffers.
    std::size_t bytes() const { return _bytes; }
    bool has(const char* key) const { return _file.json.contains(key); }
    const nlohmann::json& at(const char* key) const { return _file.json.at(key); }

    /// Throws osgSkin::Error "FILE: WHERE: expected EXPECTED".
    [[noreturn]] void fail(const std::string& where, const std::string& expected) const;

    /// How many entries a list of the file has; none where it is not there.
    std::size_t size(const char* list) const;
    void forEach(
        const char* list,
        const std::function<void(const nlohmann::json&, const std::string& where)>& visit) const;

    /// A whole number below `size`.
    std::size_t index(const nlohmann::json& value, std::size_t size,
                      const std::string& where) const;
    /// The place of an entry of a list.
    std::size_t indexOf(const nlohmann::json& value, const char* list,
                        const std::string& where) const;
    /// Copies a name where there is one, as Assimp can hold it.
    static void copyName(const nlohmann::json& from, nlohmann::json& to);
    /// Copies a list of so many finite numbers where there is one.
    void copyNumbers(const nlohmann::json& from, const char* key, std::size_t count,
                     const std::string& where, nlohmann::json& to) const;

    /// Copies one finite number where there is one.
    void copyNumber(const nlohmann::json& from, const char* key, const std::string& where,
                    nlohmann::json& to) const;

    /// Copies the weights of morph targets where there are some.
    void copyWeights(const nlohmann::json& from, const std::string& where,
                     nlohmann::json& to) const;

    /// Adds buffers, whose contents stay the file's, and views.
    void checkBuffers(nlohmann::json& result);
    void checkAccessors(nlohmann::json& result);
    /// Adds what a primitive is compressed with.
    void addDraco(const nlohmann::json& from, const std::string& where,
                  nlohmann::json& primitive) const;

    /// Why so many elements of so many bytes are not within a buffer view, `packed` or as far from
    /// each other as the view says; empty where they are.
    std::string beyondView(const nlohmann::json& view, std::size_t offset, std::size_t elements,
                           std::size_t bytes, bool packed) const;

    /// What stands in a buffer view of which beyondView() says nothing.
    std::string_view bytesOf(const nlohmann::json& view) const;

    /// The place of an accessor whose bytes are all there.
    std::size_t accessor(const nlohmann::json& value, const std::string& where) const;
    std::size_t count(std::size_t accessor) const { return _accessors[accessor].count; }
    std::size_t bytesOfComponent(std::size_t accessor) const;
    void requireType(std::size_t accessor, std::initializer_list<const char*> types,
                     const std::string& where) const;
    /// Of bytes or shorts, or where `wide` four bytes, as they stand.
    void requireIndices(std::size_t accessor, bool wide, const std::string& where) const;

    /// Not zeros alone, as numbers are that stand nowhere.
    void requireValues(std::size_t accessor, const std::string& where) const;

    /// Takes elements that are asked for, and things with a name, off what the file's size allows.
    void take(std::size_t elements, const std::string& where);
    /// Does so for an accessor that stands nowhere in the file: a few letters for any number of
    /// zeros.
    void takeZeros(std::size_t accessor, const std::string& where);
    void addEntries(std::size_t entries) { _entries += entries; }
    /// Refuses more things than the file's size allows: those added, and what lists are long of.
    void checkEntries() const;

private:
    struct Accessor {
        std::size_t count = 0;
        std::string type;
        int component = 0;
        bool sparse = false;
        bool stored = false; ///< in a buffer view
        std::string wrong;   ///< why it cannot be read; empty: it can
    };

    std::string wrongWith(const nlohmann::json& accessor, const Accessor& known) const;

    const GltfFile& _file;
    std::vector<Accessor> _accessors;
    const std::size_t _bytes;  ///< of the file and its buffers
    std::size_t _elements = 0; ///< that were asked for
    std::size_t _entries = 0;
};

} // namespace osgSkin

#endif
