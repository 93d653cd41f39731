// SPDX-License-Identifier: MIT
//
// Files of osgSkin 0.3 and older are refused by the version, which they lack.
#include "FileVersion.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <string>

void refuseFile(osgDB::InputStream& is) {
    is.throwException("osgSkin: written by osgSkin 0.3 or older, or by a newer one; make the file "
                      "again from its source, for example with osgconv character.skin "
                      "character.osgb");
}

namespace {

/// To be increased with every change of a format. Binary files of osgSkin 0.3 have a 0 or a 1 in
/// the first byte.
constexpr unsigned int kFileVersion = 4;

class FileVersion : public osgDB::BaseSerializer {
public:
    FileVersion() : BaseSerializer(READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }

    bool read(osgDB::InputStream& is, osg::Object&) override {
        unsigned int version = 0;
        if (is.isBinary() || is.matchString(_name)) is >> version;
        if (!is.getException() && version != kFileVersion) refuseFile(is);
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

} // namespace

void addFileVersion(osgDB::ObjectWrapper& wrapper) {
    wrapper.addSerializer(new FileVersion, osgDB::BaseSerializer::RW_USER);
}
