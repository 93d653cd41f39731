// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/Character.h"
#include "load/RigCharacter.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <exception>

/// Reads `.skin` files: a body, its skeleton and its motions, bound and playing. As a pseudo-loader
/// it re-skins any rigged model: `model.glb.skin`.
class ReaderWriterSkin : public osgDB::ReaderWriter {
public:
    ReaderWriterSkin() {
        supportsExtension("skin", "osgSkin character: a mesh, a skeleton and motions");
        supportsExtension("*.skin", "pseudo-loader: any rigged model, re-skinned");
        for (const auto& [option, meaning] : osgSkin::SkinOptions::list())
            supportsOption(option, meaning);
    }

    const char* className() const override { return "osgSkin character reader"; }

    ReadResult readObject(const std::string& file, const Options* options) const override {
        return readNode(file, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        try {
            const osgSkin::SkinOptions wanted = osgSkin::SkinOptions::parse(options);
            const std::string found = osgDB::findDataFile(file, options);
            if (found.empty()) return readRigged(file, options, wanted);
            osgSkin::Character character = osgSkin::Character::load(found, options, wanted);
            // Bounds and pictures taken before the first update show the motion's first pose.
            if (!character.motions.empty()) character.pose(character.motions.front(), 0);
            return character.root.get();
        } catch (const std::exception& error) {
            return ReadResult(error.what());
        }
    }

private:
    /// `model.glb.skin`, where there is no such file: model.glb, re-skinned.
    static ReadResult readRigged(const std::string& file, const Options* options,
                                 const osgSkin::SkinOptions& wanted) {
        const std::string model = osgDB::getNameLessExtension(file);
        if (osgDB::getFileExtension(model).empty()) return ReadResult::FILE_NOT_FOUND;
        return osgSkin::loadRigCharacter(model, options, wanted).get();
    }
};

REGISTER_OSGPLUGIN(skin, ReaderWriterSkin)
