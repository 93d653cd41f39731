// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Export>

#include <cstdint>

namespace osgSkin {

/// The instruction sets of Highway, as its bits, that this processor has and kernels may use.
OSGSKIN_EXPORT std::int64_t simdTargets();

/// Lets kernels use some of them alone: for tests and benchmarks, while no thread deforms.
///
/// \param targets some of simdTargets(); 0: all again
OSGSKIN_EXPORT void setSimdTargets(std::int64_t targets);

} // namespace osgSkin
