// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinBind/Progress>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace example {

/// Shows the progress of long work on standard error until it is destroyed. On a terminal it
/// updates one line, starting after a second, even while no new progress is reported. Otherwise it
/// prints a line every five seconds.
class ProgressLine {
public:
    /// \param title of the work, at the start of the line
    /// \param quiet true to show nothing
    explicit ProgressLine(std::string title, bool quiet = false);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Sets the current progress. Cheap: on a terminal, a separate thread prints it later.
    void show(const osgSkin::ProgressStep& step);

    /// A callback that calls show(). It must not outlive this object.
    osgSkin::Progress progress();

private:
    using Clock = std::chrono::steady_clock;
    void run();

    const std::string _title;
    const bool _quiet;
    const Clock::time_point _start = Clock::now();
    Clock::time_point _next; ///< time of the next line if there is no terminal
    std::mutex _mutex;
    std::condition_variable _ended;
    std::string _text;
    bool _over = false;
    std::thread _thread; ///< runs only on a terminal
};

} // namespace example
