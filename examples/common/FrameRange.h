// SPDX-License-Identifier: MIT
#pragma once

#include "CommandLine.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <system_error>
#include <vector>

namespace example {

/// The value of `--frames`: frames first, first + step, ... up to and including last.
struct FrameRange {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t step = 1;

    std::size_t count() const { return (last - first) / step + 1; }

    /// Reads A, A:B or A:B:STEP.
    /// \throw UsageError for anything else, with a message for the user
    static FrameRange parse(const std::string& text) {
        std::vector<std::size_t> numbers;
        for (std::size_t at = 0; at <= text.size();) {
            const std::size_t end = std::min(text.find(':', at), text.size());
            const auto result =
                std::from_chars(text.data() + at, text.data() + end, numbers.emplace_back());
            if (at == end || result.ec != std::errc() || result.ptr != text.data() + end)
                throw UsageError(
                    "--frames: expected A, A:B or A:B:STEP in whole numbers, found \"" + text +
                    "\"");
            at = end + 1;
        }
        FrameRange range{numbers[0], numbers.size() > 1 ? numbers[1] : numbers[0],
                         numbers.size() > 2 ? numbers[2] : 1};
        if (numbers.size() > 3 || range.step == 0 || range.last < range.first)
            throw UsageError("--frames: expected A <= B and a step of 1 or more, found \"" + text +
                             "\"");
        return range;
    }
};

} // namespace example
