// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace fuzz {

/// A folder of this process alone, in memory if possible; removed at exit.
inline const std::string& folder() {
    static const std::string path = [] {
        const char* base = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
        std::string made = std::string(base) + "/osgskin-fuzz-" + std::to_string(::getpid());
        std::filesystem::create_directories(made);
        return made;
    }();
    static const int atExit = std::atexit([] { std::filesystem::remove_all(fuzz::folder()); });
    (void)atExit;
    return path;
}

/// Writes an input to a file of this name; returns its path.
inline std::string save(const std::string& name, const std::uint8_t* data, std::size_t size) {
    std::string path = folder() + "/" + name;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    return path;
}

} // namespace fuzz
