// SPDX-License-Identifier: MIT
//
// Files of osgSkin 0.3 and older are refused: by the version, which they lack, and by names of
// classes that only they have.
#include "FileVersion.h"

#include "RegisterWrapper.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <string>

namespace {

/// To be increased with every change of a format. Binary files of osgSkin 0.3 have a 0 or a 1 in
/// the first byte.
constexpr unsigned int kFileVersion = 4;

void refuse(osgDB::InputStream& is) {
    is.throwException("osgSkin: written by osgSkin 0.3 or older, or by a newer one; make the file "
                      "again from its source, for example with osgconv character.skin "
                      "character.osgb");
}

class FileVersion : public osgDB::BaseSerializer {
public:
    FileVersion() : BaseSerializer(READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }

    bool read(osgDB::InputStream& is, osg::Object&) override {
        unsigned int version = 0;
        if (is.isBinary() || is.matchString(_name)) is >> version;
        if (!is.getException() && version != kFileVersion) refuse(is);
        return !is.getException();
    }

    bool write(osgDB::OutputStream& os, const osg::Object&) override {
        if (!os.isBinary()) os << os.PROPERTY(_name.c_str());
        os << kFileVersion << std::endl;
        return true;
    }

private:
    const std::string _name = "FileVersion";
};

/// Of a class that only older files have.
class FormerClass : public FileVersion {
public:
    bool read(osgDB::InputStream& is, osg::Object&) override {
        refuse(is);
        return false;
    }
};

std::unique_ptr<osgDB::RegisterWrapperProxy> registerFormer(const char* name) {
    return registerWrapper([]() -> osg::Object* { return new osg::DummyObject; }, name, name,
                           [](osgDB::ObjectWrapper* wrapper) {
                               wrapper->addSerializer(new FormerClass,
                                                      osgDB::BaseSerializer::RW_USER);
                           });
}

const auto autoPlayClips = registerFormer("osgSkin::AutoPlayClips");
const auto morphedSkin = registerFormer("osgSkin::MorphedSkin");

} // namespace

extern "C" void wrapper_serializer_osgSkin_FileVersion(void) {}

void addFileVersion(osgDB::ObjectWrapper& wrapper) {
    wrapper.addSerializer(new FileVersion, osgDB::BaseSerializer::RW_USER);
}
