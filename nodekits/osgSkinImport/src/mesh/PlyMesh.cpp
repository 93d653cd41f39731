// SPDX-License-Identifier: MIT
#include "mesh/PlyMesh.h"

#include "mesh/Material.h"
#include "text/FileText.h"
#include "text/PlyBody.h"
#include "text/PlyHeader.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string_view>

namespace osgSkin {
namespace {

using Place = std::optional<std::size_t>;

constexpr double kNoTexture = -1.0; ///< whatever number stands for a texture that is not there

/// What stands for a colour of 1. Types say less of that than the numbers do: many programs write
/// 0 to 255 as whatever whole type.
struct FullColour {
    bool isWhole = false; ///< whether of a type without fractions; others are left as they are
    double most = 0.0;    ///< the largest number

    void take(double number) { most = std::max(most, number); }

    float number() const {
        if (!isWhole) return 1.0f;
        return most <= 255.0 ? 255.0f : most <= 65535.0 ? 65535.0f : 4294967295.0f;
    }
};

/// Collects vertices and faces from the entries of a file, in any order of the elements.
class PlyCollector {
public:
    PlyCollector(const std::string& path, const PlyHeader& header)
        : _path(path), _textureCount(static_cast<double>(header.textures.size())) {
        for (const PlyHeader::Element& element : header.elements) {
            if (element.name == "vertex") placeVertex(element);
            if (element.name == "face") {
                _indices = element.find({"vertex_indices", "vertex_index"});
                _cornerTexCoords = element.find({"texcoord"});
                _texture = element.find({"texnumber"});
                if (element.find({"red", "diffuse_red"}))
                    tellOf(path, "colours of faces are left out");
            }
            if (element.name == "multi_texture_vertex")
                tellOf(path, "texture coordinates of \"multi_texture_vertex\" are left out");
            if (element.name == "tristrips")
                _strips = element.find({"vertex_indices", "vertex_index"});
        }
    }

    void take(const PlyHeader::Element& element, std::size_t index, const PlyValues& values) {
        if (element.name == "vertex")
            addVertex(values);
        else if (element.name == "face" && _indices)
            addFace(index, values[*_indices],
                    _cornerTexCoords ? values[*_cornerTexCoords] : std::vector<double>(),
                    _texture ? at(values, _texture) : 0.0);
        else if (element.name == "tristrips" && _strips)
            addStrips(values[*_strips]);
    }

    bool hasColours() const { return !_colours.empty(); }

    /// \param addMaterial makes one with a texture, by its number, and returns its own number
    CornerMesh finish(const std::function<std::uint32_t(double)>& addMaterial) {
        CornerMesh result;
        for (glm::vec4& colour : _colours)
            for (int k = 0; k < 4; ++k)
                colour[k] =
                    colour[k] < 0.0f ? 1.0f : colour[k] / _full[std::size_t(k / 3)].number();
        std::map<double, std::uint32_t> materials; // by their textures' numbers
        result.mesh.positions = std::move(_positions);
        const std::size_t vertices = result.mesh.positions.size();
        std::size_t corner = 0;
        for (std::size_t f = 0; f < _faceSizes.size(); ++f) {
            const std::uint32_t size = _faceSizes[f];
            const double texture = _textures.empty() ? 0.0 : _textures[f];
            auto material = materials.find(texture);
            if (material == materials.end())
                material = materials.emplace(texture, addMaterial(texture)).first;
            result.addFace(material->second);
            for (std::uint32_t k = 0; k < size; ++k, ++corner) {
                const std::uint32_t v = _corners[corner];
                if (v >= vertices)
                    failFile(_path, "face " + std::to_string(result.mesh.faceSizes.size() - 1) +
                                        " names vertex " + std::to_string(v) +
                                        ", expected less than " + std::to_string(vertices));
                glm::vec2 texCoord(0.0f);
                if (!_faceTexCoords.empty())
                    texCoord = _faceTexCoords[corner];
                else if (!_texCoords.empty())
                    texCoord = _texCoords[v];
                result.addCorner(v, _normals.empty() ? glm::vec3(0.0f) : _normals[v], texCoord);
                if (!_colours.empty()) result.colours.push_back(_colours[v]);
            }
        }
        result.hasTexCoords = !_faceTexCoords.empty() || !_texCoords.empty();
        return result;
    }

private:
    void placeVertex(const PlyHeader::Element& element) {
        _x = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        if (!_x[0] || !_x[1] || !_x[2])
            failFile(
                _path,
                "the header's element vertex has no x, y and z, expected properties so called");
        _n = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
        _t = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
        _c = {element.find({"red", "diffuse_red", "r"}),
              element.find({"green", "diffuse_green", "g"}),
              element.find({"blue", "diffuse_blue", "b"}),
              element.find({"alpha", "diffuse_alpha", "a"})};
        for (std::size_t k = 0; k < 4; ++k) {
            if (!_c[k]) continue;
            const PlyHeader::Type& type = element.properties[*_c[k]].type;
            _full[k / 3].isWhole |= type.kind != PlyHeader::Kind::Floating;
        }
    }

