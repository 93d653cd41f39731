// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace bake {

/// Says on standard error how far long work has come: a line that is rewritten on a terminal, a
/// line every few seconds elsewhere; nothing where the work is over within a second.
class Progress {
public:
    Progress(std::string what, std::size_t total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void step();

private:
    using Clock = std::chrono::steady_clock;
    std::string _what;
    std::size_t _total;
    std::size_t _done = 0;
    bool _quiet;
    bool _terminal;
    bool _shown = false;
    Clock::time_point _next;
};

} // namespace bake
