// SPDX-License-Identifier: MIT
#include "pictures/formats/TiffPicture.h"

#include <algorithm>

namespace osgSkin {
namespace {

enum TiffTag : std::uint32_t {
    kTiffWidth = 256,
    kTiffHeight,
    kTiffBits,
    kTiffPhotometric = 262,
    kTiffSamples = 277,
    kTiffPlanes = 284
};
constexpr std::uint32_t kTiffShort = 3, kTiffLong = 4, kTiffColours = 2, kTiffPalette = 3,
                        kTiffApart = 2;

/// The first directory of a TIFF file, which is all that OpenSceneGraph reads.
class TiffDirectory {
public:
    explicit TiffDirectory(const PictureBytes& bytes)
        : _bytes(bytes), _little(bytes.startsWith(std::string_view("II*\0", 4))) {
        bytes.require(_little || bytes.startsWith(std::string_view("MM\0*", 4)),
                      "no TIFF picture of a known kind");
        _begin = number(4, 4);
        _count = number(_begin, 2);
    }

    /// What stands there by the tag; by the first of several, as libtiff goes.
    std::uint64_t value(TiffTag tag, std::uint64_t otherwise) const {
        for (std::uint64_t i = 0; i < _count; ++i) {
            const std::uint64_t at = _begin + 2 + 12 * i;
            if (number(at, 2) == tag) return valueAt(at);
        }
        return otherwise;
    }

private:
    std::uint32_t number(std::uint64_t at, unsigned count) const {
        return _little ? _bytes.little(at, count) : _bytes.big(at, count);
    }
    std::uint64_t valueAt(std::uint64_t at) const {
        const std::uint32_t type = number(at + 2, 2), count = number(at + 4, 4);
        if (type == kTiffLong) return number(count > 1 ? number(at + 8, 4) : at + 8, 4);
        _bytes.require(type == kTiffShort, "a TIFF picture with a size of an unknown kind");
        return number(count > 2 ? number(at + 8, 4) : at + 8, 2);
    }

    const PictureBytes& _bytes;
    bool _little;
    std::uint64_t _begin = 0, _count = 0;
};

} // namespace

PictureSize tiffSize(const PictureBytes& bytes) {
    const TiffDirectory directory(bytes);
    PictureSize size;
    size.width = directory.value(kTiffWidth, 0);
    size.height = directory.value(kTiffHeight, 0);
    const std::uint64_t samples = directory.value(kTiffSamples, 1),
                        bits = directory.value(kTiffBits, 1);
    bytes.require(samples <= 4 && (bits == 8 || bits == 16 || bits == 32),
                  "a TIFF picture with pixels of an unknown kind");
    const std::uint64_t photometric = directory.value(kTiffPhotometric, 0);
    bytes.require(photometric != kTiffPalette || (samples == 1 && bits == 8),
                  "a TIFF picture with more colours than its table");
    // Of planes apart the reader has a row of one, and goes on as if it had one of all.
    bytes.require(directory.value(kTiffPlanes, 1) != kTiffApart || samples == 1 ||
                      (photometric == kTiffColours && samples >= 3),
                  "a TIFF picture with planes apart that are no colours");
    size.bytesPerPixel = std::max<std::uint64_t>(samples * bits / 8, 4);
    return size;
}

} // namespace osgSkin