    /// A vertex's number; a list gives its first.
    static double at(const PlyValues& values, const Place& place) {
        return values[*place].empty() ? 0.0 : values[*place].front();
    }

    void addVertex(const PlyValues& values) {
        _positions.emplace_back(at(values, _x[0]), at(values, _x[1]), at(values, _x[2]));
        if (_n[0] && _n[1] && _n[2])
            _normals.emplace_back(at(values, _n[0]), at(values, _n[1]), at(values, _n[2]));
        if (_t[0] && _t[1]) _texCoords.emplace_back(at(values, _t[0]), at(values, _t[1]));
        if (!_c[0] || !_c[1] || !_c[2]) return;
        glm::vec4 colour(-1.0f); // none: opaque
        for (std::size_t k = 0; k < 4; ++k) {
            if (!_c[k]) continue;
            const double number = at(values, _c[k]);
            colour[int(k)] = static_cast<float>(number < 0.0 ? 0.0 : number);
            _full[k / 3].take(double(colour[int(k)]));
        }
        _colours.push_back(colour);
    }

    std::uint32_t indexOf(double number, const std::string& where) const {
        if (!(number >= 0.0 && number < 4294967295.0) || number != std::floor(number))
            failFile(_path, where + " names vertex " + std::to_string(number) +
                                ", expected one of the file's");
        return static_cast<std::uint32_t>(number);
    }

    void addFace(std::size_t index, const std::vector<double>& corners,
                 const std::vector<double>& texCoords, double texture) {
        if (corners.size() < 3) return; // points and lines
        if (_texture)
            _textures.push_back(texture >= 0.0 && texture < _textureCount ? std::floor(texture)
                                                                          : kNoTexture);
        _faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
        for (const double corner : corners)
            _corners.push_back(indexOf(corner, "face " + std::to_string(index)));
        if (!_cornerTexCoords) return;
        for (std::size_t k = 0; k < corners.size(); ++k)
            _faceTexCoords.push_back(2 * k + 1 < texCoords.size()
                                         ? glm::vec2(texCoords[2 * k], texCoords[2 * k + 1])
                                         : glm::vec2(0.0f));
    }

    /// Strips one after the other, a negative number between them.
    void addStrips(const std::vector<double>& strip) {
        std::size_t begin = 0;
        for (std::size_t k = 0; k < strip.size(); ++k) {
            if (strip[k] < 0.0) begin = k + 1;
            if (strip[k] < 0.0 || k < begin + 2) continue;
            const bool odd = (k - begin) % 2 != 0;
            _faceSizes.push_back(3);
            if (_texture) _textures.push_back(0.0);
            for (const std::size_t c : {odd ? k - 1 : k - 2, odd ? k - 2 : k - 1, k})
                _corners.push_back(indexOf(strip[c], "a strip"));
            // Faces beside strips may have them.
            if (_cornerTexCoords) _faceTexCoords.resize(_corners.size(), glm::vec2(0.0f));
        }
    }

    const std::string& _path;
    const double _textureCount;
    std::array<Place, 3> _x, _n;
    std::array<Place, 2> _t;
    std::array<Place, 4> _c;
    std::array<FullColour, 2> _full; ///< of red, green and blue; of alpha
    Place _indices, _cornerTexCoords, _texture, _strips;
    std::vector<glm::dvec3> _positions;
    std::vector<glm::vec3> _normals;
    std::vector<glm::vec2> _texCoords, _faceTexCoords;
    std::vector<glm::vec4> _colours;
    std::vector<std::uint32_t> _faceSizes, _corners;
    std::vector<double> _textures; ///< of each face its texture's number; of the header's list
};

} // namespace

CornerMesh readPlyMesh(const std::string& path, const osgDB::Options* options) {
    const std::string text = readText(path, ReadLimits::of(options));
    const PlyHeader header = readPlyHeader(path, text);
    PlyCollector collector(path, header);
    readPlyBody(path, header, std::string_view(text).substr(header.end),
                [&](const PlyHeader::Element& element, std::size_t index, const PlyValues& values) {
                    collector.take(element, index, values);
                });
    TextureReads reads(path, options);
    std::vector<osg::ref_ptr<osg::StateSet>> stateSets;
    CornerMesh result = collector.finish([&](double texture) {
        Material material;
        material.vertexColours = collector.hasColours();
        if (texture >= 0.0 && texture < double(header.textures.size()))
            material.image = readTexture(header.textures[static_cast<std::size_t>(texture)], path,
                                         options, reads);
        stateSets.push_back(makeStateSet(material));
        return static_cast<std::uint32_t>(stateSets.size() - 1);
    });
    result.stateSets = stateSets;
    return result;
}

} // namespace osgSkin
