// SPDX-License-Identifier: MIT
#include "RegisterWrapper.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/SkinModel>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <exception>

namespace {

// Maximum number of words in a row. Each row starts with its length; an empty row ends the block.
// There is no total length, because a damaged file could make us allocate any amount of memory.
constexpr unsigned int kRow = 16;

bool checkModel(const osgSkin::SkinModel& model) {
    return model.vertexCount() > 0;
}

bool writeModel(osgDB::OutputStream& os, const osgSkin::SkinModel& model) {
    const std::vector<std::uint32_t> words = osgSkin::packSkinModel(model);
    os << os.BEGIN_BRACKET << std::endl;
    for (std::size_t first = 0; first < words.size(); first += kRow) {
        const std::size_t end = std::min(words.size(), first + kRow);
        os << static_cast<unsigned int>(end - first);
        for (std::size_t i = first; i < end; ++i) os << static_cast<unsigned int>(words[i]);
        os << std::endl;
    }
    os << 0u << std::endl << os.END_BRACKET << std::endl;
    return true;
}

bool readWords(osgDB::InputStream& is, std::vector<std::uint32_t>& words) {
    for (;;) {
        unsigned int length = 0;
        is >> length;
        if (is.getException()) return false;
        if (length == 0) return true;
        if (length > kRow) {
            is.throwException("osgSkin: a skin model's block has a row of " +
                              std::to_string(length) + " words, expected at most " +
                              std::to_string(kRow));
            return false;
        }
        for (unsigned int i = 0; i < length; ++i) {
            unsigned int word = 0;
            is >> word;
            words.push_back(word);
        }
    }
}

bool readModel(osgDB::InputStream& is, osgSkin::SkinModel& model) {
    is >> is.BEGIN_BRACKET;
    std::vector<std::uint32_t> words;
    if (!readWords(is, words)) return false;
    is >> is.END_BRACKET;
    try {
        osgSkin::unpackSkinModel(words, model);
    } catch (const std::exception& error) {
        // The exception rejects the whole file, and osgDB prints the reason.
        is.throwException(std::string("osgSkin: ") + error.what());
        return false;
    }
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkin_SkinModel, new osgSkin::SkinModel, osgSkin::SkinModel,
                         "osg::Object osgSkin::SkinModel") {
    ADD_USER_SERIALIZER(Model);
}

namespace osgSkin {
/// Former name of the class in files, before it became an osg::Object; only read, never written.
using SharedSkinModel = SkinModel;
} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(osgSkin_SharedSkinModel, new osgSkin::SharedSkinModel,
                         osgSkin::SharedSkinModel, "osg::Object osgSkin::SharedSkinModel") {
    ADD_USER_SERIALIZER(Model);
}
