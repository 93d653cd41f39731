// SPDX-License-Identifier: MIT
//
// Files of osgSkin 0.3 and older are refused by names of classes that only they have, too.
#include "FileVersion.h"
#include "RegisterWrapper.h"

#include <osgDB/InputStream>

namespace {

class FormerClass : public osgDB::BaseSerializer {
public:
    FormerClass() : BaseSerializer(READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }
    bool read(osgDB::InputStream& is, osg::Object&) override {
        refuseFile(is);
        return false;
    }
    bool write(osgDB::OutputStream&, const osg::Object&) override { return true; }

private:
    const std::string _name = "FormerClass";
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

extern "C" void wrapper_serializer_osgSkin_FormerClasses(void) {}
