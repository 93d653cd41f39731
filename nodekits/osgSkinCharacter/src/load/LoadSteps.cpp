// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/LoadSteps.h"

namespace osgSkin {

LoadSteps::LoadSteps(std::string file, std::size_t total, const osgDB::Options* options)
    : _file(std::move(file)), _total(total), _progress(getLoadProgress(options)) {
    if (_progress == nullptr) _line.emplace();
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
        tell(_step + ": " + what + ", " + std::to_string(static_cast<int>(100.0 * share)) + " %");
}

void LoadSteps::finish() {
    _done = _total;
    tell("done");
}

void LoadSteps::tell(const std::string& what) {
    if (_progress != nullptr)
        _progress->step(_file, what, _done, _total);
    else
        _line->set(_file + ": " + what + " (" + std::to_string(_done) + " of " +
                   std::to_string(_total) + ")");
}

} // namespace osgSkin
