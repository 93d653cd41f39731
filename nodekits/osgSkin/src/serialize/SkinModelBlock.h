// SPDX-License-Identifier: MIT
//
// A model in files. Exported for the serializers; applications use osgDB.
#pragma once

#include <osgSkin/Export>
#include <osgSkin/SkinModel>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// A model as 32-bit words, without loss: the same in each file format.
///
/// Number of joints, and of each: parent, bytes of the name, the name (four bytes a word,
/// the first lowest), centre, bone axis, twist axis (doubles, low word first); number of vertices,
/// all positions, all normals (floats), order(); number of groups, and of each: number of vertices,
/// number of links, of each link its joint, with the highest bit where it is partial; number of
/// ratios, and of each: bend, twist. Then 1 where gradients follow, plus 2 where correctives do.
///
/// Gradients: as GradientBlocks, `unit` (double), `across`, `reach`, `rows` (two numbers a word,
/// the first lower).
///
/// Correctives: 1 where they have normals, plus 2 where they have inputs; of these the number and
/// the names; number of joints, and of each: joint, basis, axis, low x and y, high x and y; number
/// of knots, the knots; modes; number of coefficients, the coefficients; number of normals' scales,
/// those (all doubles); of each group the number of ranges, and of each: joint, first block, number
/// of blocks; `rows`, then `normalRows`.
OSGSKIN_EXPORT std::vector<std::uint32_t> packSkinModel(const SkinModel& model);

/// The model in `words`, which need not be trusted. As long as a model lives, the same words are
/// that model: loads of one file share it. Thread safe.
///
/// \return never null
/// \throw osgSkin::Error that names the first error
OSGSKIN_EXPORT osg::ref_ptr<const SkinModel>
unpackSkinModel(const std::vector<std::uint32_t>& words);

/// The same for readers that create the object first, as osgDB's do.
///
/// \param words as above
/// \param empty a new model; unchanged where this throws
/// \throw osgSkin::Error as above, and where the model is not empty
OSGSKIN_EXPORT void unpackSkinModel(const std::vector<std::uint32_t>& words, SkinModel& empty);

/// The model that osgDB should use in place of one that it has read: the one that unpackSkinModel()
/// has filled it from, unless it has a name or user data of its own.
///
/// \param read may be null
OSGSKIN_EXPORT osg::ref_ptr<const SkinModel>
unpackedModel(const osg::ref_ptr<const SkinModel>& read);

} // namespace osgSkin
