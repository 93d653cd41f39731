// SPDX-License-Identifier: GPL-3.0-or-later
#include "FrameWriter.h"

#include "Arguments.h"
#include "GlbMorphs.h"
#include "PlyWriter.h"
#include "PointCache.h"
#include "Writers.h"

#include <osgDB/FileNameUtils>

namespace bake {
namespace {

/// A file for each frame.
class Sequence : public FrameWriter {
public:
    using Write = void (*)(const std::string&, const osgSkin::SkinMesh&, const PosedMesh&);

    Sequence(std::string pattern, const osgSkin::SkinMesh& mesh, Write write)
        : _pattern(std::move(pattern)), _mesh(mesh), _write(write) {}

    void add(std::size_t frame, const PosedMesh& posed) override {
        _write(frameName(_pattern, frame), _mesh, posed);
    }

private:
    std::string _pattern;
    const osgSkin::SkinMesh& _mesh;
    Write _write;
};

} // namespace

bool FrameWriter::isSequence(const std::string& out) {
    const std::string extension = osgDB::getLowerCaseFileExtension(out);
    return extension != "pc2" && extension != "glb";
}

std::unique_ptr<FrameWriter> FrameWriter::make(const std::string& out, const FrameSeries& series) {
    const std::string extension = osgDB::getLowerCaseFileExtension(out);
    if (extension == "obj") return std::make_unique<Sequence>(out, *series.mesh, writeObj);
    if (extension == "ply") return std::make_unique<Sequence>(out, *series.mesh, writePly);
    if (extension == "pc2") return std::make_unique<PointCache>(out, series);
    if (extension == "glb") return std::make_unique<GlbMorphs>(out, series);
    throw UsageError{"--out: expected a name that ends in .obj, .ply, .pc2 or .glb, found \"" +
                     out + "\""};
}

} // namespace bake
