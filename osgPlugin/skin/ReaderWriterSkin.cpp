// SPDX-License-Identifier: GPL-3.0-or-later
#include "Character.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <exception>

/// Reads `.skin` files: a body, its skeleton and its motions, bound and playing.
class ReaderWriterSkin : public osgDB::ReaderWriter {
public:
    ReaderWriterSkin() {
        supportsExtension("skin", "osgSkin character: a mesh, a skeleton and motions");
    }

    const char* className() const override { return "osgSkin character reader"; }

    ReadResult readObject(const std::string& file, const Options* options) const override {
        return readNode(file, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string found = osgDB::findDataFile(file, options);
        if (found.empty()) return ReadResult::FILE_NOT_FOUND;
        try {
            osgSkin::Character character = osgSkin::Character::load(found, options);
            // Bounds and pictures taken before the first update show the motion's first pose.
            if (!character.motions.empty()) character.pose(character.motions.front(), 0);
            return character.root.get();
        } catch (const std::exception& error) {
            return ReadResult(error.what());
        }
    }
};

REGISTER_OSGPLUGIN(skin, ReaderWriterSkin)
