// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "load/ProgressLine.h"

#include <osgSkinImport/LoadProgress>

#include <osgDB/Options>

#include <cstddef>
#include <optional>
#include <string>

namespace osgSkin {

/// Tells how far a load has come: the LoadProgress of the options, or else, once a second has
/// passed, the terminal on standard error.
class LoadSteps {
public:
    LoadSteps(std::string file, std::size_t total, const osgDB::Options* options);

    /// The next step begins.
    void begin(const std::string& what);
    /// Within the step: what of it begins, and how much of it is done, 0 to 1.
    void within(const std::string& what, double share);
    /// All is done.
    void finish();

private:
    void tell(const std::string& what);

    std::string _file;
    std::string _step;
    std::size_t _total;
    std::size_t _done = 0;
    bool _begun = false;
    LoadProgress* _progress;           ///< the options own it
    std::optional<ProgressLine> _line; ///< without a LoadProgress
};

} // namespace osgSkin
