// SPDX-License-Identifier: MIT
#ifndef OSGSKINBAKE_FRAMEWRITER_H
#define OSGSKINBAKE_FRAMEWRITER_H

#include "PosedMesh.h"

#include <osgSkinCharacter/Character>

#include <cstddef>
#include <memory>
#include <string>

namespace bake {

/// Properties of a sequence of frames.
struct FrameSeries {
    const osgSkin::Character* character = nullptr;
    std::string name;      ///< of the motion
    std::size_t first = 0; ///< number of the first frame
    std::size_t count = 0; ///< number of frames
    double seconds = 0.0;  ///< time between two frames
};

/// Writes the posed meshes of a motion, frame by frame.
class FrameWriter {
public:
    virtual ~FrameWriter() = default;

    /// Adds a frame.
    ///
    /// \pre the character is in the pose of `posed`
    /// \throw osgSkin::Error if it cannot be written
    virtual void add(std::size_t frame, const PosedMesh& posed) = 0;

    /// Adds a shape that the character can take in the only frame, as a facial expression; formats
    /// without morph targets leave it out.
    ///
    /// \param name of the morph target
    /// \param posed the frame with its weight 1
    virtual void addMorph(const std::string& name, const PosedMesh& posed) {
        (void)name;
        (void)posed;
    }

    /// Called after the last frame.
    /// \throw osgSkin::Error if it cannot be written
    virtual void finish() {}

    /// Makes a writer by the extension of `out`: one file per frame for .obj and .ply, one file for
    /// all frames for .pc2 and .glb.
    /// \throw UsageError for other extensions
    static std::unique_ptr<FrameWriter> make(const std::string& out, const FrameSeries& series);

    /// True if each frame has its own file, so that `out` needs a placeholder for the number.
    static bool isSequence(const std::string& out);
};

} // namespace bake

#endif
