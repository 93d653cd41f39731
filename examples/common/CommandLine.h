// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <iostream>
#include <string>

namespace example {

/// A shell makes empty words of variables that are not set; options would do as if they were not
/// there.
///
/// \param program name for the message
/// \return whether there is none; else a line on standard error says where
inline bool hasNoEmptyWord(const std::string& program, int argc, const char* const* argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool isCut = word.rfind("--", 0) == 0 && word.size() > 2 && word.back() == '=';
        if (!word.empty() && !isCut) continue;
        std::cerr << program << ": " << (word.empty() ? (i > 1 ? argv[i - 1] : "first word") : word)
                  << ": expected a name or number behind it, found an empty word" << std::endl;
        return false;
    }
    return true;
}

/// What a program ends with: what it printed may stand on a full disk.
///
/// \param program name for the message
/// \param status that it would end with
/// \return 1 where standard output could not be written, which a line on standard error says
inline int finish(const std::string& program, int status) {
    std::cout.flush();
    if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
    std::cerr << program << ": standard output cannot be written" << std::endl;
    return status == 0 ? 1 : status;
}

} // namespace example
