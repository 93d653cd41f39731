// SPDX-License-Identifier: MIT
#include "mesh/ObjMesh.h"

#include "mesh/Material.h"
#include "text/FileText.h"
#include "text/wavefront/MtlCheck.h"
#include "text/wavefront/ObjCheck.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <tiny_obj_loader.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kSamplesOf = 20; ///< that a material counts for: two kilobytes or three

/// No surface is as bright: such numbers count to 255.
constexpr double kBrightest = 16.0;

float upToOne(double number) {
    return static_cast<float>(std::clamp(number, 0.0, 1.0));
}

osg::Vec4 colour(const tinyobj::real_t (&rgb)[3], double alpha = 1.0) {
    const double most = std::max({double(rgb[0]), double(rgb[1]), double(rgb[2])});
    const double one = most > kBrightest ? 255.0 : 1.0;
    return {upToOne(double(rgb[0]) / one), upToOne(double(rgb[1]) / one),
            upToOne(double(rgb[2]) / one), alpha < 0.0 ? 1.0f : upToOne(alpha)};
}

Material readMaterial(const tinyobj::material_t& source, const std::string& path,
                      const osgDB::Options* options, TextureReads& reads) {
    Material material;
    material.diffuse = colour(source.diffuse, source.dissolve);
    material.specular = colour(source.specular);
    material.emission = colour(source.emission);
    material.shininess = static_cast<float>(source.shininess);
    material.image = readTexture(source.diffuse_texname, path, options, reads);
    return material;
}

/// tinyobjloader's material numbers (-1: none) -> state sets, made when first used.
class MaterialTable {
public:
    MaterialTable(const std::vector<tinyobj::material_t>& materials, const std::string& path,
                  const osgDB::Options* options, bool vertexColours, CornerMesh& mesh)
        : _materials(materials), _path(path), _options(options), _vertexColours(vertexColours),
          _mesh(mesh), _reads(path, options) {}

    std::uint32_t index(int number) {
        const auto [entry, isNew] =
            _indices.emplace(number, static_cast<std::uint32_t>(_mesh.stateSets.size()));
        if (isNew) {
            const bool known = number >= 0 && number < static_cast<int>(_materials.size());
            Material material;
            if (known)
                material = readMaterial(_materials[static_cast<std::size_t>(number)], _path,
                                        _options, _reads);
            material.vertexColours = _vertexColours;
            _mesh.stateSets.push_back(makeStateSet(material));
        }
        return entry->second;
    }

private:
    const std::vector<tinyobj::material_t>& _materials;
    const std::string& _path;
    const osgDB::Options* _options;
    bool _vertexColours;
    CornerMesh& _mesh;
    std::map<int, std::uint32_t> _indices;
    TextureReads _reads;
};

/// Reads material libraries as they are when checked, each file once, and of them the materials
/// that faces use: tinyobjloader takes kilobytes for each.
class CheckedMaterials : public tinyobj::MaterialReader {
public:
    /// \param wanted names of materials
    CheckedMaterials(std::string folder, const ReadLimits& limits, std::set<std::string> wanted)
        : _folder(std::move(folder)), _limits(limits), _wanted(std::move(wanted)) {}

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* numbers, std::string* warning,
                    std::string* error) override {
        const std::string path = _folder.empty() || osgDB::isAbsolutePath(name)
                                     ? name
                                     : osgDB::concatPaths(_folder, name);
        std::error_code missing;
        const std::filesystem::path whole = std::filesystem::canonical(path, missing);
        if (!missing && !_known.insert(whole.string()).second) return true;
        try {
            const CheckedMtl checked = checkMtl(readText(path, _limits), _wanted);
            if (checked.placedTextures > 0)
                tellOf(path, "moved or scaled textures (-o, -s): " +
                                 std::to_string(checked.placedTextures) +
                                 ", drawn as if they were not");
            if (checked.opacityTextures > 0)
                tellOf(path, "textures of opacity (map_d): " +
                                 std::to_string(checked.opacityTextures) + ", left out");
            if (checked.glowTextures > 0)
                tellOf(path,
                       "textures of emission (map_Ke): " + std::to_string(checked.glowTextures) +
                           ", left out, and that surfaces glow with them (Ke)");
            std::istringstream lines(checked.text);
            tinyobj::LoadMtl(numbers, materials, &lines, warning, error);
            return true;
        } catch (const Error& failure) {
            *warning += std::string(failure.what()) + '\n';
            return false;
        }
    }

