// SPDX-License-Identifier: MIT
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "players/PlacedBone.h"

#include <osgSkinMotion/LivePlayer>

#include <osg/Notify>
#include <osgDB/OutputStream>

namespace osgSkinMotion {
using osgSkin::LivePlayer; // osgDB knows classes by their libraries
using osgSkin::PlacedBone;
} // namespace osgSkinMotion

namespace {

/// Nothing: the animation managers, which are nested in it, play on.
class NoticeOnly : public osgDB::BaseSerializer {
public:
    NoticeOnly() : BaseSerializer(READ_WRITE_PROPERTY) {}
    const std::string& getName() const override { return _name; }
    bool read(osgDB::InputStream&, osg::Object&) override { return true; }
    bool write(osgDB::OutputStream&, const osg::Object&) override {
        OSG_NOTICE << "osgSkin: a LivePlayer is not saved; in the file the character's animations "
                      "play"
                   << std::endl;
        return true;
    }

private:
    const std::string _name = "Nothing";
};

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_LivePlayer, new osgSkin::LivePlayer,
                         osgSkinMotion::LivePlayer,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::LivePlayer") {
    addFileVersion(*wrapper);
    wrapper->addSerializer(new NoticeOnly, osgDB::BaseSerializer::RW_USER);
}

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_PlacedBone, new osgSkin::PlacedBone,
                         osgSkinMotion::PlacedBone,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::PlacedBone") {
    addFileVersion(*wrapper);
}
