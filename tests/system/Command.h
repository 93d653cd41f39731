// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace test {

/// The result of a command.
struct CommandResult {
    int status = -1; ///< exit status; -1 if a signal ended it
    std::string out;
    std::string err;
};

/// Runs a shell command in `folder`.
CommandResult runCommand(const std::string& command, const std::string& folder);

/// Runs osgskinbake with `arguments` (split as by a shell) in `folder`.
CommandResult runBake(const std::string& arguments, const std::string& folder);

/// A new empty folder, named for the running test.
std::string makeTestFolder();

} // namespace test
