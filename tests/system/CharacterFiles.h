// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

namespace test {

/// A character and one of its motions, for tests over several cases.
struct CharacterCase {
    const char* name;
    const char* mesh; ///< below OSGSKIN_SHARED_DATA; null: the project's own thrower
    const char* skeleton;
    const char* motion;
    const char* frames; ///< for osgskinbake's --frames
    std::size_t skipFrames;
    const char* shapes = "none"; ///< for osgskinbake's --shapes
    const char* muscles = "off"; ///< for its --muscles, and further options
};

/// Both third-party bodies under both clips, and the project's own thrower.
const std::vector<CharacterCase>& characterCases();

/// True if the case's files exist; otherwise skip the test with `why`.
bool isAvailable(const CharacterCase& c, std::string& why);

/// Path of a .skin file for the case; writes one to `folder` for third-party files.
std::string skinFile(const CharacterCase& c, const std::string& folder);

/// Prints a case by its name.
std::ostream& operator<<(std::ostream& out, const CharacterCase& c);

} // namespace test
