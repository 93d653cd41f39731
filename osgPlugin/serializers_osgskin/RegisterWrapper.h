// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>

#include <memory>
#include <string>

/// Registers a wrapper, unless the runtime that is loaded is of another build: then nothing is
/// registered, and the first call has warned. Lives as long as the result.
std::unique_ptr<osgDB::RegisterWrapperProxy>
registerWrapper(osgDB::ObjectWrapper::CreateInstanceFunc* create, const std::string& name,
                const std::string& bases, osgDB::RegisterWrapperProxy::AddPropFunc add);

/// osgDB's REGISTER_OBJECT_WRAPPER, by registerWrapper().
#define REGISTER_OSGSKIN_WRAPPER(NAME, CREATE, CLASS, BASES)                                       \
    extern "C" void wrapper_serializer_##NAME(void) {}                                             \
    extern void wrapper_propfunc_##NAME(osgDB::ObjectWrapper*);                                    \
    static osg::Object* wrapper_create_##NAME() {                                                  \
        return CREATE;                                                                             \
    }                                                                                              \
    static const auto wrapper_proxy_##NAME =                                                       \
        registerWrapper(wrapper_create_##NAME, #CLASS, BASES, &wrapper_propfunc_##NAME);           \
    using MyClass = CLASS;                                                                         \
    void wrapper_propfunc_##NAME([[maybe_unused]] osgDB::ObjectWrapper* wrapper)
