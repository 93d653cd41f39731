// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SHAREDBYOPTIONS_H
#define OSGSKINIMPORT_SHAREDBYOPTIONS_H 1

#include <osg/UserDataContainer>
#include <osgDB/Options>

namespace osgSkin {

/// The object of a class that options share; null if `options` is null or has none.
template <typename Shared>
Shared* sharedBy(const osgDB::Options* options) {
    const osg::UserDataContainer* all = options ? options->getUserDataContainer() : nullptr;
    for (unsigned i = 0; all && i < all->getNumUserObjects(); ++i)
        if (const auto* found = dynamic_cast<const Shared*>(all->getUserObject(i)))
            return const_cast<Shared*>(found); // options are const, but exist to share it
    return nullptr;
}

/// A copy of options, which may be null, that shares the same object of a class, or a new one.
template <typename Shared>
osg::ref_ptr<osgDB::Options> share(const osgDB::Options* options) {
    const osg::ref_ptr<osgDB::Options> result =
        options ? options->cloneOptions() : new osgDB::Options;
    if (sharedBy<Shared>(result)) return result;
    // cloneOptions() shares the container with the original.
    if (const osg::UserDataContainer* all = result->getUserDataContainer())
        result->setUserDataContainer(osg::clone(all, osg::CopyOp::SHALLOW_COPY));
    result->getOrCreateUserDataContainer()->addUserObject(new Shared);
    return result;
}

} // namespace osgSkin

#endif
