// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mannequin {

/// Makes a person of the pedestrian: of another sex, age, height, weight, skin and hair, in other
/// clothes, with the same skeleton scaled to the body. Reads pedestrian.obj of the folder, and
/// writes people/person_NN.obj, .mtl, .bvh and .skin; motions are the pedestrian's.
///
/// \param folder of pedestrian.obj
/// \param seed the same seed makes the same person
/// \throw std::runtime_error where a file cannot be read or written
void writePerson(const std::string& folder, unsigned int seed);

} // namespace mannequin
