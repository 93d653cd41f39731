// SPDX-License-Identifier: MIT
// A folder of its own for what a test program writes: CTest runs tests side by side, and others may
// run at the same time.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <unistd.h>

namespace {

/// What testing::TempDir() gives from before any other object of the program is made until the
/// program ends; /tmp/ where there can be none.
class TempFolder {
public:
    TempFolder() {
        const char* const given = std::getenv("TMPDIR");
        _path = given != nullptr && *given != '\0' ? given : "/tmp";
        _path += "/osgskin-test-XXXXXX";
        if (mkdtemp(_path.data()) != nullptr)
            setenv("TEST_TMPDIR", _path.c_str(), 1);
        else
            _path.clear();
    }
    ~TempFolder() {
        std::error_code ignored;
        if (!_path.empty() && getpid() == _maker) std::filesystem::remove_all(_path, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

private:
    std::string _path;
    const pid_t _maker = getpid(); ///< not those that it forks
};

[[gnu::init_priority(101)]] const TempFolder kFolder;

} // namespace
