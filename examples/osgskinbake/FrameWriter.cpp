// SPDX-License-Identifier: GPL-3.0-or-later
#include "FrameWriter.h"

#include "Arguments.h"
#include "GlbMorphs.h"
#include "ObjWriter.h"
#include "PlyWriter.h"
#include "PointCache.h"

#include <osgDB/FileNameUtils>

namespace bake {
namespace {

/// An OBJ file for each frame.
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

/// A PLY file for each frame.
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
