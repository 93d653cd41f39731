// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/ProgressOption>

#include <osg/Object>
#include <osg/UserDataContainer>
#include <osg/ref_ptr>

#include <utility>

namespace osgSkin {

namespace {

/// Carries a function among the options' user objects.
class ProgressHolder : public osg::Object {
public:
    explicit ProgressHolder(Progress wanted = {}) : progress(std::move(wanted)) {}
    ProgressHolder(const ProgressHolder& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), progress(other.progress) {}
    META_Object(osgSkin, ProgressHolder)

    const Progress progress;
};

} // namespace

void setProgress(osgDB::Options& options, const Progress& progress) {
    osg::UserDataContainer& data = *options.getOrCreateUserDataContainer();
    for (unsigned int i = data.getNumUserObjects(); i-- > 0;)
        if (dynamic_cast<ProgressHolder*>(data.getUserObject(i)) != nullptr)
            data.removeUserObject(i);
    if (progress) data.addUserObject(new ProgressHolder(progress));
}

Progress getProgress(const osgDB::Options* options) {
    const osg::UserDataContainer* data =
        options != nullptr ? options->getUserDataContainer() : nullptr;
    if (data == nullptr) return {};
    for (unsigned int i = 0; i < data->getNumUserObjects(); ++i)
        if (const auto* found = dynamic_cast<const ProgressHolder*>(data->getUserObject(i)))
            return found->progress;
    return {};
}

} // namespace osgSkin
