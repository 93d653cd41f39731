// SPDX-License-Identifier: MIT
#include <osgSkinImport/SharePictures>

#include "pictures/SharedPictures.h"

#include <osg/UserDataContainer>

namespace osgSkin {

osg::ref_ptr<osgDB::Options> sharePictures(const osgDB::Options* options) {
    const osg::ref_ptr<osgDB::Options> result =
        options != nullptr ? options->cloneOptions() : new osgDB::Options;
    if (SharedPictures::of(result) != nullptr) return result;
    // The copy has the container of the original.
    if (const osg::UserDataContainer* all = result->getUserDataContainer())
        result->setUserDataContainer(osg::clone(all, osg::CopyOp::SHALLOW_COPY));
    result->getOrCreateUserDataContainer()->addUserObject(new SharedPictures);
    return result;
}

} // namespace osgSkin
