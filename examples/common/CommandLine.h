// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <iostream>
#include <string>

namespace example {

/// What is wrong with a command line's words: a shell makes empty ones of variables that are not
/// set, and options would do as if they were not there.
///
/// \return empty where there is none, else a line
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

/// The same for a program that ends with status 2 then.
///
/// \param program name for the message
/// \return whether there is no empty word; else a line on standard error says where
inline bool hasNoEmptyWord(const std::string& program, int argc, const char* const* argv) {
    const std::string wrong = findEmptyWord(argc, argv);
    if (!wrong.empty()) std::cerr << program << ": " << wrong << std::endl;
    return wrong.empty();
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
