// SPDX-License-Identifier: MIT
#include "RatioTable.h"

#include <algorithm>
#include <cstdio>

namespace bench {

namespace {

/// The deformation that a frame is compared with: the same skins'.
std::string aloneOf(const std::string& frame) {
    return frame.find("shapes") == std::string::npos ? "frame, alone" : "frame, fast shapes, alone";
}

} // namespace

double RatioTable::Row::median() const {
    if (seconds.empty()) return reportedMedian;
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

const RatioTable::Row* RatioTable::find(const std::string& what, const std::string& size) const {
    for (const Row& row : _rows)
        if (row.what == what && row.size == size) return &row;
    return nullptr;
}

void RatioTable::ReportRuns(const std::vector<Run>& runs) {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
        const bool isMedian = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
        if ((run.run_type != Run::RT_Iteration && !isMedian) || run.error_occurred) continue;
        const std::string& name = run.run_name.function_name;
        const std::size_t slash = name.rfind('/');
        if (slash == std::string::npos) continue;
        const std::string what = name.substr(0, slash), size = name.substr(slash + 1);
        auto row = std::find_if(_rows.begin(), _rows.end(),
                                [&](const Row& r) { return r.what == what && r.size == size; });
        if (row == _rows.end()) row = _rows.insert(row, Row{what, size, 0.0, {}, 0.0});
        const auto vertices = run.counters.find("vertices");
        if (vertices != run.counters.end()) row->vertices = vertices->second;
        // Processor time, which other programs on the machine disturb less; a benchmark that keeps
        // its own time measures the same.
        const bool manual = !run.run_name.time_type.empty();
        const double seconds = (manual ? run.real_accumulated_time : run.cpu_accumulated_time) /
                               static_cast<double>(run.iterations);
        if (isMedian)
            row->reportedMedian = seconds;
        else
            row->seconds.push_back(seconds);
    }
}

void RatioTable::Finalize() {
    ConsoleReporter::Finalize();
    std::printf("\nMedians, positions and normals, pose set-up included\n"
                "%-42s %8s %12s %10s %12s %18s\n",
                "", "vertices", "us/update", "ns/vertex", "x memcpy", "x osgAnimation");
    for (const Row& row : _rows) {
        const double seconds = row.median();
        std::printf("%-42s ", (row.what + "/" + row.size).c_str());
        if (row.vertices == 0.0) {
            std::printf("%8s %12.2f\n", "", 1e6 * seconds);
            continue;
        }
        std::printf("%8.0f %12.2f %10.2f", row.vertices, 1e6 * seconds,
                    1e9 * seconds / row.vertices);
        const bool isFrame = row.what.rfind("frame, ", 0) == 0;
        const Row* copy = find(isFrame ? aloneOf(row.what) : "memcpy", row.size);
        if (copy) std::printf(" %10.2f x%s", seconds / copy->median(), isFrame ? " alone" : "");
        if (const Row* rig = find(isFrame ? "frame, osgAnimation" : "osgAnimation", row.size))
            std::printf(" %11.1f x faster", rig->median() / seconds);
        std::printf("\n");
    }
}

} // namespace bench
