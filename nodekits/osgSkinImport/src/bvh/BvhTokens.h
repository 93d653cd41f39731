// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BVHTOKENS_H
#define OSGSKINIMPORT_BVHTOKENS_H 1

#include <cstddef>
#include <string>
#include <string_view>

namespace osgSkin {

/// Splits the text of a BVH file into words, and knows the line of each. Blanks, tabs and line ends
/// of any system part words, and so do braces. A byte order mark is passed over.
class BvhTokens {
public:
    /// \param path of the file, for errors; must outlive this object
    /// \param text of the file; must outlive this object
    BvhTokens(const std::string& path, std::string_view text);

    /// The next word; empty at the end of the file.
    std::string_view next();

    /// Reads the next word and throws unless it is `word`, whatever its case. A word of letters
    /// ends at the first other character ("Frames:2").
    void expect(std::string_view word);

    /// The name of a joint: all up to a brace or the end of the line, inner blanks included.
    std::string_view jointName();

    /// Passes over a name that need not be there, which ends as a joint's does.
    void skipName();

    /// Whether nothing follows on the line of the word read last.
    bool isAtLineEnd();

    /// Reads a finite number; `what` names it in the error.
    double number(const std::string& what);

    /// Reads a whole number from 0 to `largest`.
    std::size_t count(const std::string& what, std::size_t largest);

    /// Throws "PATH: line N: MESSAGE" for the word read last.
    [[noreturn]] void fail(const std::string& message) const;

    /// Line of the word read last, counted from 1.
    std::size_t line() const { return _line; }

private:
    void skipBlanks();
    std::string_view take(std::size_t length);

    const std::string& _path;
    std::string_view _rest;
    std::size_t _line = 1;
};

/// The word in quotes, or "the end of the file" where it is empty.
std::string described(std::string_view word);

/// Whether two words are the same but for capitals.
bool isSameWord(std::string_view a, std::string_view b);

/// Reads `word` as a number that single precision holds, which is what osgAnimation keeps.
/// \param[out] value the number, where it is one
/// \return what was expected; null where the word is such a number
const char* parseFinite(std::string_view word, double& value);

} // namespace osgSkin

#endif
