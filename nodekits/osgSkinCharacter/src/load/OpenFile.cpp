// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/OpenFile.h"

#include <osgSkin/Error>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

namespace osgSkin {
namespace {

constexpr std::size_t kDeepestFile = 8;

/// Of this thread, in the order in which they name each other.
std::vector<std::string>& openFiles() {
    static thread_local std::vector<std::string> files;
    return files;
}

/// One name for a file, however it is written.
std::string onlyName(const std::string& file) {
    std::error_code failure;
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, failure);
    return failure ? file : path.string();
}

} // namespace

OpenFile::OpenFile(const std::string& file) {
    std::vector<std::string>& files = openFiles();
    const std::string name = onlyName(file);
    if (std::find(files.begin(), files.end(), name) != files.end())
        throw Error(file + ": is a part of itself" +
                    (files.size() > 1 ? ", by way of " + files.back() : "") +
                    ", expected another file");
    if (files.size() >= kDeepestFile)
        throw Error(file + ": characters are parts of each other, expected no more than " +
                    std::to_string(kDeepestFile));
    files.push_back(name);
}

OpenFile::~OpenFile() {
    openFiles().pop_back();
}

} // namespace osgSkin
