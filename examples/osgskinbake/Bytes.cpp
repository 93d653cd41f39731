// SPDX-License-Identifier: MIT
#include "Bytes.h"

#include <osgSkin/Error>

#include <osg/Notify>
#include <osgDB/FileUtils>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <system_error>

namespace bake {

namespace {

namespace fs = std::filesystem;

// Path of the temporary file, for the signal handler, which must not allocate. Only one file is
// written at a time.
constexpr std::size_t kLongestPath = 4096;
char unfinished[kLongestPath];
volatile std::sig_atomic_t hasUnfinished = 0;

void setUnfinished(const std::string& path) {
    hasUnfinished = 0;
    if (path.empty() || path.size() >= kLongestPath) return;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    std::memcpy(unfinished, path.c_str(), path.size() + 1);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    hasUnfinished = 1;
}

std::vector<std::string> keptFiles;

bool isKept(const std::string& file) {
    return std::any_of(keptFiles.begin(), keptFiles.end(), [&](const std::string& kept) {
        std::error_code missing;
        return fs::equivalent(kept, file, missing);
    });
}

/// Creates a new file and removes an existing one: in a folder shared with other users, that could
/// be a link to another file.
std::FILE* openNew(const std::string& file) {
    std::remove(file.c_str());
    return std::fopen(file.c_str(), "wbx"); // x: a new file only
}

/// Name of the temporary file, limited to the maximum length of file names.
std::string besides(const std::string& file) {
    constexpr std::size_t kMax = 230; // out of 255 bytes
    const fs::path path(file);
    const std::string name = path.filename().string().substr(0, kMax);
    static const unsigned int own = std::random_device()(); // other processes have other names
    return (path.parent_path() / (name + ".part" + std::to_string(own))).string();
}

extern "C" void removeAndGo(int signal) {
    if (hasUnfinished != 0) std::remove(unfinished);
    std::signal(signal, SIG_DFL);
    std::raise(signal); // so that the shell sees the signal
}

} // namespace

void keepFiles(const std::vector<std::string>& files) {
    keptFiles = files;
}

void removeUnfinishedOnSignals() {
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN); // a file size limit then appears as a write error
#endif
#ifdef SIGHUP
    constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
#else
    constexpr int signals[] = {SIGINT, SIGTERM}; // Windows
#endif
    for (const int signal : signals) {
        const auto before = std::signal(signal, removeAndGo);
        if (before == SIG_IGN) std::signal(signal, SIG_IGN); // for example under nohup
    }
}

WholeFile::WholeFile(const std::string& file) : _file(file), _target(file) {
    std::error_code failure;
    if (fs::exists(file, failure)) _target = fs::canonical(file, failure).string();
    if (failure) _target = file;
    if (!fs::exists(_target, failure) || fs::is_regular_file(_target, failure))
        _written = besides(_target);
    if (isKept(_target))
        throw osgSkin::Error(_file + ": a part of the character, expected another file");
    // A read-only file must not be replaced either.
    if (fs::is_regular_file(_target, failure) && !std::ofstream(_target, std::ios::in)) fail();
    setUnfinished(_written); // before opening, when a signal may already arrive
    _stream = _written.empty() ? std::fopen(_target.c_str(), "wb") : openNew(_written);
    if (_stream != nullptr) return;
    setUnfinished({});
    fail();
}

WholeFile::~WholeFile() {
    if (_stream == nullptr) return;
    std::fclose(_stream);
    if (!_written.empty()) std::remove(_written.c_str());
    setUnfinished({});
}

void WholeFile::write(const std::string& data) {
    if (std::fwrite(data.data(), 1, data.size(), _stream) != data.size()) fail();
}

void WholeFile::finish() {
    if (std::ferror(_stream) != 0 || std::fflush(_stream) != 0) fail();
    const bool closed = std::fclose(_stream) == 0;
    _stream = nullptr;
    std::error_code failure;
    if (closed && !_written.empty()) fs::rename(_written, _target, failure); // replaces the target
    const bool named = closed && !failure;
    if (!named && !_written.empty()) std::remove(_written.c_str());
    setUnfinished({});
    if (!named) fail();
}

void WholeFile::fail() const {
    throw osgSkin::Error(_file + ": cannot be written, expected a writable file");
}

void writeBytes(const std::string& file, const std::string& data) {
    WholeFile out(file);
    out.write(data);
    out.finish();
}

namespace {

bool begins(const std::string& data, const std::string& with) {
    return data.compare(0, with.size(), with) == 0;
}

std::optional<ImageBytes> readBytes(const osg::Image& image, const std::string& folder) {
    if (image.getFileName().empty()) return std::nullopt;
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_front(folder);
    ImageBytes result;
    result.file = osgDB::findDataFile(image.getFileName(), options);
    // A scene's embedded image can have any file name, also that of a pipe or a device.
    std::error_code failure;
    if (!std::filesystem::is_regular_file(result.file, failure)) return std::nullopt;
    std::ifstream in(result.file, std::ios::binary);
    result.data.assign(std::istreambuf_iterator<char>(in), {});
    result.isJpeg = begins(result.data, "\xff\xd8\xff");
    if (!result.isJpeg && !begins(result.data, "\x89PNG\r\n\x1a\n")) return std::nullopt;
    return result;
}

/// Converts any image to RGBA bytes from the lower left, which the PNG writer supports.
osg::ref_ptr<osg::Image> plain(const osg::Image& image) {
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(image.s(), image.t(), 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const bool flip = image.getOrigin() == osg::Image::TOP_LEFT;
    const auto columns = static_cast<unsigned>(image.s()), rows = static_cast<unsigned>(image.t());
    for (unsigned t = 0; t < rows; ++t)
        for (unsigned s = 0; s < columns; ++s)
            result->setColor(image.getColor(s, flip ? rows - 1 - t : t), s, t);
    return result;
}

std::optional<ImageBytes> makePng(const osg::Image& image) {
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
    if (writer == nullptr || image.isCompressed() || image.s() < 1 || image.t() < 1)
        return std::nullopt;
    std::ostringstream out;
    if (!writer->writeImage(*plain(image), out).success()) return std::nullopt;
    return ImageBytes{out.str(), false, {}};
}

} // namespace

std::optional<ImageBytes> bytesOf(const osg::Image& image, const std::string& folder) {
    std::optional<ImageBytes> result = readBytes(image, folder);
    if (!result) result = makePng(image);
    if (!result)
        OSG_NOTICE << "texture \"" << image.getFileName()
                   << "\" cannot be written as PNG; baked without" << std::endl;
    return result;
}

} // namespace bake
