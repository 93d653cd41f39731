// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Error>

namespace fuzz {

/// Calls what may refuse its input; anything else that is thrown ends the run.
template <typename Call>
void attempt(const Call& call) {
    try {
        call();
    } catch (const osgSkin::Error&) {
    }
}

} // namespace fuzz
