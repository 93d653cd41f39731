// SPDX-License-Identifier: MIT
#include "AttachmentFile.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"

#include <osgSkinMotion/FaceControls>

namespace osgSkinMotion {
using osgSkin::FaceControls; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace osgSkin {

/// A weight that is no number: the name has none yet.
template <typename Archive>
void AttachmentFile::pass(Archive& archive, FaceControls& face) {
    archive.list(face._names, "names", 1, [&](std::string& name) { archive(name); });
    archive.list(face._weights, "weights", 1, [&](float& weight) { archive(weight); });
    archive(face._given);
    if (face._given > face._names.size() || face._weights.size() != face._names.size())
        archive.fail("names and weights are not as many");
}

} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(
    osgSkinMotion_FaceControls, new osgSkin::FaceControls, osgSkinMotion::FaceControls,
    "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::FaceControls") {
    addFileVersion(*wrapper);
    addBlock<osgSkin::FaceControls, osgSkin::AttachmentFile>(*wrapper, "Weights", "face");
}
