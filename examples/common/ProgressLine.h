// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinBind/Progress>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace example {

/// Says on standard error how far long work has come, while it lives: on a terminal one line that
/// is rewritten while the work goes on, also where that says nothing new for long, and nothing
/// within the first second; elsewhere a line every five seconds.
class ProgressLine {
public:
    /// \param title of the work; stands first on the line
    /// \param quiet nothing is shown
    explicit ProgressLine(std::string title, bool quiet = false);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// What the work is at now. Cheap: on a terminal a thread of the line's own shows it later.
    void show(const osgSkin::ProgressStep& step);

    /// Calls show(). The line must outlive it.
    osgSkin::Progress progress();

private:
    using Clock = std::chrono::steady_clock;
    void run();

    const std::string _title;
    const bool _quiet;
    const Clock::time_point _start = Clock::now();
    Clock::time_point _next; ///< elsewhere than on a terminal: when the next line is due
    std::mutex _mutex;
    std::condition_variable _ended;
    std::string _text;
    bool _over = false;
    std::thread _thread; ///< on a terminal
};

} // namespace example
