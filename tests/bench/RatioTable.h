// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace bench {

/// Prints what Google Benchmark prints, then a table of medians: microseconds of processor time an
/// update, nanoseconds a vertex, and ratios to memcpy and to osgAnimation's rig in the same run.
///
/// Benchmarks are named WHAT/SIZE and report their number of vertices as the counter "vertices".
class RatioTable : public benchmark::ConsoleReporter {
public:
    RatioTable() : benchmark::ConsoleReporter(OO_Tabular) {}

    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    struct Row {
        std::string what, size;
        double vertices = 0.0;
        std::vector<double> seconds; ///< of each repetition
        double reportedMedian = 0.0; ///< where only aggregates are reported
        double median() const;
    };
    const Row* find(const std::string& what, const std::string& size) const;

    std::vector<Row> _rows;
};

} // namespace bench
