// SPDX-License-Identifier: MIT
#include "RegisterWrapper.h"

std::unique_ptr<osgDB::RegisterWrapperProxy>
registerWrapper(osgDB::ObjectWrapper::CreateInstanceFunc* create, const std::string& name,
                const std::string& bases, osgDB::RegisterWrapperProxy::AddPropFunc add) {
    static const bool mayUse = mayUseKits();
    if (!mayUse) return nullptr;
    return std::make_unique<osgDB::RegisterWrapperProxy>(create, name, bases, add);
}
