// SPDX-License-Identifier: MIT
// A separate folder for the files of a test program: CTest runs tests in parallel, and other
// programs may run at the same time.
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <system_error>

#include <unistd.h>

namespace {

/// Sets testing::TempDir() from before the program's other objects are constructed until the
/// program ends; the system's folder if none can be made.
class TempFolder {
public:
    TempFolder() {
        std::error_code failure;
        const std::filesystem::path all = std::filesystem::temp_directory_path(failure);
        std::random_device random;
        std::filesystem::path path = all / ("osgskin-test-" + std::to_string(random()));
        if (failure || !std::filesystem::create_directory(path, failure)) return;
        _path = std::move(path);
#ifdef _WIN32
        _putenv_s("TEST_TMPDIR", _path.string().c_str());
#else
        setenv("TEST_TMPDIR", _path.c_str(), 1);
#endif
    }
    ~TempFolder() {
        std::error_code ignored;
        if (!_path.empty() && getpid() == _maker) std::filesystem::remove_all(_path, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

private:
    std::filesystem::path _path;
    const pid_t _maker = getpid(); ///< not its forked children
};

[[gnu::init_priority(101)]] const TempFolder kFolder;

} // namespace
