// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Version>

#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

namespace example {

/// Bad usage: a program prints the message and exits with 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The line that `--version` prints, in the form that help2man expects.
inline std::string versionText(const std::string& program) {
    return program + " (osgSkin) " + osgSkin::libraryVersion();
}

/// Finds empty arguments, for example from unset shell variables. Without this check, options would
/// ignore them.
///
/// \return an error message, or an empty string
inline std::string findEmptyWord(int argc, const char* const* argv) {
    bool hasOptions = true; // until "--"
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.empty())
            return std::string(i > 1 ? argv[i - 1] : "the first word") +
                   ": expected a name or number behind it, found an empty word";
        if (hasOptions && word.rfind("--", 0) == 0 && word.find('=') == word.size() - 1)
            return word + ": expected a name or number behind it, found none";
        if (word == "--") hasOptions = false;
    }
    return {};
}

/// Prints the message of findEmptyWord() on standard error; the program should exit with 2.
///
/// \return true if there is no empty argument
inline bool hasNoEmptyWord(const std::string& program, int argc, const char* const* argv) {
    const std::string wrong = findEmptyWord(argc, argv);
    if (!wrong.empty()) std::cerr << program << ": " << wrong << std::endl;
    return wrong.empty();
}

/// Returns a program's exit status after flushing standard output. Prints a message on standard
/// error if that fails, for example because the disk is full.
///
/// \param program name of the program, for the message
/// \param status exit status of the program so far
/// \return `status`; 1 if it was 0 and standard output could not be written
inline int finish(const std::string& program, int status) {
    std::cout.flush();
    if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
    std::cerr << program << ": standard output cannot be written" << std::endl;
    return status == 0 ? 1 : status;
}

} // namespace example
