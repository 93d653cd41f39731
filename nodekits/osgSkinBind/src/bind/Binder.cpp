// SPDX-License-Identifier: MIT
#include "bind/Binder.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <mutex>

#if !defined(_WIN32) && !defined(OSGSKIN_STATIC)
#include <dlfcn.h>
#endif

namespace osgSkin {
namespace {

std::mutex registering;
osg::ref_ptr<const Binder> registered;

osg::ref_ptr<const Binder> current() {
    const std::lock_guard<std::mutex> lock(registering);
    return registered;
}

/// Static kits have no binder: the plug-in links shared ones, and would register with these.
void load() {
#ifndef OSGSKIN_STATIC
    osgDB::Registry& registry = *osgDB::Registry::instance();
    const std::string plugin = registry.createLibraryNameForExtension("binder_osgskin");
#ifndef _WIN32 // where osgDB searches the folders of programs and DLLs
    Dl_info self;
    if (dladdr(&registered, &self) != 0) {
        registry.loadLibrary(osgDB::concatPaths(osgDB::getFilePath(self.dli_fname), plugin));
        if (current()) return;
    }
#endif
    registry.loadLibrary(plugin);
#endif
}

} // namespace

Binder::~Binder() = default;

osg::ref_ptr<const Binder> Binder::find(const std::string& task) {
    if (!current()) load();
    osg::ref_ptr<const Binder> result = current();
    if (!result)
        throw Error(task +
                    " needs the plug-in osgdb_binder_osgskin (package osgskin-binder), which "
                    "is not installed or belongs to another build; without it, only "
                    "painted weights can be bound");
    return result;
}

void Binder::set(const Binder* binder) {
    const std::lock_guard<std::mutex> lock(registering);
    registered = binder;
}

} // namespace osgSkin
