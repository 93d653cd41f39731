// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "KnownBody.h"

/// Figures in the style of users' models, derived from one with known joints: y up, facing +z.
namespace wild {

/// In a jacket, a skirt and shoes without thickness, with hair, eyes and teeth.
KnownBody clothed(const KnownBody& body);

/// The same without the skin below the clothes.
KnownBody hollowClothed(const KnownBody& body);

/// Cut into one piece per limb, each shrunk towards its centre by a fraction; capped or open.
KnownBody segmented(const KnownBody& body, double shrunk, bool lids);

/// Capsules around the same joints, each a separate shell; head, hands and feet are balls.
KnownBody mannequin(const KnownBody& body);

/// Scales the head by one factor, and the length of the legs by another.
KnownBody cartoon(const KnownBody& body, double head, double legs);

/// Scales the thickness of the arms, from shoulders to wrists, by one factor and the hands by
/// another.
KnownBody thinArms(const KnownBody& body, double arms, double hands);

/// The left half's faces with reversed winding, and all faces twice.
KnownBody flawed(const KnownBody& body);

} // namespace wild
