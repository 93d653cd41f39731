// SPDX-License-Identifier: MIT
#include "Command.h"
#include "TextFile.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include <sys/wait.h>

namespace test {
namespace {} // namespace

std::string makeTestFolder() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test.test_suite_name()) + "." + test.name();
    for (char& c : name)
        if (c == '/') c = '_';
    const std::filesystem::path folder = std::filesystem::path(OSGSKIN_TEST_OUTPUT) / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder.string();
}

CommandResult runBake(const std::string& arguments, const std::string& folder) {
    return runCommand("'" OSGSKIN_BAKE "' " + arguments, folder);
}

CommandResult runCommand(const std::string& command, const std::string& folder) {
    const std::string whole =
        "cd '" + folder + "' && " + command + " >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(whole.c_str()); // NOLINT(cert-env33-c): our own arguments
    CommandResult result;
    if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
    result.out = test::fileText(folder + "/stdout.txt");
    result.err = test::fileText(folder + "/stderr.txt");
    return result;
}

} // namespace test
