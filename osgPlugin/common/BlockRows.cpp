// SPDX-License-Identifier: MIT
#include "BlockRows.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <cstddef>
#include <string>

namespace {

// Maximum number of words in a row. Each row starts with its length; an empty row ends the block.
// There is no total length, because a damaged file could make us allocate any amount of memory.
constexpr unsigned int kTextRow = 16, kRow = 4096;

} // namespace

void writeWords(osgDB::OutputStream& os, const std::vector<std::uint32_t>& words) {
    os << os.BEGIN_BRACKET << std::endl;
    const std::size_t row = os.isBinary() ? kRow : kTextRow;
    for (std::size_t first = 0; first < words.size(); first += row) {
        const std::size_t end = std::min(words.size(), first + row);
        os << static_cast<unsigned int>(end - first);
        if (os.isBinary())
            os.writeCharArray(reinterpret_cast<const char*>(&words[first]),
                              static_cast<unsigned int>((end - first) * sizeof words[0]));
        else
            for (std::size_t i = first; i < end; ++i) os << static_cast<unsigned int>(words[i]);
        os << std::endl;
    }
    os << 0u << std::endl << os.END_BRACKET << std::endl;
}

bool readWords(osgDB::InputStream& is, std::vector<std::uint32_t>& words) {
    is >> is.BEGIN_BRACKET;
    for (;;) {
        unsigned int length = 0;
        is >> length;
        if (is.getException()) return false;
        if (length == 0) break;
        if (length > kRow) {
            is.throwException("osgSkin: a block has a row of " + std::to_string(length) +
                              " words, expected at most " + std::to_string(kRow));
            return false;
        }
        const std::size_t before = words.size();
        words.resize(before + length);
        if (is.isBinary())
            is.readComponentArray(reinterpret_cast<char*>(&words[before]), length, 1,
                                  sizeof words[0]);
        else
            for (std::size_t i = before; i < words.size(); ++i) is >> words[i];
    }
    is >> is.END_BRACKET;
    return !is.getException();
}
