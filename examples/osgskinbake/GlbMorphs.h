// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Bytes.h"
#include "FrameWriter.h"

#include <nlohmann/json.hpp>

namespace bake {

/// A binary glTF file whose mesh is the first frame, with a morph target for each further one, and
/// an animation that goes from one to the next: between two frames vertices go straight. Anything
/// that plays glTF plays it, without a skin model and without a skeleton.
class GlbMorphs : public FrameWriter {
public:
    GlbMorphs(std::string file, const FrameSeries& series);
    void add(std::size_t frame, const PosedMesh& posed) override;
    void finish() override;

private:
    enum class Use { Vertices, Indices, Data };
    /// Adds what has been put into the buffer since `begin`. Returns the accessor's index.
    std::size_t accessor(std::size_t begin, std::size_t count, const char* type, int component,
                         Use use);
    std::size_t addVectors(const std::vector<glm::dvec3>& vectors, bool withRange);
    std::size_t addIndices();
    nlohmann::json animation();

    std::string _file;
    FrameSeries _series;
    PosedMesh _base;
    Bytes _buffer;
    nlohmann::json _views = nlohmann::json::array();
    nlohmann::json _accessors = nlohmann::json::array();
    nlohmann::json _attributes;
    nlohmann::json _targets = nlohmann::json::array();
    std::size_t _frames = 0;
};

} // namespace bake
