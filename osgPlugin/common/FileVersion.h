// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>

/// Adds the version of the file to a class, before its other properties. Files without it or with
/// another one are refused.
void addFileVersion(osgDB::ObjectWrapper& wrapper);
