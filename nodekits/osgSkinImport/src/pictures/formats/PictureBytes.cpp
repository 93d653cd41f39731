// SPDX-License-Identifier: MIT
#include "pictures/formats/PictureBytes.h"

#include "text/FileText.h"

namespace osgSkin {

void PictureBytes::fail(const std::string& reason) const {
    failFile(_name, reason);
}

void PictureBytes::requireSize(std::uint64_t bytes) const {
    if (bytes > size())
        fail("a picture of " + std::to_string(size()) + " bytes, expected at least " +
             std::to_string(bytes));
}

std::uint32_t PictureBytes::little(std::uint64_t at, unsigned count) const {
    requireSize(at + count);
    std::uint32_t result = 0;
    for (unsigned i = count; i-- > 0;)
        result = result << 8 | static_cast<unsigned char>(_bytes[at + i]);
    return result;
}

std::uint32_t PictureBytes::big(std::uint64_t at, unsigned count) const {
    requireSize(at + count);
    std::uint32_t result = 0;
    for (unsigned i = 0; i < count; ++i)
        result = result << 8 | static_cast<unsigned char>(_bytes[at + i]);
    return result;
}

} // namespace osgSkin
