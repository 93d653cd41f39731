// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "FrameWriter.h"
#include "WholeFile.h"

#include <string>

namespace bake {

/// A point cache (PC2): the places of all vertices, frame by frame. Blender's Mesh Cache modifier
/// and others play it on a mesh of the same vertices in the same order, such as that of --rest.
class PointCache : public FrameWriter {
public:
    PointCache(const std::string& file, const FrameSeries& series);
    void add(std::size_t frame, const PosedMesh& posed) override;
    void finish() override;

private:
    WholeFile _out;
};

} // namespace bake
