// SPDX-License-Identifier: MIT
#pragma once

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace test {

/// While it lives, the leak sanitizer ignores leaks: for calls to third-party readers.
class LeaksOfOthers {
public:
    /// \param others whether leaks are to be ignored
    explicit LeaksOfOthers(bool others = true) : _others(others) { set(true); }
    ~LeaksOfOthers() { set(false); }
    LeaksOfOthers(const LeaksOfOthers&) = delete;
    LeaksOfOthers& operator=(const LeaksOfOthers&) = delete;

private:
    void set([[maybe_unused]] bool ignored) const {
#ifdef __SANITIZE_ADDRESS__
        if (_others) ignored ? __lsan_disable() : __lsan_enable();
#endif
    }

    [[maybe_unused]] const bool _others;
};

} // namespace test
