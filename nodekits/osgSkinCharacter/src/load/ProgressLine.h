// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace osgSkin {

/// One line on standard error that says what long work is at and for how many seconds, rewritten
/// while the work goes on, also where that says nothing new for long. Nothing where standard error
/// is no terminal, and nothing within the first second.
class ProgressLine {
public:
    ProgressLine();
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// What the work is at now. Cheap; it is shown later, by a thread of the line's own.
    void set(const std::string& text);

private:
    void run();

    std::mutex _mutex;
    std::condition_variable _ended;
    std::string _text;
    bool _over = false;
    std::thread _thread; ///< none without a terminal
};

} // namespace osgSkin
