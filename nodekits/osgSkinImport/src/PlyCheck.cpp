// SPDX-License-Identifier: MIT
#include "PlyCheck.h"

#include "FileText.h"

#include <cstddef>
#include <sstream>

namespace osgSkin {

void checkPly(const std::string& path, const std::string& text) {
    const std::string mark = "\nend_header";
    const std::size_t end = text.find(mark);
    const std::size_t after = end == std::string::npos ? end : end + mark.size();
    if (after == std::string::npos || after >= text.size() ||
        (text[after] != '\n' && text[after] != '\r'))
        failFile(path, "the header has no end, expected a line \"end_header\"");

    std::istringstream header(text.substr(0, end));
    std::string line;
    for (std::size_t number = 1; std::getline(header, line); ++number) {
        std::istringstream words(line);
        std::string keyword;
        std::string name;
        std::string count;
        words >> keyword >> name >> count;
        if (keyword != "element") continue;
        double value = 0.0;
        const bool isNumber = parseNumber(count, value);
        // Each element takes a byte at least.
        if (!isNumber || !(value >= 0.0 && value <= static_cast<double>(text.size() - after)))
            failLine(path, number,
                     quoted(count) + " elements, expected no more than the file has room for");
    }
}

} // namespace osgSkin
