// SPDX-License-Identifier: MIT
#include "FrameWriter.h"

#include "Arguments.h"
#include "Bytes.h"
#include "Glb.h"
#include "ObjWriter.h"
#include "PosedMesh.h"
#include "Surface.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/Character>

#include <osg/Vec4>
#include <osgDB/FileNameUtils>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace bake {

namespace {

/// Writes binary PLY files of a body's poses: vertices, normals, colours if the body has them, and
/// the mesh's own faces.
class PlyWriter {
public:
    explicit PlyWriter(const osgSkin::Character& character);

    /// Writes a file.
    /// \throw osgSkin::Error if it cannot be written
    void write(const std::string& file, const PosedMesh& posed) const;

private:
    const osgSkin::SkinMesh& _mesh;
    std::vector<osg::Vec4> _colours; ///< one per vertex of the mesh, or empty
};
PlyWriter::PlyWriter(const osgSkin::Character& character)
    : _mesh(character.body.mesh), _colours(vertexColoursOf(surfacesOf(character), _mesh)) {}

void PlyWriter::write(const std::string& file, const PosedMesh& posed) const {
    Bytes bytes;
    bytes.data = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                 std::to_string(posed.positions.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
        bytes.data += std::string("property float ") + name + "\n";
    if (!_colours.empty())
        for (const char* name : {"red", "green", "blue", "alpha"})
            bytes.data += std::string("property uchar ") + name + "\n";
    bytes.data += "element face " + std::to_string(_mesh.faceSizes.size()) +
                  "\nproperty list uint uint vertex_indices\nend_header\n";
    for (std::size_t v = 0; v < posed.positions.size(); ++v) {
        bytes.add(posed.positions[v]);
        bytes.add(posed.normals[v]);
        for (unsigned k = 0; k < 4 && !_colours.empty(); ++k)
            bytes.add(static_cast<std::uint8_t>(std::lround(_colours[v][k] * 255.0f)));
    }
    std::size_t corner = 0;
    for (const std::uint32_t size : _mesh.faceSizes) {
        bytes.add(size);
        for (std::uint32_t k = 0; k < size; ++k) bytes.add(_mesh.faceVertices[corner++]);
    }
    writeBytes(file, bytes.data);
}

/// A point cache (PC2): the positions of all vertices, frame by frame. Blender's Mesh Cache
/// modifier, for example, plays it on a mesh with the same vertices in the same order, such as that
/// of --rest.
class PointCache : public FrameWriter {
public:
    PointCache(const std::string& file, const FrameSeries& series);
    void add(std::size_t frame, const PosedMesh& posed) override;
    void finish() override;

private:
    WholeFile _out;
};
PointCache::PointCache(const std::string& file, const FrameSeries& series) : _out(file) {
    if (series.count > std::size_t(std::numeric_limits<std::int32_t>::max()))
        throw osgSkin::Error(file + ": too many frames for a point cache");
    Bytes header;
    header.data = std::string("POINTCACHE2\0", 12);
    header.add(std::int32_t(1)); // version
    header.add(static_cast<std::int32_t>(series.character->body.mesh.positions.size()));
    header.add(static_cast<float>(series.first));
    header.add(1.0f); // frames per sample
    header.add(static_cast<std::int32_t>(series.count));
    _out.write(header.data);
}

void PointCache::add(std::size_t, const PosedMesh& posed) {
    Bytes sample;
    for (const glm::dvec3& position : posed.positions) sample.add(position);
    _out.write(sample.data);
}

void PointCache::finish() {
    _out.finish();
}

/// One OBJ file per frame.
class ObjSequence : public FrameWriter {
public:
    ObjSequence(std::string pattern, const osgSkin::Character& character)
        : _pattern(std::move(pattern)), _writer(character, _pattern) {}

    void add(std::size_t frame, const PosedMesh& posed) override {
        _writer.write(frameName(_pattern, frame), posed);
    }

private:
    std::string _pattern;
    ObjWriter _writer;
};

/// One PLY file per frame.
class PlySequence : public FrameWriter {
public:
    PlySequence(std::string pattern, const osgSkin::Character& character)
        : _pattern(std::move(pattern)), _writer(character) {}

    void add(std::size_t frame, const PosedMesh& posed) override {
        _writer.write(frameName(_pattern, frame), posed);
    }

private:
    std::string _pattern;
    PlyWriter _writer;
};

} // namespace

bool FrameWriter::isSequence(const std::string& out) {
    const std::string extension = osgDB::getLowerCaseFileExtension(out);
    return extension != "pc2" && extension != "glb";
}

std::unique_ptr<FrameWriter> FrameWriter::make(const std::string& out, const FrameSeries& series) {
    const std::string extension = osgDB::getLowerCaseFileExtension(out);
    if (extension == "obj") return std::make_unique<ObjSequence>(out, *series.character);
    if (extension == "ply") return std::make_unique<PlySequence>(out, *series.character);
    if (extension == "pc2") return std::make_unique<PointCache>(out, series);
    if (extension == "glb") return std::make_unique<GlbMorphs>(out, series);
    throw UsageError{"--out: expected a name that ends in .obj, .ply, .pc2 or .glb, found \"" +
                     out + "\""};
}

} // namespace bake
