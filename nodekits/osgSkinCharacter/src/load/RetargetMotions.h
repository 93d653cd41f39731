// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options/LoadReport.h"
#include "source/CharacterSource.h"

#include <osgSkin/Binding>
#include <osgSkinCharacter/CharacterMotion>

#include <vector>

namespace osgSkin {

/// Reads the source's motion files and retargets them to its rest skeleton: clips and reports, no
/// animations yet.
///
/// \param source gets a note for what is likely not as wanted
/// \param readOptions with words of ReadLimits; may be null
/// \param stages are told of each file
/// \return one motion for each file, in order
/// \throw Error with the motion file and the reason
std::vector<CharacterMotion> retargetMotions(CharacterSource& source,
                                             const osgDB::Options* readOptions, LoadStages& stages);

/// Makes the motions' animations, after keeping hands out of the body where the source says so.
///
/// \param motions of retargetMotions()
/// \param binding of the source's body
void animateMotions(const CharacterSource& source, const Binding& binding,
                    std::vector<CharacterMotion>& motions);

} // namespace osgSkin
