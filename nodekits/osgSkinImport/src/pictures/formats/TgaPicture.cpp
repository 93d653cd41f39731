// SPDX-License-Identifier: MIT
#include "pictures/formats/TgaPicture.h"

#include <algorithm>

namespace osgSkin {
namespace {

enum TgaKind : std::uint32_t { kTgaMapped = 1, kTgaColours = 2, kTgaGrey = 3, kTgaPacked = 8 };

/// The pixels as they stand in the file: that they all do, and name colours that there are.
class TgaPixels {
public:
    /// \param colours in the table that pixels name one of; 0: they name none
    TgaPixels(const PictureBytes& bytes, std::uint64_t at, std::uint64_t pixelBytes,
              std::uint64_t colours)
        : _bytes(bytes), _at(at), _pixelBytes(pixelBytes), _colours(colours) {}

    void take(std::uint64_t count) {
        _bytes.requireSize(_at + count * _pixelBytes);
        if (_colours > 0)
            for (std::uint64_t i = 0; i < count; ++i)
                _bytes.require(_bytes.byte(_at + i) < _colours,
                               "a TGA picture with more colours than its table");
        _at += count * _pixelBytes;
    }
    void takePacked(std::uint64_t count) {
        while (count > 0) {
            const std::uint32_t code = _bytes.byte(_at++);
            const std::uint64_t run = std::min<std::uint64_t>((code & 127) + 1, count);
            take((code & 128) != 0 ? 1 : run);
            count -= run;
        }
    }

private:
    const PictureBytes& _bytes;
    std::uint64_t _at, _pixelBytes, _colours;
};

} // namespace

PictureSize tgaSize(const PictureBytes& bytes) {
    PictureSize size;
    size.width = bytes.little(12, 2);
    size.height = bytes.little(14, 2);
    const std::uint32_t kind = bytes.byte(2) & ~kTgaPacked, bits = bytes.byte(16);
    const bool hasTable = bytes.byte(1) == 1;
    const std::uint64_t colours = hasTable ? bytes.little(5, 2) : 0, colourBits = bytes.byte(7);
    // The reader goes by a table that nothing names a colour of, too.
    bytes.require(!hasTable || colourBits == 15 || colourBits == 16 || colourBits == 24 ||
                      colourBits == 32,
                  "a TGA picture whose table has colours of an unknown length");
    const bool mapped = kind == kTgaMapped && bits == 8 && hasTable && colours > 0;
    bytes.require(bytes.byte(2) <= (kTgaPacked | kTgaGrey) &&
                      (mapped ||
                       (kind == kTgaColours && (bits == 16 || bits == 24 || bits == 32)) ||
                       (kind == kTgaGrey && (bits == 8 || bits == 16))),
                  "no TGA picture of a known kind");
    const std::uint64_t tableBytes = colours * ((colourBits + 7) / 8);
    TgaPixels pixels(bytes, 18 + bytes.byte(0) + tableBytes, bits / 8, mapped ? colours : 0);
    const std::uint64_t count = size.width * size.height;
    (bytes.byte(2) & kTgaPacked) != 0 ? pixels.takePacked(count) : pixels.take(count);
    return size;
}

} // namespace osgSkin
