// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/SkinModel>

#include <cstdint>
#include <vector>

namespace test {

/// A model's block as earlier versions wrote it: a binding. Version 3 where the model has
/// gradients, 2 where it has correctives alone, else 1.
///
/// Version; number of joints, and of each: parent, bytes of the name, the name, centre, bone axis,
/// twist axis (doubles); number of vertices, all positions, all normals; of each vertex: number of
/// influences, and of each: joint, bend, twist.
///
/// Version 2 goes on with the correctives: 1 where they have normals, plus 2 where they have
/// inputs, then these; number of joints, and these as today; of each vertex: number of entries, and
/// of each: which of the correctives' joints, its shares, the same of normals.
///
/// Version 3 goes on after the influences with the gradients of those that are partial: bend x, y
/// and z, twist x, y and z (floats). Then 1 where the correctives follow, else 0.
std::vector<std::uint32_t> packOlderModel(const osgSkin::SkinModel& model);

} // namespace test
