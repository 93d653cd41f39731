// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>

/// Adds the version of the file to a class, before its other properties. Files without it or with
/// another one are refused.
void addFileVersion(osgDB::ObjectWrapper& wrapper);

/// Refuses a file of another version, with an exception that says so.
void refuseFile(osgDB::InputStream& is);
