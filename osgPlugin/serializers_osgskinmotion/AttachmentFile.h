// SPDX-License-Identifier: MIT
#pragma once

#include "Archive.h"

namespace osgSkin {

class ClipPlayer;
class FaceControls;
class FootPlacement;
class HitBoxes;
class SpringBones;

/// Describes what files keep of attachments: their friend.
struct AttachmentFile {
    template <typename Archive>
    static void pass(Archive& archive, ClipPlayer& player);
    template <typename Archive>
    static void pass(Archive& archive, FaceControls& face);
    template <typename Archive>
    static void pass(Archive& archive, FootPlacement& feet);
    template <typename Archive>
    static void pass(Archive& archive, HitBoxes& hits);
    template <typename Archive>
    static void pass(Archive& archive, SpringBones& springs);
};

} // namespace osgSkin
