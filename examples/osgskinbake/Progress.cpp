// SPDX-License-Identifier: GPL-3.0-or-later
#include "Progress.h"

#include <iostream>

#include <unistd.h>

namespace bake {

Progress::Progress(std::string what, std::size_t total, bool quiet)
    : _what(std::move(what)), _total(total), _quiet(quiet), _terminal(isatty(STDERR_FILENO) == 1),
      _next(Clock::now() + std::chrono::seconds(1)) {}

Progress::~Progress() {
    if (_shown && _terminal) std::cerr << std::endl;
}

void Progress::step() {
    ++_done;
    const Clock::time_point now = Clock::now();
    if (_quiet || now < _next) return;
    std::cerr << (_terminal ? "\r" : "") << _what << ' ' << _done << " of " << _total
              << (_terminal ? "" : "\n") << std::flush;
    _shown = true;
    _next = now + (_terminal ? std::chrono::milliseconds(100) : std::chrono::seconds(5));
}

} // namespace bake
