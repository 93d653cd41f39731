// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/Error>

#include <string>

namespace osgSkin {

/// Runs a step whose errors know a mesh's vertices and a skeleton's joints but not the file that
/// they came from: it is put before them.
///
/// \param file that errors are to name
/// \param step called once
/// \return what `step` returns
/// \throw Error that begins with `file`
template <typename Step>
auto namingFile(const std::string& file, const Step& step) {
    try {
        return step();
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.rfind(file, 0) == 0) throw;
        throw Error(file + ": " + what);
    }
}

} // namespace osgSkin
