// SPDX-License-Identifier: MIT
#ifndef BENCH_LOADEDFILE_H
#define BENCH_LOADEDFILE_H

#include <osg/Node>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>

#include <malloc.h>

namespace bench {

inline osg::ref_ptr<osg::Node> load(const std::string& file, const std::string& words = "") {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(words);
    options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, options);
    if (!node)
        throw std::runtime_error("cannot read " + file +
                                 "; OSG_LIBRARY_PATH must name the plug-ins' folder");
    return node;
}

/// A scene as .osgb, removed at the end.
class SavedFile {
public:
    /// \param words options of OSG's writer
    explicit SavedFile(const osg::Node& scene, const std::string& words = "")
        : path((std::filesystem::temp_directory_path() /
                ("osgskin-bench-" + std::to_string(std::random_device()()) + ".osgb"))
                   .string()) {
        osgDB::writeNodeFile(scene, path, new osgDB::Options(words));
    }
    ~SavedFile() { std::filesystem::remove(path); }
    SavedFile(const SavedFile&) = delete;
    SavedFile& operator=(const SavedFile&) = delete;

    const std::string path;
};

/// Bytes of the heap that are in use.
inline double allocated() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

} // namespace bench

#endif
