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
    kTiffSamples = 277
};
constexpr std::uint32_t kTiffShort = 3, kTiffLong = 4, kTiffPalette = 3;

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

    /// The largest that stands there by the tag: files may have several.
    std::uint64_t value(TiffTag tag, std::uint64_t otherwise) const {
        std::uint64_t found = 0;
        for (std::uint64_t i = 0; i < _count; ++i) {
            const std::uint64_t at = _begin + 2 + 12 * i;
            if (number(at, 2) == tag) found = std::max(found, valueAt(at));
        }
        return found > 0 ? found : otherwise;
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
    bytes.require(directory.value(kTiffPhotometric, 0) != kTiffPalette ||
                      (samples == 1 && bits == 8),
                  "a TIFF picture with more colours than its table");
    size.bytesPerPixel = std::max<std::uint64_t>(samples * bits / 8, 4);
    return size;
}

} // namespace osgSkin
