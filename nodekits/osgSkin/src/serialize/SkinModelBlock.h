// SPDX-License-Identifier: MIT
//
// A model in files. Exported for the serializers; applications use osgDB.
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/Export>
#include <osgSkin/SkinModel>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The binding that a model was made from, for the model's own vertices.
///
/// Ratios are exact. A vertex's region is the last joint that it follows by half or more, since
/// models have no regions. Correctives that are 0, and gradients that SkinModel::create() drops,
/// are left out.
OSGSKIN_EXPORT Binding bindingOf(const SkinModel& model);

/// The latest version. packSkinModel() writes it for a model with gradients, 2 for one with
/// correctives alone, and 1 for any other.
constexpr std::uint32_t kSkinModelBlockVersion = 3;

/// A model as 32-bit words, without loss: the same in each file format.
///
/// Version; number of joints, and of each: parent, bytes of the name, the name (four bytes a word,
/// the first lowest), centre, bone axis, twist axis (doubles, low word first); number of vertices,
/// all positions, all normals (floats); of each vertex: number of influences, and of each: joint,
/// bend, twist.
///
/// Version 2 goes on with the correctives: 1 where they have normals, else 0; number of their
/// joints, and of each: joint, basis, axis, low x and y, high x and y; number of knots, the knots;
/// modes; number of coefficients, the coefficients; number of normals' scales, those (all doubles);
/// of each vertex: number of entries, and of each: which of the correctives' joints, its shares
/// (two a word, the first lower; of an odd number the last alone), the same of normals.
///
/// Version 3 goes on after the influences with the gradients of those that are partial: bend x, y
/// and z, twist x, y and z (floats). Then 1 where the correctives follow, else 0.
OSGSKIN_EXPORT std::vector<std::uint32_t> packSkinModel(const SkinModel& model);

/// The model in `words`, which need not be trusted.
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

} // namespace osgSkin
