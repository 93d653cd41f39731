// SPDX-License-Identifier: MIT
#include "saved/ReadSaved.h"

#include "saved/CheckLinks.h"
#include "saved/CheckSaved.h"
#include "saved/SavedAscii.h"
#include "saved/SavedBinary.h"
#include "saved/SavedXml.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <utility>

namespace osgSkin {
namespace {

/// Of OpenSceneGraph 3.1.4; earlier ones name no classes of pictures.
constexpr int kFirstVersion = 95;

/// As OSG does: by what the file begins with, not by its name.
osg::ref_ptr<SavedInput> makeInput(std::string content, const ReadLimits& limits,
                                   SharedPictures* pictures, const std::string& path) {
    constexpr const char* kAscii = "#Ascii";
    if (content.compare(0, 6, kAscii) == 0)
        return new SavedAscii(content.substr(6), limits, pictures);
    if (content.compare(0, 5, "<?xml") == 0)
        return new SavedXml(content.substr(std::min(content.find('\n'), content.size())), limits,
                            pictures);
    if (!SavedBinary::begins(content))
        failFile(path, "it begins with neither #Ascii, <?xml nor what a binary file begins with");
    const osg::ref_ptr<SavedBinary> input = new SavedBinary(std::move(content), limits, pictures);
    return input;
}

/// Throws what is not for a reader, without the file's name.
osg::ref_ptr<osg::Node> readWith(SavedStream& stream, SavedInput& input) {
    input.setInputStream(&stream);
    if (auto* binary = dynamic_cast<SavedBinary*>(&input)) binary->skipBeginning();
    const osgDB::InputStream::ReadType kind = stream.start(&input);
    if (kind != osgDB::InputStream::READ_SCENE && kind != osgDB::InputStream::READ_OBJECT)
        SavedInput::refuse("no scene, expected one");
    if (stream.getFileVersion() < kFirstVersion)
        SavedInput::refuse("version " + std::to_string(stream.getFileVersion()) + ", expected " +
                           std::to_string(kFirstVersion) + " or later");
    stream.decompress(); // reads that it is not compressed
    const osg::ref_ptr<osg::Object> object = stream.readObject();
    if (stream.getException() != nullptr) SavedInput::refuse(stream.getException()->getError());
    if (dynamic_cast<osg::Node*>(object.get()) == nullptr)
        SavedInput::refuse("no node, expected one");
    input.finish();
    return dynamic_cast<osg::Node*>(object.get());
}

osg::ref_ptr<osg::Node> readScene(SavedStream& stream, SavedInput& input, const std::string& path) {
    try {
        return readWith(stream, input);
    } catch (const std::exception& error) { // OSG's memory, too
        failFile(path, error.what());
    }
}

} // namespace

bool isSaved(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return extension == "osgt" || extension == "osgb" || extension == "osgx" || extension == "osg2";
}

osg::ref_ptr<osg::Node> readSaved(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    std::string content = readWholeFile(path, limits.fileMegabytes, "maxFileMB");
    const std::size_t bytes = content.size();
    // What knows OSG's own classes is loaded with its reader.
    osgDB::Registry::instance()->getReaderWriterForExtension("osgt");
    const osg::ref_ptr<osgDB::Options> local =
        options != nullptr ? options->cloneOptions() : new osgDB::Options;
    local->getDatabasePathList().push_front(osgDB::getFilePath(path));
    const osg::ref_ptr<SavedInput> input =
        makeInput(std::move(content), limits, SharedPictures::of(options), path);
    SavedStream stream(local.get());
    const osg::ref_ptr<osg::Node> scene = readScene(stream, *input, path);
    checkSavedObjects(stream.objects(), path);
    checkLinks(stream.objects(), limits, path);
    checkSavedScene(*scene, bytes, limits, path);
    return scene;
}

} // namespace osgSkin
