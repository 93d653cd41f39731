// SPDX-License-Identifier: MIT
#include "ProgressLine.h"

#include <osgSkin/Error>

#include <cstdio>
#include <iostream>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace example {
namespace {

bool isTerminal() {
#ifdef _WIN32
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(STDERR_FILENO) == 1;
#endif
}

constexpr std::chrono::seconds kSilence(1); ///< shorter work prints nothing
constexpr std::chrono::seconds kBetweenLines(5);

} // namespace

ProgressLine::ProgressLine(std::string title, bool quiet)
    : _title(std::move(title)), _quiet(quiet), _next(_start + kBetweenLines) {
    if (!_quiet && isTerminal()) _thread = std::thread([this] { run(); });
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

void ProgressLine::show(const osgSkin::ProgressStep& step) {
    if (_quiet) return;
    const std::string text = osgSkin::onOneLine(_title + ": " + step.what) + ", " +
                             std::to_string(static_cast<int>(100.0 * step.fraction + 1e-9)) + " %";
    if (_thread.joinable()) {
        const std::lock_guard<std::mutex> lock(_mutex);
        _text = text;
    } else if (Clock::now() >= _next) {
        std::cerr << text << std::endl;
        _next = Clock::now() + kBetweenLines;
    }
}

osgSkin::Progress ProgressLine::progress() {
    return [this](const osgSkin::ProgressStep& step) { show(step); };
}

void ProgressLine::run() {
    std::string shown;
    std::unique_lock<std::mutex> lock(_mutex);
    std::chrono::milliseconds pause = kSilence;
    while (!_ended.wait_for(lock, pause, [this] { return _over; })) {
        pause = std::chrono::milliseconds(100);
        if (_text.empty()) continue;
        const auto passed = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - _start);
        const std::string line = _text + ", " + std::to_string(passed.count()) + " s";
        if (line == shown) continue;
        shown = line;
        // Clears the line first: the previous text may be longer.
        std::cerr << "\r\033[K" << line << std::flush;
    }
    if (!shown.empty()) std::cerr << "\r\033[K" << _text << std::endl;
}

} // namespace example
