// SPDX-License-Identifier: MIT
#include "names/NameWords.h"

#include <cctype>
#include <set>

namespace osgSkin {
namespace {

/// Beyond this a name is none that anybody gave a part of a body, and its words take long to read.
constexpr std::size_t kLongestName = 1000;

bool isLetter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool isUpper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}
bool isBeyondAscii(char c) {
    return static_cast<unsigned char>(c) >= 0x80;
}
char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// What stands before a colon or bar is a file's or a tool's, not the joint's.
std::string withoutNamespace(const std::string& name, const char* marks) {
    return name.substr(name.find_last_of(marks) + 1);
}

/// FBX exporters write "FBXASC" and three digits for signs that Maya does not allow.
std::string withoutCodes(std::string name) {
    const std::string code = "FBXASC";
    for (std::size_t at = name.find(code); at != std::string::npos; at = name.find(code, at + 1)) {
        const std::string digits = name.substr(at + code.size(), 3);
        if (digits.size() < 3 || !isNumber(digits) || std::stoi(digits) > 126) continue;
        name.replace(at, code.size() + 3, 1, static_cast<char>(std::stoi(digits)));
    }
    return name;
}

/// "NPC Head [Head]" is "NPC Head", but "Arm (L)" stays: a side says something.
std::string withoutNote(const std::string& name) {
    const std::size_t open = name.find_first_of("[(");
    const std::size_t close = name.find_last_of(")]");
    if (open == 0 || open == std::string::npos || close == std::string::npos || close < open + 3)
        return name;
    return name.substr(0, open) + name.substr(close + 1);
}

/// "LUArm", "RFArm": a side, and then the upper arm or forearm.
bool beginsShortArm(const std::string& name, std::size_t i) {
    if ((name[i] != 'U' && name[i] != 'F') || i == 0 || i + 2 >= name.size()) return false;
    const bool afterSide =
        (name[i - 1] == 'L' || name[i - 1] == 'R') && (i == 1 || !isUpper(name[i - 2]));
    return afterSide && isUpper(name[i + 1]) && isLetter(name[i + 2]) && !isUpper(name[i + 2]);
}

std::vector<std::string> wordsOf(const std::string& name) {
    std::vector<std::string> result;
    bool inWord = false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (!isLetter(c)) {
            if (isDigit(c)) {
                if (i > 0 && isDigit(name[i - 1]))
                    result.back() += c;
                else
                    result.emplace_back(1, c);
            }
            inWord = false;
            continue;
        }
        const bool afterLower = i > 0 && isLetter(name[i - 1]) && !isUpper(name[i - 1]);
        const bool beforeLower =
            i + 1 < name.size() && isLetter(name[i + 1]) && !isUpper(name[i + 1]);
        if (!inWord || (isUpper(c) && (afterLower || beforeLower)) || beginsShortArm(name, i))
            result.emplace_back();
        result.back() += lower(c);
        inWord = true;
    }
    return result;
}

} // namespace

bool isNumber(const std::string& word) {
    for (const char c : word)
        if (!isDigit(c)) return false;
    return !word.empty();
}

bool isPivot(const std::string& name) {
    return name.find("$AssimpFbx$") != std::string::npos;
}

std::string plainName(const std::string& name) {
    std::string result;
    for (const char c : withoutNamespace(name, ":|"))
        if (isLetter(c) || isDigit(c) || isBeyondAscii(c)) result += lower(c);
    return result;
}

std::vector<std::string> nameWords(const std::string& name) {
    if (name.size() > kLongestName || isPivot(name)) return {};
    return wordsOf(withoutNote(withoutNamespace(withoutCodes(name), ":|/")));
}

std::string bareName(const std::string& name) {
    static const std::set<std::string> kSides = {"l", "r", "left", "right"};
    static const std::set<std::string> kPrefixes = {"bip", "mixamorig", "def", "org"};
    std::string bare;
    bool afterPrefix = false;
    for (const std::string& word : wordsOf(withoutNamespace(name, ":|"))) {
        if (bare.empty() && kPrefixes.count(word)) {
            afterPrefix = true;
            continue;
        }
        if (afterPrefix && isDigit(word[0]) && bare.empty()) continue; // Bip01
        if (!kSides.count(word)) bare += word;
    }
    for (const std::string side : {"left", "right"}) // all in lower case: "lefthand"
        if (bare.compare(0, side.size(), side) == 0) bare.erase(0, side.size());
    return bare;
}

bool nameContains(const std::string& name, const char* part) {
    std::string lowered = name;
    for (char& c : lowered) c = lower(c);
    return lowered.find(part) != std::string::npos;
}

} // namespace osgSkin
