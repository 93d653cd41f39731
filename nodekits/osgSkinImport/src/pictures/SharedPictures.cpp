// SPDX-License-Identifier: MIT
#include "pictures/SharedPictures.h"

#include <osgSkin/Error>

#include <osg/UserDataContainer>

#include <filesystem>
#include <system_error>

namespace osgSkin {

SharedPictures* SharedPictures::of(const osgDB::Options* options) {
    const osg::UserDataContainer* all =
        options != nullptr ? options->getUserDataContainer() : nullptr;
    if (all == nullptr) return nullptr;
    for (unsigned i = 0; i < all->getNumUserObjects(); ++i)
        if (const auto* found = dynamic_cast<const SharedPictures*>(all->getUserObject(i)))
            return const_cast<SharedPictures*>(found); // which options are shared for
    return nullptr;
}

osg::ref_ptr<osg::Image>
SharedPictures::once(const std::string& path, const std::string& part,
                     const std::function<osg::ref_ptr<osg::Image>()>& read) {
    std::error_code failure;
    const std::string file = std::filesystem::weakly_canonical(path, failure).string();
    const auto [entry, isNew] = _files.emplace((failure ? path : file) + '\n' + part, Read());
    Read& known = entry->second;
    try {
        if (isNew) known.image = read();
    } catch (const Error& error) {
        known.reason = error.what();
    }
    if (!known.reason.empty()) throw Error(known.reason);
    return known.image;
}

} // namespace osgSkin
