// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "KnownBody.h"

/// Figures as people have them, made from one whose joints are known: y up, facing +z.
namespace wild {

/// In a jacket, a skirt and shoes of single faces, with hair, eyes and teeth.
KnownBody clothed(const KnownBody& body);

/// The same without the skin that clothes hide.
KnownBody hollowClothed(const KnownBody& body);

/// Cut into a piece a limb, each shrunk towards its middle by a fraction; with lids or open.
KnownBody segmented(const KnownBody& body, double shrunk, bool lids);

/// Capsules about the same joints, each a shell of its own; head, hands and feet are balls.
KnownBody mannequin(const KnownBody& body);

/// The head larger by a factor, the legs below the hips shorter by another.
KnownBody cartoon(const KnownBody& body, double head, double legs);

/// Arms thinner by a factor from the shoulders to the wrists, hands smaller by another.
KnownBody thinArms(const KnownBody& body, double arms, double hands);

/// Faces of the left half the other way around, and all of them twice.
KnownBody flawed(const KnownBody& body);

} // namespace wild
