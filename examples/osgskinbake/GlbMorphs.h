// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "FrameWriter.h"
#include "GlbBuffer.h"
#include "GlbMaterials.h"
#include "Surface.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace bake {

/// A binary glTF file whose mesh is the first frame, with a morph target for each further one, and
/// an animation that goes from one to the next: between two frames vertices go straight. Anything
/// that plays glTF plays it, without a skin model and without a skeleton. A primitive for each
/// material, with its texture.
class GlbMorphs : public FrameWriter {
public:
    GlbMorphs(std::string file, const FrameSeries& series);
    void add(std::size_t frame, const PosedMesh& posed) override;
    void finish() override;

private:
    /// A surface while its frames come in.
    struct Primitive {
        Surface surface;
        SurfaceMaterial material;
        std::vector<glm::dvec3> positions, normals; ///< of the first frame
        nlohmann::json attributes;
        nlohmann::json targets = nlohmann::json::array();
    };
    void addFirst(Primitive& primitive, const PosedMesh& posed);
    void addTarget(Primitive& primitive, const PosedMesh& posed);
    nlohmann::json animation();

    std::string _file;
    FrameSeries _series;
    GlbBuffer _buffer;
    GlbMaterials _materials;
    std::vector<Primitive> _primitives;
    std::size_t _frames = 0;
};

} // namespace bake
