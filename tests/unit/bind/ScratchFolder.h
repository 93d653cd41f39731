// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <vector>

/// A separate folder that its destructor removes.
class ScratchFolder {
public:
    ScratchFolder()
        : _path(std::filesystem::temp_directory_path() /
                ("osgskin-" + std::to_string(std::random_device{}()))) {
        std::filesystem::create_directories(_path);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return _path; }

    std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> result;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(_path))
            if (entry.is_regular_file()) result.push_back(entry.path());
        return result;
    }

private:
    std::filesystem::path _path;
};
