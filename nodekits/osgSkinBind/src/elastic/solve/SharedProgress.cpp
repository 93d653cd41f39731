// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/SharedProgress.h"

namespace osgSkin::elastic {

void SharedProgress::done(const std::string& what) {
    const std::lock_guard<std::mutex> lock(_mutex);
    check();
    ++_done;
    if (!_tell) return;
    try {
        _tell(what, static_cast<double>(_done) / static_cast<double>(_whole));
    } catch (...) {
        _thrown = std::current_exception();
        _givenUp = true;
        throw;
    }
}

} // namespace osgSkin::elastic
