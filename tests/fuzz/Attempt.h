// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Error>

namespace fuzz {

/// Makes a call that may refuse its input; any other exception ends the run.
template <typename Call>
void attempt(const Call& call) {
    try {
        call();
    } catch (const osgSkin::Error&) {
    }
}

} // namespace fuzz
