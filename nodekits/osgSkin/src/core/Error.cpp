// SPDX-License-Identifier: MIT
#include <osgSkin/Error>

namespace osgSkin {

std::string onOneLine(std::string text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        // U+0080 to U+009F, two bytes of UTF-8, are control characters, too.
        if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0)
            text[i] = text[i + 1] = ' ';
        else if (byte < 0x20 || byte == 0x7f)
            text[i] = ' ';
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

Error::Error(const std::string& message) : std::runtime_error(onOneLine(message)) {}

// Defined here, so that the type can be caught across shared libraries.
Error::~Error() = default;

} // namespace osgSkin
