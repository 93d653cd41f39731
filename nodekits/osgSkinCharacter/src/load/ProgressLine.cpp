// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/ProgressLine.h"

#include <chrono>
#include <iostream>

#include <unistd.h>

namespace osgSkin {

ProgressLine::ProgressLine() {
    if (isatty(STDERR_FILENO) == 1) _thread = std::thread([this] { run(); });
}

ProgressLine::~ProgressLine() {
    if (!_thread.joinable()) return;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _over = true;
    }
    _ended.notify_one();
    _thread.join();
}

void ProgressLine::set(const std::string& text) {
    if (!_thread.joinable()) return;
    const std::lock_guard<std::mutex> lock(_mutex);
    _text = text;
}

void ProgressLine::run() {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    std::string shown;
    std::unique_lock<std::mutex> lock(_mutex);
    auto pause = std::chrono::milliseconds(1000);
    while (!_ended.wait_for(lock, pause, [this] { return _over; })) {
        pause = std::chrono::milliseconds(100);
        const auto passed = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start);
        const std::string line = _text + ", " + std::to_string(passed.count()) + " s";
        if (line == shown) continue;
        shown = line;
        // The rest of a longer line before is wiped.
        std::cerr << "\r\033[K" << line << std::flush;
    }
    if (!shown.empty()) std::cerr << "\r\033[K" << _text << std::endl;
}

} // namespace osgSkin
