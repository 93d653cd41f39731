// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <filesystem>
#include <stdexcept>

namespace {

/// At your desk: binds a character and saves it with its textures.
void save(const std::string& file, const std::string& saved) {
    osgSkin::LoadOptions options;
    options.mergeRigid = true; // fewer drawables
    const osgSkin::Character character = osgSkin::loadCharacter(file, options);
    const osg::ref_ptr<osgDB::Options> inside = new osgDB::Options("WriteImageHint=IncludeData");
    if (!osgDB::writeNodeFile(*character.root, saved, inside))
        throw std::runtime_error(saved + ": cannot be written");
}

/// In the game: needs osgSkin and the serializers alone, which are MIT.
osg::ref_ptr<osg::Node> load(const std::string& saved) {
    osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(saved);
    if (!character) throw std::runtime_error(saved + ": cannot be read");
    return character;
}

} // namespace

/// A character that was saved and read again.
osg::ref_ptr<osg::Node> shipAsOsgb(const std::string& file) {
    const std::string saved =
        (std::filesystem::temp_directory_path() / "osgskin-recipe.osgb").string();
    save(file, saved);
    return load(saved);
}
