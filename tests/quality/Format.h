// SPDX-License-Identifier: MIT
#pragma once

#include "Methods.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>

namespace quality {

/// A short piece of text as printf makes it.
template <typename... Values>
std::string format(const char* pattern, Values... values) {
    char line[200];
    std::snprintf(line, sizeof line, pattern, values...);
    return line;
}

/// {"LBS": ..., "DQS": ..., "ours": ...} of what `figure` says for each method.
template <typename Figure>
nlohmann::ordered_json perMethod(const Figure& figure) {
    nlohmann::ordered_json json;
    for (const Method method : kMethods) json[nameOf(method)] = figure(method);
    return json;
}

/// A limit that a figure has to keep.
struct Bar {
    std::string name;
    double value;
    bool atMost; ///< else at least
    double limit;
    bool passed() const { return atMost ? value <= limit : value >= limit; }
};

inline std::string lineOf(const Bar& bar) {
    return format("  %-28s%10.4f  %s%-8.4g%s\n", bar.name.c_str(), bar.value,
                  bar.atMost ? "<= " : ">= ", bar.limit, bar.passed() ? "PASS" : "FAIL");
}

inline nlohmann::ordered_json toJson(const Bar& bar) {
    return {{"name", bar.name},
            {"value", bar.value},
            {bar.atMost ? "atMost" : "atLeast", bar.limit},
            {"passed", bar.passed()}};
}

} // namespace quality
