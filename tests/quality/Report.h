// SPDX-License-Identifier: MIT
#ifndef QUALITY_REPORT_H
#define QUALITY_REPORT_H

#include "PoseFigures.h"
#include "SkinFigures.h"
#include "Subject.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace quality {

/// Formats a short text like printf.
template <typename... Values>
std::string format(const char* pattern, Values... values) {
    char line[200];
    std::snprintf(line, sizeof line, pattern, values...);
    return line;
}

/// {"LBS": ..., "DQS": ..., "ours": ...} with the value of `figure` for each method.
template <typename Figure>
nlohmann::ordered_json perMethod(const Figure& figure) {
    nlohmann::ordered_json json;
    for (const Method method : kMethods) json[nameOf(method)] = figure(method);
    return json;
}

/// A limit on a figure.
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

/// Every figure of one body.
struct Report {
    std::string body;
    std::size_t vertices = 0, poses = 0;
    PerMethod<PoseFigures> motion;
    std::vector<LimbRigidity> rigidity;
    std::vector<WristTwist> wrist;
    std::optional<Continuity> continuity; ///< the slowest figure; optional
    BindFigures binding;
    CappingCost capping;
};

/// The limits for every body with default settings.
std::vector<Bar> bars(const Report& report);

/// Prints a body's figures as tables.
void printTable(const Report& report, std::ostream& out);

/// A body's figures as JSON.
nlohmann::ordered_json toJson(const Report& report);

} // namespace quality

#endif
