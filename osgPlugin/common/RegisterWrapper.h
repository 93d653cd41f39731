// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>

#include <memory>
#include <string>

/// Whether the loaded kits are those that this module was compiled with, see plugin::mayUse(). Each
/// module has its own, in LibraryWrapper.cpp; archives are linked with the kits of their build.
#ifdef OSGSKIN_STATIC
inline bool mayUseKits() {
    return true;
}
#else
bool mayUseKits();
#endif

/// Registers a wrapper for the lifetime of the result. Registers nothing unless mayUseKits().
std::unique_ptr<osgDB::RegisterWrapperProxy>
registerWrapper(osgDB::ObjectWrapper::CreateInstanceFunc* create, const std::string& name,
                const std::string& bases, osgDB::RegisterWrapperProxy::AddPropFunc add);

/// Like osgDB's REGISTER_OBJECT_WRAPPER, but uses registerWrapper().
#define REGISTER_OSGSKIN_WRAPPER(NAME, CREATE, CLASS, BASES)                                       \
    extern "C" void wrapper_serializer_##NAME(void) {}                                             \
    namespace {                                                                                    \
    struct wrapper_##NAME {                                                                        \
        using MyClass = CLASS; /* osgDB's ADD_... macros say so */                                 \
        static osg::Object* create() { return CREATE; }                                            \
        static void addProperties(osgDB::ObjectWrapper*);                                          \
    };                                                                                             \
    }                                                                                              \
    static const auto wrapper_proxy_##NAME =                                                       \
        registerWrapper(wrapper_##NAME::create, #CLASS, BASES, &wrapper_##NAME::addProperties);    \
    void wrapper_##NAME::addProperties([[maybe_unused]] osgDB::ObjectWrapper* wrapper)
