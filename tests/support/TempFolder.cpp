// SPDX-License-Identifier: MIT
// A separate folder for the files of a test program: CTest runs tests in parallel, and other
// programs may run at the same time.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <unistd.h>

namespace {

/// Sets testing::TempDir() from before the program's other objects are constructed until the
/// program ends; /tmp/ if the folder cannot be made.
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
    const pid_t _maker = getpid(); ///< not its forked children
};

[[gnu::init_priority(101)]] const TempFolder kFolder;

} // namespace
