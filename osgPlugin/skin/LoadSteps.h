// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinImport/LoadProgress>

#include <osgDB/Options>

#include <chrono>
#include <cstddef>
#include <string>

namespace osgSkin {

/// Tells how far a load has come: the LoadProgress of the options, or else, once a second has
/// passed, the terminal on standard error.
class LoadSteps {
public:
    LoadSteps(std::string file, std::size_t total, const osgDB::Options* options);
    ~LoadSteps();
    LoadSteps(const LoadSteps&) = delete;
    LoadSteps& operator=(const LoadSteps&) = delete;

    /// The next step begins.
    void begin(const std::string& what);
    /// All is done.
    void finish();

private:
    void tell(const std::string& what);

    std::string _file;
    std::size_t _total;
    std::size_t _done = 0;
    bool _begun = false;
    bool _shown = false;
    LoadProgress* _progress; ///< the options own it
    std::chrono::steady_clock::time_point _start = std::chrono::steady_clock::now();
};

} // namespace osgSkin
