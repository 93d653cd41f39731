// SPDX-License-Identifier: MIT
#include "KitCheck.h"
#include "osgSkinBindBuild.h"
#include "osgSkinBuild.h"
#include "osgSkinCharacterBuild.h"
#include "osgSkinGpuBuild.h"
#include "osgSkinImportBuild.h"
#include "osgSkinMotionBuild.h"
#include "osgSkinRigBuild.h"

#include <osg/Notify>
#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>
#include <osgSkinImport/FindNamedFile>

#include <osgDB/FileNameUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <chrono>
#include <exception>
#include <memory>
#include <string>

namespace {

/// Interval between progress lines. Shorter loads print none.
constexpr std::chrono::seconds kBetweenLines(3);

/// Logs progress as OSG notices, for hosts such as osgconv that set no progress callback:
/// large meshes take a while.
osgSkin::Progress noticesOf(const std::string& file) {
    using Clock = std::chrono::steady_clock;
    const std::string name = osgDB::getSimpleFileName(file);
    return [name, due = Clock::now() + kBetweenLines](const osgSkin::ProgressStep& step) mutable {
        if (Clock::now() < due) return;
        due = Clock::now() + kBetweenLines;
        OSG_NOTICE << osgSkin::onOneLine(name + ": " + step.what) << ", "
                   << static_cast<int>(100.0 * step.fraction) << " %" << std::endl;
    };
}

} // namespace

/// Reads `.skin` files: a body, its skeleton and its motions, bound and playing. As a pseudo-loader
/// (`model.glb.skin`), re-skins any rigged model. Both call osgSkin::loadCharacter().
class ReaderWriterSkin : public osgDB::ReaderWriter {
public:
    ReaderWriterSkin() {
        supportsExtension("skin", "osgSkin character: a mesh, a skeleton and motions");
        supportsExtension("*.skin", "pseudo-loader: any rigged model, re-skinned");
        for (const auto& [option, meaning] : osgSkin::optionWords())
            supportsOption(option, meaning);
    }

    const char* className() const override { return "osgSkin character reader"; }

    ReadResult readObject(const std::string& file, const Options* options) const override {
        return readNode(file, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        const bool namesAModel =
            !osgDB::getFileExtension(osgDB::getNameLessExtension(file)).empty();
        if (!namesAModel && osgSkin::findNamedFile(file, options).empty())
            return ReadResult::FILE_NOT_FOUND;
        try {
            osgSkin::LoadOptions load = osgSkin::toLoadOptions(options);
            if (!load.progress) load.progress = noticesOf(file);
            return osgSkin::loadCharacter(file, load).root.get();
        } catch (const std::exception& error) {
            return ReadResult(error.what());
        }
    }
};

// Like REGISTER_OSGPLUGIN, but only with the libraries that the plug-in was built with.
extern "C" void osgdb_skin(void) {}
static const auto g_proxy =
    plugin::mayUse("osgdb_skin", {OSGSKIN_KIT_BUILD(osgSkin), OSGSKIN_KIT_BUILD(osgSkinRig),
                                  OSGSKIN_KIT_BUILD(osgSkinMotion), OSGSKIN_KIT_BUILD(osgSkinGpu),
                                  OSGSKIN_KIT_BUILD(osgSkinBind), OSGSKIN_KIT_BUILD(osgSkinImport),
                                  OSGSKIN_KIT_BUILD(osgSkinCharacter)})
        ? std::make_unique<osgDB::RegisterReaderWriterProxy<ReaderWriterSkin>>()
        : nullptr;
