// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_LOAD_LOADSTEPS_H
#define OSGSKINCHARACTER_LOAD_LOADSTEPS_H

#include "source/CharacterSource.h"
#include "source/LoadReport.h"

#include <osgSkin/Binding>
#include <osgSkinBind/BindReport>
#include <osgSkinBind/Progress>
#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/CharacterMotion>
#include <osgSkinCharacter/LoadOptions>

#include <string>
#include <vector>

namespace osgSkin {

/// Reads the source's motion files and retargets them to its rest skeleton. Makes clips and
/// reports, but no animations.
///
/// \param source gets notes about likely mistakes
/// \param readOptions with words of ReadLimits; may be null
/// \param stages get a stage for each file
/// \return one motion for each file, in order
/// \throw Error with the motion file and the reason
std::vector<CharacterMotion> retargetMotions(CharacterSource& source,
                                             const osgDB::Options* readOptions, LoadStages& stages);

/// Makes the motions' animations, after keeping hands out of the body where the options say so.
///
/// \param motions of retargetMotions()
/// \param binding of the source's body
void animateMotions(const CharacterSource& source, const Binding& binding,
                    std::vector<CharacterMotion>& motions);

/// Warns about skin between joints that hang side by side, of which a clip of the model moves one
/// as if it hung on the other: exporters of games put all bones on the root. The skin follows parts
/// of both moves about the joints at rest.
///
/// \param binding of the source's body
void warnFlatSkeleton(CharacterSource& source, const Binding& binding);

/// Sets the joints of rigid parts where no option does: heads, hands and feet whose fingers, toes
/// or other descendants no motion moves. Without motions automaticRigidJoints() decides. A note
/// names the rigid parts that could bend.
///
/// \param source its BindOptions::rigid is set where there are motions
/// \param motions retargeted to its skeleton
void setRigidParts(CharacterSource& source, const std::vector<CharacterMotion>& motions);

/// Binds the body to the rest skeleton, by regions or by painted weights as the source says.
///
/// \param source with body and rest skeleton
/// \param progress of the binding; may be empty
/// \param report filled in
/// \return the binding, vertex by vertex of the body's mesh
/// \throw Error with the file and the reason
Binding bindSource(CharacterSource& source, const Progress& progress, BindReport& report);

/// Warns about a body that is far larger or smaller than a person, where no option says its unit:
/// files in centimetres may state that they are in metres, as all glTF files do.
///
/// \param character with roles, placed in its scene
/// \param unitIsStated by its files, which allows for giants and toys
void checkSize(Character& character, bool unitIsStated);

/// Reads a scene by osgDB and re-skins its rigs in place.
///
/// \param file any name that osgDB reads, also a pseudo-loader's
/// \param options of the caller
/// \param stages are planned and told
/// \return a character, without a body where it has several, see Character::hasBody()
/// \throw Error with the file and the reason, also where nothing is rigged or the requested motion does not exist
Character convertScene(const std::string& file, const LoadOptions& options, LoadStages& stages);

} // namespace osgSkin

#endif
