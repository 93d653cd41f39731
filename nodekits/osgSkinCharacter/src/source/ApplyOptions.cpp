// SPDX-License-Identifier: MIT
#include "source/ApplyOptions.h"

#include "options/OptionTable.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkinImport/FindNamedFile>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

namespace fs = std::filesystem;

using Method = LoadOptions::Method;

void applyMethod(CharacterSource& source, Method method) {
    if (method == Method::Default) return;
    source.painted =
        method == Method::Weights ? CharacterSource::Painted::Yes : CharacterSource::Painted::No;
    source.bind.method =
        method == Method::Paper ? BindOptions::Method::Paper : BindOptions::Method::Smooth;
}

/// The end of an error about an unknown motion: the names of all motions. Without quotes, an option
/// string cuts a name at its first blank.
std::string expectedMotions(const CharacterSource& source, const std::string& wanted) {
    std::vector<std::string> names;
    for (const auto& animation : source.animations) names.push_back(animation->getName());
    for (const SkinFile::MotionEntry& entry : source.motions) names.push_back(entry.name);
    const auto isCut = [&](const std::string& name) { return name.rfind(wanted + ' ', 0) == 0; };
    const auto cut = std::find_if(names.begin(), names.end(), isCut);
    return expectedNames(wanted, names) +
           (cut == names.end() ? "" : "; an option string needs quotes: motion=\"" + *cut + '"');
}

/// Moves the element called `name` to the front, or the only one with that behind the last '|' of
/// its name (as in "Armature|walk", or Blender's "Armature|walk_Armature"). False where there is
/// none.
template <typename List, typename NameOf>
bool putFirst(List& list, const std::string& name, const NameOf& nameOf) {
    auto found = std::find_if(list.begin(), list.end(),
                              [&](const auto& item) { return nameOf(item) == name; });
    const auto endsSo = [&](const auto& item) {
        const std::string whole = nameOf(item);
        const std::size_t bar = whole.rfind('|');
        if (bar == std::string::npos) return false;
        const std::string clip = whole.substr(bar + 1);
        return clip == name || clip == name + '_' + whole.substr(0, bar);
    };
    if (found == list.end() && std::count_if(list.begin(), list.end(), endsSo) == 1)
        found = std::find_if(list.begin(), list.end(), endsSo);
    if (found == list.end()) return false;
    std::rotate(list.begin(), found, found + 1);
    return true;
}

/// A motion file, or with "#" and a clip's name or number, one of the file's motions.
SkinFile::MotionEntry fileEntry(const std::string& wanted, const osgDB::Options* read) {
    SkinFile::MotionEntry entry;
    entry.file = findNamedFile(wanted, read);
    entry.name = osgDB::getStrippedName(entry.file);
    const std::size_t mark = wanted.rfind('#');
    if (!entry.file.empty() || mark == std::string::npos || mark + 1 == wanted.size()) return entry;
    entry.file = findNamedFile(wanted.substr(0, mark), read);
    entry.name = entry.clip = wanted.substr(mark + 1);
    return entry;
}

void applyMotion(CharacterSource& source, const std::string& wanted, const osgDB::Options* read) {
    if (putFirst(source.animations, wanted, [](const auto& a) { return a->getName(); })) return;
    if (putFirst(source.motions, wanted, [](const auto& m) { return m.name; })) return;
    SkinFile::MotionEntry entry = fileEntry(wanted, read);
    if (entry.file.empty())
        throw Error(source.file + ": motion \"" + wanted +
                    "\" is neither one of its motions nor a file" +
                    expectedMotions(source, wanted));
    for (const SkinFile::MotionEntry& other : source.motions)
        if (other.name == entry.name) entry.name = wanted; // names are unique
    source.motions.insert(source.motions.begin(), entry);
    // A rigged model's animations move its own skeleton, retargeted motions that of makeSkeleton().
    // There is only one skeleton, so a character has either kind.
    source.animations.clear();
    source.skeleton = nullptr;
}

} // namespace

void applyOptions(CharacterSource& source, const LoadOptions& options) {
    const LoadOptions file = std::exchange(source.options, options);
    completeOptions(source.options, file);
    const LoadOptions& all = source.options;
    applyMethod(source, all.method);
    source.bind.rigid = all.rigid;
    source.bind.shapes = all.shapes;
    source.bind.surfaceNormals = all.surfaceNormals;
    source.bind.muscles = all.muscles.value_or(false);
    if (options.muscles == false) source.bind.ownMuscles.clear();
    if (options.atRest) {
        source.animations.clear();
        source.motions.clear();
        source.props.clear();
    } else if (options.motion) {
        applyMotion(source, *options.motion, options.readOptions.get());
    }
    if (options.atRest) return;
    for (const std::string& more : options.moreMotions) {
        applyMotion(source, more, options.readOptions.get());
        std::rotate(source.motions.begin(), source.motions.begin() + 1, source.motions.end());
    }
}

} // namespace osgSkin
