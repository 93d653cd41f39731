// SPDX-License-Identifier: MIT
#include "BlockRows.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/SkinModel>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <exception>
#include <string>
#include <vector>

namespace {

bool checkModel(const osgSkin::SkinModel& model) {
    return model.vertexCount() > 0;
}

bool writeModel(osgDB::OutputStream& os, const osgSkin::SkinModel& model) {
    writeWords(os, osgSkin::packSkinModel(model));
    return true;
}

bool readModel(osgDB::InputStream& is, osgSkin::SkinModel& model) {
    std::vector<std::uint32_t> words;
    if (!readWords(is, words)) return false;
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
    addFileVersion(*wrapper);
    ADD_USER_SERIALIZER(Model);
}
