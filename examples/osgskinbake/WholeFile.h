// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace bake {

/// A file that is there whole or not at all: written beside its name, and renamed once finished.
/// What is no regular file, as a pipe, is written directly.
class WholeFile {
public:
    /// \throw osgSkin::Error where it cannot be written
    explicit WholeFile(const std::string& file);
    /// Removes what has not been finished.
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::FILE* stream() { return _stream; }

    /// \throw osgSkin::Error where it cannot be written
    void write(const std::string& data);

    /// Gives the file its name.
    /// \throw osgSkin::Error where not all has been written
    void finish();

private:
    [[noreturn]] void fail() const;

    std::string _file;    ///< as it was asked for
    std::string _target;  ///< where links lead to
    std::string _written; ///< where it is until it is finished; empty: there already
    std::FILE* _stream = nullptr;
};

/// Files that are never written over, however they are called: those that a character was read
/// from.
void keepFiles(const std::vector<std::string>& files);

/// Lets a signal that ends the program remove what has not been finished.
void removeUnfinishedOnSignals();

} // namespace bake
