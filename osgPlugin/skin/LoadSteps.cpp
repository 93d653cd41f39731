// SPDX-License-Identifier: GPL-3.0-or-later
#include "LoadSteps.h"

#include <iostream>

#include <unistd.h>

namespace osgSkin {

LoadSteps::LoadSteps(std::string file, std::size_t total, const osgDB::Options* options)
    : _file(std::move(file)), _total(total), _progress(getLoadProgress(options)) {}

LoadSteps::~LoadSteps() {
    if (_shown) std::cerr << std::endl;
}

void LoadSteps::begin(const std::string& what) {
    if (_begun) ++_done;
    _begun = true;
    _step = what;
    tell(what);
}

void LoadSteps::within(const std::string& what, double share) {
    if (_progress != nullptr)
        _progress->within(_file, what, share);
    else
        show(_step + ": " + what + ", " + std::to_string(int(100.0 * share)) + " %");
}

void LoadSteps::finish() {
    _done = _total;
    tell("done");
}

void LoadSteps::tell(const std::string& what) {
    if (_progress != nullptr) {
        _progress->step(_file, what, _done, _total);
        return;
    }
    show(what);
}

void LoadSteps::show(const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    if (now < _next || isatty(STDERR_FILENO) != 1) return;
    _next = now + std::chrono::milliseconds(100);
    // The rest of a longer line before is wiped.
    std::cerr << "\r\033[K" << _file << ": " << what << " (" << _done << " of " << _total << ")"
              << std::flush;
    _shown = true;
}

} // namespace osgSkin
