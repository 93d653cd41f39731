// SPDX-License-Identifier: MIT
#include <osgSkinImport/LoadProgress>

#include <osg/UserDataContainer>

namespace osgSkin {

void setLoadProgress(osgDB::Options& options, LoadProgress* progress) {
    osg::UserDataContainer& data = *options.getOrCreateUserDataContainer();
    for (unsigned int i = data.getNumUserObjects(); i-- > 0;)
        if (dynamic_cast<LoadProgress*>(data.getUserObject(i)) != nullptr) data.removeUserObject(i);
    if (progress != nullptr) data.addUserObject(progress);
}

LoadProgress* getLoadProgress(const osgDB::Options* options) {
    const osg::UserDataContainer* data =
        options != nullptr ? options->getUserDataContainer() : nullptr;
    if (data == nullptr) return nullptr;
    for (unsigned int i = 0; i < data->getNumUserObjects(); ++i)
        if (auto* found = dynamic_cast<const LoadProgress*>(data->getUserObject(i)))
            return const_cast<LoadProgress*>(found);
    return nullptr;
}

} // namespace osgSkin
