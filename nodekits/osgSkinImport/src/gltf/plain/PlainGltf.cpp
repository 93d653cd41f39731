// SPDX-License-Identifier: MIT
#include "gltf/plain/PlainGltf.h"

#include "gltf/GltfAccessors.h"
#include "gltf/GltfExtensions.h"
#include "gltf/GltfFile.h"
#include "gltf/GltfMorphs.h"
#include "gltf/GltfNames.h"
#include "gltf/GltfTracks.h"
#include "gltf/LoadBuffers.h"
#include "gltf/MeshoptViews.h"
#include "gltf/Uri.h"
#include "gltf/plain/GltfCheck.h"
#include "gltf/plain/GltfValues.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <glm/matrix.hpp>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

/// Attributes whose numbers Assimp takes for floats, whatever they are.
bool isTakenForFloats(const std::string& attribute) {
    for (const char* start : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_", "COLOR_", "WEIGHTS_"})
        if (attribute.rfind(start, 0) == 0) return true;
    return false;
}

class Plainer {
public:
    explicit Plainer(GltfFile& file) : _file(file), _accessors(file) {}

    void run() {
        separateMeshes();
        checkValues(_file, _accessors);
        applyMorphs(_file, _accessors);
        nameNodes(_file);
        moveTexCoords(_file, _accessors);
        std::size_t number = 0;
        for (json& skin : list("skins"))
            addBindMatrices(skin, "skins[" + std::to_string(number++) + "]");
        for (json& mesh : list("meshes"))
            for (json& primitive : mesh.at("primitives")) {
                makeFloats(primitive);
                makeJoints(primitive);
                makeIndices(primitive);
            }
        makeTracksLinear(_file, _accessors);
        for (json& image : list("images")) decodeUri(image);
    }

private:
    json& list(const char* key) {
        if (!_file.json.contains(key)) return _none;
        return _file.json.at(key);
    }

    /// A mesh that nodes show with a skin, or different weights of morph targets, becomes one for
    /// each: Assimp keeps both by mesh, and loses the bones that it made before.
    void separateMeshes() {
        std::map<std::size_t, json> useOf;   // mesh -> what its first node shows it with
        std::map<std::size_t, json> weights; // mesh -> its own
        for (json& node : list("nodes")) {
            if (!node.contains("mesh")) continue;
            const auto mesh = node.at("mesh").get<std::size_t>();
            json& meshes = _file.json.at("meshes");
            weights.emplace(mesh, meshes.at(mesh).value("weights", json()));
            const json shown = node.value("weights", weights.at(mesh));
            node.erase("weights");
            const json use = json::array({node.value("skin", json()), shown});
            const bool isFirst = useOf.count(mesh) == 0;
            if (!isFirst && useOf.at(mesh) == use && !node.contains("skin")) continue;
            if (!isFirst) {
                const json copy = meshes.at(mesh);
                meshes.push_back(copy);
                node["mesh"] = meshes.size() - 1;
            }
            useOf.emplace(mesh, use);
            json& own = meshes.at(node.at("mesh").get<std::size_t>());
            if (shown.is_null())
                own.erase("weights"); // another node's
            else
                own["weights"] = shown;
        }
    }

    /// What is read then goes by the joints' nodes.
    void tellOfFlat(const json& skin, const std::vector<double>& matrices) const {
        std::size_t flat = 0;
        for (std::size_t joint = 0; joint < skin.at("joints").size(); ++joint) {
            const double* matrix = matrices.data() + 16 * joint;
            glm::dmat3 axes;
            for (int column = 0; column < 3; ++column)
                for (int row = 0; row < 3; ++row) axes[column][row] = matrix[4 * column + row];
            flat += glm::determinant(axes) == 0.0;
        }
        if (flat > 0)
            tellOf(_file.path, "skin " + osgSkin::inQuotes(skin.value("name", "")) + " has " +
                                   std::to_string(flat) +
                                   " inverse bind matrices without an inverse, whose joints are "
                                   "bound where their nodes stand");
    }

    /// Without inverse bind matrices, all of them are the identity (section 3.7.3.1).
    void addBindMatrices(json& skin, const std::string& where) {
        const std::size_t joints = skin.at("joints").size();
        if (skin.contains("inverseBindMatrices")) {
            const auto index = skin.at("inverseBindMatrices").get<std::size_t>();
            if (_accessors.width(index) != 16 || _accessors.count(index) < joints)
                failFile(_file.path, "skin " + osgSkin::inQuotes(skin.value("name", "")) + " has " +
                                         std::to_string(_accessors.count(index)) +
                                         " inverse bind matrices for " + std::to_string(joints) +
                                         " joints");
            const std::vector<double> matrices = _accessors.values(index);
            requireCoordinates(_file, index, where + ".inverseBindMatrices", matrices);
            tellOfFlat(skin, matrices);
            if (!_accessors.isPlain(index))
                skin["inverseBindMatrices"] = _accessors.add("MAT4", matrices);
            return;
        }
        std::vector<double> matrices(16 * joints, 0.0);
        for (std::size_t i = 0; i < matrices.size(); ++i)
            if (i % 16 % 5 == 0) matrices[i] = 1.0;
        skin["inverseBindMatrices"] = _accessors.add("MAT4", matrices);
    }

    void makeFloats(json& primitive) {
        const bool isCompressed = primitive.contains("extensions");
        for (auto& [name, index] : primitive.at("attributes").items()) {
            if (!isTakenForFloats(name)) continue;
            const auto accessor = index.get<std::size_t>();
            if (isCompressed && !_accessors.hasValues(accessor)) continue;
            // Assimp takes colours without opacity for transparent ones.
            const bool isOpaque = name.rfind("COLOR_", 0) == 0 && _accessors.width(accessor) == 3;
            if (_accessors.isPlain(accessor) && !isOpaque) continue;
            const auto [entry, isNew] = _floats.emplace(std::make_pair(accessor, isOpaque), 0);
            if (isNew) entry->second = isOpaque ? addOpaque(accessor) : addFloats(accessor);
            index = entry->second;
        }
    }

    /// Assimp takes all joints of a primitive for numbers of as many bytes as the first ones.
    void makeJoints(json& primitive) {
        std::map<std::string, std::size_t> joints;
        std::set<std::size_t> bytes;
        bool areWhole = true;
        for (const auto& [name, index] : primitive.at("attributes").items()) {
            const auto accessor = index.get<std::size_t>();
            if (name.rfind("JOINTS_", 0) != 0 || !_accessors.hasValues(accessor)) continue;
            joints.emplace(name, accessor);
            bytes.insert(_accessors.componentBytes(accessor));
            areWhole = areWhole && _accessors.isWhole(accessor);
        }
        if (areWhole && bytes.size() <= 1) return;
        for (const auto& [name, accessor] : joints) {
            const auto [entry, isNew] = _shorts.emplace(accessor, 0);
            if (isNew) entry->second = _accessors.addShorts("VEC4", _accessors.stored(accessor));
            primitive["attributes"][name] = entry->second;
        }
    }

    /// Assimp has no indices that are sparse.
    void makeIndices(json& primitive) {
        if (!primitive.contains("indices")) return;
        const auto accessor = primitive.at("indices").get<std::size_t>();
        if (!_accessors.hasValues(accessor) || _accessors.isWhole(accessor)) return;
        const auto [entry, isNew] = _ints.emplace(accessor, 0);
        if (isNew) entry->second = _accessors.addInts("SCALAR", _accessors.stored(accessor));
        primitive["indices"] = entry->second;
    }

    std::size_t addFloats(std::size_t accessor) {
        const std::string type =
            _file.json.at("accessors").at(accessor).at("type").get<std::string>();
        return _accessors.add(type, _accessors.values(accessor));
    }

    std::size_t addOpaque(std::size_t accessor) {
        const std::vector<double> colours = _accessors.values(accessor);
        std::vector<double> result;
        result.reserve(colours.size() / 3 * 4);
        for (std::size_t i = 0; i < colours.size(); ++i) {
            result.push_back(colours[i]);
            if (i % 3 == 2) result.push_back(1.0);
        }
        return _accessors.add("VEC4", result);
    }

    /// "my%20file.png" is called "my file.png". A byte 0, which ends Assimp's names and is in no
    /// file's, stays escaped.
    static void decodeUri(json& named) {
        if (!named.contains("uri")) return;
        const std::string uri = named.at("uri").get<std::string>();
        if (isDataUri(uri)) return;
        std::string name = decodedUri(uri);
        for (std::size_t zero = 0; (zero = name.find('\0', zero)) != std::string::npos;)
            name.replace(zero, 1, "%00");
        named["uri"] = name;
    }

    GltfFile& _file;
    GltfAccessors _accessors;
    /// Accessors that have been converted, and whether to opaque colours.
    std::map<std::pair<std::size_t, bool>, std::size_t> _floats;
    std::map<std::size_t, std::size_t> _shorts; ///< the same, to joints of two bytes
    std::map<std::size_t, std::size_t> _ints;   ///< and to indices of four
    json _none = json::array();
};

} // namespace

bool isGltfName(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return extension == "gltf" || extension == "glb" || extension == "vrm";
}

PlainGltf plainGltf(const std::string& path, const ReadLimits& limits) {
    GltfFile file = GltfFile::read(path, limits);
    try {
        const bool backwards = facesBackwards(file);
        noteExtensions(file);
        loadBuffers(file);
        unpackMeshopt(file);
        file.json = checkedGltf(file);
        Plainer(file).run();
        return PlainGltf{file.bytes(), backwards};
    } catch (const json::exception& error) {
        failFile(path, "malformed glTF: " + reasonOf(error));
    }
}

} // namespace osgSkin
