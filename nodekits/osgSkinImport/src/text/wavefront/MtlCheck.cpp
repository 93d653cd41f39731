// SPDX-License-Identifier: MIT
#include "text/wavefront/MtlCheck.h"

#include "text/FileText.h"
#include "text/wavefront/ObjLines.h"

#include <osgDB/FileNameUtils>

#include <cmath>
#include <cstddef>

namespace osgSkin {
namespace {

constexpr std::size_t kLongestKeyword = 16; // longer ones are none of MTL's
constexpr std::size_t kLongestOption = 400;

/// Whether an option among the words is a number that tinyobjloader would overflow at.
bool hasOverflow(std::string_view words) {
    for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
        double value = 0.0;
        if (!parseNumber(word, value)) continue;
        if (word.size() >= kLongestOption || (value != 0.0 && !isInRange(value))) return true;
    }
    return false;
}

/// Whether a texture's options move it, or scale it.
bool isPlaced(std::string_view words) {
    std::string_view option;
    for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
        double value = 0.0;
        if (!parseNumber(word, value))
            option = word;
        else if ((option == "-o" && value != 0.0) || (option == "-s" && value != 1.0))
            return true;
    }
    return false;
}

/// Keywords of material libraries that are used, and how many numbers follow; 0: a file's name.
struct MtlKeyword {
    const char* name;
    std::size_t numbers;
};
constexpr MtlKeyword kMtlKeywords[] = {{"newmtl", 0}, {"Kd", 3}, {"Ks", 3}, {"Ke", 3},
                                       {"Ns", 1},     {"d", 1},  {"Tr", 1}, {"map_Kd", 0}};

/// What a material is drawn with that says none, as one that no library has.
constexpr const char* kUnknownColour = "Kd 0.8 0.74 0.68\n";

} // namespace

CheckedMtl checkMtl(std::string_view text, std::set<std::string>& wanted) {
    CheckedMtl result;
    std::string& checked = result.text;
    bool isWanted = false, hasColour = true, glows = false;
    const auto finish = [&] { // tinyobjloader's own default is black
        if (!hasColour) checked += kUnknownColour;
        if (glows) checked += "Ke 0 0 0\n";
        hasColour = true;
        glows = false;
    };
    forEachLine(text, [&](std::string_view given, std::string_view rest, std::size_t) {
        const std::string keyword(given.substr(0, kLongestKeyword)); // some write small letters
        if (osgDB::equalCaseInsensitive(keyword, "newmtl")) {
            finish();
            isWanted = wanted.erase(materialName(rest)) > 0;
            hasColour = !isWanted;
        }
        if (!isWanted) return;
        if (osgDB::equalCaseInsensitive(keyword, "map_d")) ++result.opacityTextures;
        if (osgDB::equalCaseInsensitive(keyword, "map_Ke")) {
            ++result.glowTextures;
            glows = true;
        }
        for (const MtlKeyword& known : kMtlKeywords) {
            if (!osgDB::equalCaseInsensitive(keyword, known.name)) continue;
            std::string line(known.name);
            bool hasNumbers = true;
            std::string_view first;
            for (std::size_t k = 0; k < known.numbers; ++k) {
                std::string_view word = takeWord(rest);
                if (k == 0) first = word;
                if (word.empty()) word = first; // the one number of a grey
                double value = 0.0;
                hasNumbers = hasNumbers && parseNumber(word, value) && std::isfinite(value);
                addNumber(word, value, line);
            }
            // "Kd spectral x.rfl", "d -halo 0.5": better as if it were not there than black, or
            // gone.
            if (!hasNumbers || (known.numbers == 0 && hasOverflow(rest))) continue;
            const std::string_view name = known.name;
            hasColour = hasColour || name == "Kd" || name == "map_Kd";
            if (name == "newmtl")
                line += ' ' + materialName(rest);
            else if (known.numbers == 0)
                line += rest.substr(0, kLongestName);
            if (name == "map_Kd" && isPlaced(rest)) ++result.placedTextures;
            checked += line + '\n';
        }
    });
    finish();
    return result;
}

} // namespace osgSkin
