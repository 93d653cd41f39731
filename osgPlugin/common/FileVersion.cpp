// SPDX-License-Identifier: MIT
//
// Files of another version are refused; those of osgSkin 0.3 and older have none.
#include "FileVersion.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <string>

namespace {

/// To be increased with every change of a format. Binary files of osgSkin 0.3 have a 0 or a 1 in
/// the first byte.
constexpr unsigned int kFileVersion = 5;

class FileVersion : public osgDB::BaseSerializer {
public:
    FileVersion() : BaseSerializer(READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }

    bool read(osgDB::InputStream& is, osg::Object&) override {
        unsigned int version = 0;
        if (is.isBinary() || is.matchString(_name)) is >> version;
        if (!is.getException() && version != kFileVersion)
            is.throwException("osgSkin: written by another version of osgSkin; make the file again "
                              "from its source, for example with osgconv character.skin "
                              "character.osgb");
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