private:
    const std::string _folder;
    const ReadLimits& _limits;
    std::set<std::string> _wanted; ///< that no library had so far
    std::set<std::string> _known;  ///< libraries that have been read, however they are spelled
};

glm::vec3 normalAt(const tinyobj::attrib_t& attributes, int index) {
    if (index < 0) return glm::vec3(0.0f);
    const tinyobj::real_t* n = &attributes.normals[3 * static_cast<std::size_t>(index)];
    return {n[0], n[1], n[2]};
}

glm::vec2 texCoordAt(const tinyobj::attrib_t& attributes, int index) {
    if (index < 0) return glm::vec2(0.0f);
    const tinyobj::real_t* t = &attributes.texcoords[2 * static_cast<std::size_t>(index)];
    return {t[0], t[1]};
}

void addShape(const tinyobj::mesh_t& shape, const tinyobj::attrib_t& attributes,
              MaterialTable& materials, CornerMesh& result) {
    std::size_t corner = 0;
    for (std::size_t f = 0; f < shape.num_face_vertices.size(); ++f) {
        result.addFace(materials.index(shape.material_ids[f]));
        for (unsigned k = 0; k < shape.num_face_vertices[f]; ++k, ++corner) {
            const tinyobj::index_t& index = shape.indices[corner];
            result.hasTexCoords = result.hasTexCoords || index.texcoord_index >= 0;
            result.addCorner(static_cast<std::uint32_t>(index.vertex_index),
                             normalAt(attributes, index.normal_index),
                             texCoordAt(attributes, index.texcoord_index));
            if (attributes.colors.size() != attributes.vertices.size()) continue;
            const tinyobj::real_t* c =
                &attributes.colors[3 * static_cast<std::size_t>(index.vertex_index)];
            result.colours.emplace_back(c[0], c[1], c[2], 1.0f);
        }
    }
}

} // namespace

CornerMesh readObjMesh(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    const CheckedObj checked = checkObj(path, readText(path, limits));
    const std::size_t most = limits.samplesOf(checked.text.size()) / kSamplesOf;
    if (checked.materials.size() > most)
        failFile(path, std::to_string(checked.materials.size()) + " materials, expected at most " +
                           std::to_string(most) + " (option maxSamples)");

    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning;
    std::string error;
    CheckedMaterials materialReader(osgDB::getFilePath(path), limits, checked.materials);
    std::istringstream stream(checked.text);
    const bool read = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream,
                                       &materialReader, false, false);
    if (!read) failFile(path, error.empty() ? "cannot be parsed" : error);
    // A missing .mtl file is no failure: the body is drawn in the default colour.
    while (!warning.empty() && warning.back() == '\n') warning.pop_back();
    const auto lines = std::count(warning.begin(), warning.end(), '\n');
    if (lines > 0)
        warning =
            warning.substr(0, warning.find('\n')) + " (and " + std::to_string(lines) + " more)";
    if (!warning.empty()) tellOf(path, warning);

    CornerMesh result;
    for (std::size_t k = 0; k + 2 < attributes.vertices.size(); k += 3)
        result.mesh.positions.emplace_back(attributes.vertices[k], attributes.vertices[k + 1],
                                           attributes.vertices[k + 2]);
    // Not in the standard, and written by many: three more numbers after a vertex's position.
    const bool coloured = attributes.colors.size() == attributes.vertices.size();
    if (!coloured && checked.colouredVertices > 0)
        tellOf(path, std::to_string(checked.colouredVertices) + " of " +
                         std::to_string(result.mesh.positions.size()) +
                         " vertices have colours, which are left out");
    // To some a weight that the place is to be divided by, to others a grey, or a scan's quality.
    if (checked.weightedVertices > 0)
        tellOf(path, std::to_string(checked.weightedVertices) + " of " +
                         std::to_string(result.mesh.positions.size()) +
                         " vertices have a fourth number that is not 1; it is left out");
    MaterialTable table(materials, path, options, coloured, result);
    for (const tinyobj::shape_t& shape : shapes) addShape(shape.mesh, attributes, table, result);
    return result;
}

} // namespace osgSkin
