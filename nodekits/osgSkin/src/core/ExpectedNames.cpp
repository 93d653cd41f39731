// SPDX-License-Identifier: MIT
#include <osgSkin/ExpectedNames>

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace osgSkin {
namespace {

/// Names beyond this length come from no keyboard, and are not compared.
constexpr std::size_t kMaxLength = 64;

/// Lists of known names are cut at about this many bytes.
constexpr std::size_t kMaxList = 3000;

std::string lowerCase(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// A name without its prefix: "head" of "mixamorig:head".
std::string withoutPrefix(const std::string& name) {
    return name.substr(name.find_last_of(":|") + 1); // from 0 if there is none
}

/// The number of letters to insert, delete or replace, or neighbours to swap.
std::size_t editsBetween(const std::string& a, const std::string& b) {
    std::vector<std::vector<std::size_t>> edits(a.size() + 1,
                                                std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                edits[i][j] = i + j;
                continue;
            }
            edits[i][j] = std::min({edits[i - 1][j] + 1, edits[i][j - 1] + 1,
                                    edits[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
        }
    return edits[a.size()][b.size()];
}

} // namespace

std::vector<std::size_t> clipsMeant(const std::string& word,
                                    const std::vector<std::string>& known) {
    const auto exact = std::find(known.begin(), known.end(), word);
    if (exact != known.end()) return {static_cast<std::size_t>(exact - known.begin())};
    std::vector<std::size_t> result;
    for (std::size_t n = 0; n < known.size(); ++n) {
        const std::size_t bar = known[n].rfind('|');
        if (bar == std::string::npos) continue;
        const std::string clip = known[n].substr(bar + 1);
        if (clip == word || clip == word + '_' + known[n].substr(0, bar)) result.push_back(n);
    }
    return result;
}

std::string nearestName(const std::string& word, const std::vector<std::string>& known) {
    if (word.empty() || word.size() > kMaxLength) return {};
    const std::string wanted = lowerCase(word);
    std::string nearest;
    std::size_t fewest = 3;
    for (const std::string& name : known) {
        if (name.empty() || name.size() > kMaxLength) continue;
        const std::string candidate = lowerCase(name);
        const std::string bare = withoutPrefix(candidate);
        const bool isSame = !bare.empty() && bare == withoutPrefix(wanted);
        const std::size_t edits = isSame ? 0 : editsBetween(candidate, wanted);
        if (edits < fewest && edits <= (candidate.size() < 6 ? 1u : 2u)) {
            fewest = edits;
            nearest = name;
        }
    }
    return nearest;
}

std::string expectedNames(const std::string& word, const std::vector<std::string>& known) {
    std::string text;
    for (const std::string& name : known) {
        if (text.size() + name.size() > kMaxList) {
            text += ", ... (" + std::to_string(known.size()) + " in all)";
            break;
        }
        text += (text.empty() ? ", expected one of \"" : ", \"") + name + '"';
    }
    const std::string nearest = nearestName(word, known);
    return nearest.empty() ? text : text + "; did you mean \"" + nearest + "\"?";
}

} // namespace osgSkin
