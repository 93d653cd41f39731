// SPDX-License-Identifier: MIT
#include "PlyCheck.h"

#include "FileText.h"

#include <cstddef>

namespace osgSkin {

void checkPly(const std::string& path, const std::string& text) {
    const std::string word = "end_header";
    const std::size_t end = text.find("\n" + word);
    const std::size_t after = end == std::string::npos ? end : end + 1 + word.size();
    if (after == std::string::npos || after >= text.size() ||
        (text[after] != '\n' && text[after] != '\r'))
        failFile(path, "the header has no end, expected a line \"end_header\"");
}

} // namespace osgSkin
