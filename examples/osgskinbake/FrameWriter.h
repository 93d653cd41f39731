// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBAKE_FRAMEWRITER_H
#define OSGSKINBAKE_FRAMEWRITER_H

#include "PosedMesh.h"

#include <osgSkinCharacter/Character>

#include <cstddef>
#include <memory>
#include <string>

namespace bake {

/// What the frames have in common.
struct FrameSeries {
    const osgSkin::Character* character = nullptr;
    std::string name;      ///< of the motion
    std::size_t first = 0; ///< number of the first frame
    std::size_t count = 0; ///< how many frames are to come
    double seconds = 0.0;  ///< from one of them to the next
};

/// Takes a motion's posed meshes, one after the other, and writes them.
class FrameWriter {
public:
    virtual ~FrameWriter() = default;

    /// While the character is in the pose of `posed`.
    ///
    /// \throw osgSkin::Error where it cannot be written
    virtual void add(std::size_t frame, const PosedMesh& posed) = 0;

    /// After the last frame.
    /// \throw osgSkin::Error where it cannot be written
    virtual void finish() {}

    /// By the extension of `out`: .obj and .ply, a file a frame; .pc2 and .glb, one for all.
    /// \throw UsageError for other extensions
    static std::unique_ptr<FrameWriter> make(const std::string& out, const FrameSeries& series);

    /// True where each frame has a file of its own, so that `out` needs a place for its number.
    static bool isSequence(const std::string& out);
};

} // namespace bake

#endif
