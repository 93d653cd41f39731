// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace example {

/// Returns the folder of thrower.skin: the one installed with the program (on Linux), or else that
/// of the sources. Both are compiled into the program, see osgskin_data() in
/// examples/CMakeLists.txt.
inline std::string dataFolder() {
    std::error_code missing;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", missing);
    if (missing) return OSGSKIN_DATA;
    const std::filesystem::path installed = program.parent_path() / OSGSKIN_INSTALLED_DATA;
    return std::filesystem::exists(installed, missing) ? installed.lexically_normal().string()
                                                       : OSGSKIN_DATA;
}

} // namespace example
