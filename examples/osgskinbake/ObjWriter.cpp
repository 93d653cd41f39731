// SPDX-License-Identifier: MIT
#include "ObjWriter.h"

#include "Bytes.h"
#include "Surface.h"

#include <cinttypes>
#include <cstdio>
#include <map>
#include <osgDB/FileNameUtils>

namespace bake {

ObjWriter::ObjWriter(const osgSkin::Character& character, const std::string& name)
    : _character(character), _mesh(character.body.mesh), _library(libraryName(name)),
      _surfaces(surfacesOf(character)), _materials(_mesh.faceSizes.size(), 0),
      _texCoordOf(_mesh.faceVertices.size(), kNone), _colours(vertexColoursOf(_surfaces, _mesh)) {
    std::size_t corner = 0;
    for (const std::uint32_t size : _mesh.faceSizes) {
        _firstCorner.push_back(corner);
        corner += size;
    }
    for (std::uint32_t k = 0; k < _surfaces.size(); ++k) addSurface(_surfaces[k], k);
}

void ObjWriter::addSurface(const Surface& surface, std::uint32_t material) {
    const std::size_t first = _texCoords.size();
    _texCoords.insert(_texCoords.end(), surface.texCoords.begin(), surface.texCoords.end());
    std::multimap<std::uint32_t, std::size_t> corners; // of the face, not yet assigned, by vertex
    std::uint32_t current = kNone;
    for (std::size_t t = 0; t < surface.sourceFace.size(); ++t) {
        const std::uint32_t face = surface.sourceFace[t];
        _materials[face] = material;
        if (surface.texCoords.empty()) continue;
        if (face != current) {
            corners.clear();
            for (std::size_t c = 0; c < _mesh.faceSizes[face]; ++c)
                corners.emplace(_mesh.faceVertices[_firstCorner[face] + c], _firstCorner[face] + c);
            current = face;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = surface.triangles[3 * t + k];
            const auto [begin, end] = corners.equal_range(surface.sourceVertex[v]);
            for (auto corner = begin; corner != end; ++corner)
                _texCoordOf[corner->second] = static_cast<std::uint32_t>(first + v);
            corners.erase(begin, end);
        }
    }
}

void ObjWriter::write(const std::string& file, const PosedMesh& posed) {
    WholeFile whole(file);
    std::FILE* const out = whole.stream();
    std::fprintf(out, "mtllib %s\n", _library.c_str());
    for (std::size_t v = 0; v < posed.positions.size(); ++v) {
        const glm::dvec3& p = posed.positions[v];
        std::fprintf(out, "v %.9g %.9g %.9g", p.x, p.y, p.z);
        if (!_colours.empty())
            std::fprintf(out, " %.4f %.4f %.4f", double(_colours[v].r()), double(_colours[v].g()),
                         double(_colours[v].b()));
        std::fputc('\n', out);
    }
    for (const osg::Vec2& t : _texCoords)
        std::fprintf(out, "vt %.9g %.9g\n", double(t.x()), double(t.y()));
    for (const glm::dvec3& n : posed.normals)
        std::fprintf(out, "vn %.5f %.5f %.5f\n", n.x, n.y, n.z);
    writeFaces(out);
    whole.finish();
    const std::string library = osgDB::concatPaths(osgDB::getFilePath(file), _library);
    if (_libraries.insert(library).second)
        writeLibrary(library, _surfaces, osgDB::getFilePath(_character.meshFile));
}

void ObjWriter::writeFaces(std::FILE* out) const {
    for (std::size_t f = 0; f < _mesh.faceSizes.size(); ++f) {
        if (f == 0 || _materials[f] != _materials[f - 1])
            std::fprintf(out, "usemtl %s\n", materialName(_materials[f]).c_str());
        std::fputc('f', out);
        for (std::uint32_t k = 0; k < _mesh.faceSizes[f]; ++k) {
            const std::size_t corner = _firstCorner[f] + k;
            const std::uint32_t v = _mesh.faceVertices[corner] + 1;
            if (_texCoordOf[corner] == kNone)
                std::fprintf(out, " %" PRIu32 "//%" PRIu32, v, v);
            else
                std::fprintf(out, " %" PRIu32 "/%" PRIu32 "/%" PRIu32, v, _texCoordOf[corner] + 1,
                             v);
        }
        std::fputc('\n', out);
    }
}

} // namespace bake
