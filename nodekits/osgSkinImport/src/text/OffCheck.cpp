// SPDX-License-Identifier: MIT
#include "text/OffCheck.h"

#include "text/FileText.h"

#include <sstream>

namespace osgSkin {

void checkOff(const std::string& path, const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    int found = 0;
    while (found < 2 && std::getline(lines, line)) {
        std::istringstream words(line.substr(0, line.find('#')));
        for (std::string word; found < 2 && words >> word;) {
            double count = 0.0;
            if (!parseNumber(word, count)) {
                // Assimp reads the digits that a word begins with.
                if (word.find_first_of("0123456789+-") == 0 && word != "4OFF")
                    failFile(path, inQuotes(word) + ", expected a number of vertices or faces");
                continue; // OFF, STOFF, 4OFF, ...
            }
            // Each vertex and each face takes a few characters.
            if (!(count >= 0.0 && count <= double(text.size())))
                failFile(path, inQuotes(word) + (found == 0 ? " vertices" : " faces") +
                                   ", expected no more than the file has room for");
            ++found;
        }
    }
}

} // namespace osgSkin
