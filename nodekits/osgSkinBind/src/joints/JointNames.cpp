// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/JointNames.h"

#include <cctype>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

bool isLetter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool isUpper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}
char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// The words of a name, lower case: split at separators, at digits and where a capital starts one
/// ("LHipJoint" is l, hip, joint). What a namespace ("rig:") puts in front is dropped.
std::vector<std::string> words(const std::string& name) {
    const std::size_t colon = name.find_last_of(":|");
    const std::string own = colon == std::string::npos ? name : name.substr(colon + 1);
    std::vector<std::string> result;
    bool inWord = false;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const char c = own[i];
        if (!isLetter(c)) {
            if (std::isdigit(static_cast<unsigned char>(c))) {
                // Digits are a word too: "Hand1" is not the hand.
                if (i > 0 && std::isdigit(static_cast<unsigned char>(own[i - 1])))
                    result.back() += c;
                else
                    result.emplace_back(1, c);
            }
            inWord = false;
            continue;
        }
        const bool afterLower = i > 0 && isLetter(own[i - 1]) && !isUpper(own[i - 1]);
        const bool beforeLower = i + 1 < own.size() && isLetter(own[i + 1]) && !isUpper(own[i + 1]);
        if (!inWord || (isUpper(c) && (afterLower || beforeLower))) result.emplace_back();
        result.back() += lower(c);
        inWord = true;
    }
    return result;
}

bool startsWith(const std::string& text, const std::string& prefix) {
    return text.compare(0, prefix.size(), prefix) == 0;
}

/// The name without prefix and side, its words joined.
std::string bareName(const std::string& name) {
    static const std::set<std::string> kSides = {"l", "r", "left", "right"};
    static const std::set<std::string> kPrefixes = {"bip", "mixamorig", "def", "org"};
    std::string bare;
    bool afterPrefix = false;
    for (const std::string& word : words(name)) {
        const bool number = std::isdigit(static_cast<unsigned char>(word[0])) != 0;
        if (bare.empty() && kPrefixes.count(word)) {
            afterPrefix = true;
            continue;
        }
        if (afterPrefix && number && bare.empty()) continue; // Bip01
        if (!kSides.count(word)) bare += word;
    }
    for (const std::string side : {"left", "right"}) // all in lower case: "lefthand"
        if (startsWith(bare, side)) bare.erase(0, side.size());
    return bare;
}

} // namespace

bool isHeadName(const std::string& name) {
    return bareName(name) == "head";
}

bool isHandName(const std::string& name) {
    const std::string bare = bareName(name);
    return bare == "hand" || bare == "wrist";
}

bool isFootName(const std::string& name) {
    const std::string bare = bareName(name);
    return bare == "foot" || bare == "ankle";
}

bool isThumbName(const std::string& name) {
    return bareName(name).find("thumb") != std::string::npos;
}

} // namespace osgSkin
