// SPDX-License-Identifier: MIT
#pragma once

#include "words/WordReader.h"
#include "words/WordWriter.h"

#include <osgSkin/Correctives>

namespace osgSkin {

/// Correctives in a skin model's block, see packSkinModel().
void putCorrectives(const Correctives& correctives, WordWriter& out);

/// \throw osgSkin::Error where there are too few words; the numbers are checked by
///        Correctives::validate()
Correctives takeCorrectives(WordReader& in, std::uint32_t vertexCount);

} // namespace osgSkin
