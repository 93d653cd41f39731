// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/LoadReport.h"

#include <utility>

namespace osgSkin {

LoadStages::LoadStages(Progress progress) : _progress(std::move(progress)) {}

void LoadStages::plan(double total) {
    _total = total;
}

Progress LoadStages::begin(const std::string& what, double size) {
    _begun += _size;
    _size = size;
    if (_progress) _progress({what, _begun / _total});
    return subProgress(_progress, _begun / _total, (_begun + _size) / _total, what);
}

void LoadStages::finish() {
    if (_progress) _progress({"done", 1.0});
}

} // namespace osgSkin
