// SPDX-License-Identifier: MIT
#include "pictures/formats/WebPicture.h"

#include <algorithm>

namespace osgSkin {
namespace {

enum Marker : std::uint32_t {
    kFirstFrame = 0xc0,
    kHuffmanTables = 0xc4,
    kReserved = 0xc8,
    kArithmeticTables = 0xcc,
    kLastFrame = 0xcf,
    kFirstRestart = 0xd0,
    kLastRestart = 0xd7,
    kPictureStart = 0xd8,
    kPictureEnd = 0xd9,
    kScan = 0xda,
    kLines = 0xdc, ///< how many there are
    kFirstApplication = 0xe0,
    kLastApplication = 0xef,
    kComment = 0xfe
};

constexpr std::uint64_t kPngChunks = 8, kPngHeader = 33;

/// libpng unpacks each text to at most so much; zlib packs at most so well.
constexpr std::uint64_t kLongestText = 8000000, kBestPacking = 1032;
/// What the packed texts of a picture may be together, when they are unpacked.
constexpr std::uint64_t kMostText = 64000000;

/// A progressive picture is gone through for each of its scans; they have about ten. More of them
/// count as more pictures.
constexpr std::uint64_t kUsualScans = 16;

bool isFrame(std::uint32_t marker) {
    return marker >= kFirstFrame && marker <= kLastFrame && marker != kHuffmanTables &&
           marker != kReserved && marker != kArithmeticTables;
}

bool isProgressive(std::uint32_t frame) {
    return frame % 4 == 2;
}

/// Whether libjpeg passes over it behind a scan.
bool isPassedOver(std::uint32_t marker) {
    return marker == kLines || marker == kComment ||
           (marker >= kFirstApplication && marker <= kLastApplication);
}

/// The most that libpng makes of a chunk's packed text; 0 of other chunks.
std::uint64_t packedText(std::string_view chunk, std::string_view content) {
    bool isPacked = chunk == "zTXt" || chunk == "iCCP";
    if (chunk == "iTXt") {
        const std::size_t flag = content.find('\0');
        isPacked = flag != std::string_view::npos && flag + 1 < content.size() &&
                   content[flag + 1] != '\0';
    }
    return isPacked ? std::min<std::uint64_t>(kLongestText, kBestPacking * content.size()) : 0;
}

/// Where the next marker begins, behind what stands between two; the size where there is none.
std::uint64_t nextMarker(const PictureBytes& bytes, std::uint64_t at) {
    for (;; ++at) {
        const std::size_t found = bytes.all().find('\xff', at);
        if (found == std::string_view::npos || found + 1 >= bytes.size()) return bytes.size();
        at = found;
        const std::uint32_t marker = bytes.byte(at + 1);
        if (marker > 1 && marker != 0xff && (marker < kFirstRestart || marker > kLastRestart))
            return at;
    }
}

} // namespace

PictureSize pngSize(const PictureBytes& bytes) {
    bytes.require(bytes.startsWith("\x89PNG\r\n\x1a\n"), "no PNG picture");
    bytes.requireSize(kPngHeader);
    bytes.require(bytes.all().substr(12, 4) == "IHDR",
                  "a PNG picture that begins without a header");
    // OpenSceneGraph's reader goes on beyond the file's end with what it read before.
    std::uint64_t text = 0;
    for (std::uint64_t at = kPngChunks; at < bytes.size();) {
        const std::uint64_t length = bytes.big(at, 4);
        bytes.requireSize(at + 12 + length);
        const std::string_view chunk = bytes.all().substr(at + 4, 4);
        if (chunk == "IEND") break;
        text += packedText(chunk, bytes.all().substr(at + 8, length));
        at += 12 + length;
    }
    bytes.require(text <= kMostText,
                  "a PNG picture with packed texts that may unpack to more than 64 MB");
    PictureSize size;
    size.width = bytes.big(16, 4);
    size.height = bytes.big(20, 4);
    size.bytesPerPixel = bytes.byte(24) > 8 ? 8 : 4;
    return size;
}

PictureSize jpegSize(const PictureBytes& bytes) {
    bytes.require(bytes.startsWith("\xff\xd8"), "no JPEG picture");
    PictureSize size;
    std::uint64_t scans = 0;
    std::uint32_t frame = 0, components = 0;
    bool isWhole = false; // what is behind the only scan that there can be
    for (std::uint64_t at = nextMarker(bytes, 2); at < bytes.size();) {
        const std::uint32_t marker = bytes.byte(at + 1);
        if (marker == kPictureEnd) break;
        // OpenSceneGraph's reader loses the pixels where libjpeg refuses what comes behind them.
        bytes.require(!isWhole || isPassedOver(marker),
                      "a JPEG picture that goes on behind its last scan");
        bytes.require(marker != kPictureStart && (frame == 0 || !isFrame(marker)),
                      "a JPEG picture that begins twice");
        if (isFrame(marker)) {
            frame = marker;
            components = bytes.byte(at + 9);
            size.height = bytes.big(at + 5, 2);
            size.width = bytes.big(at + 7, 2);
        }
        if (marker == kScan) {
            ++scans;
            isWhole = scans == 1 && !isProgressive(frame) && bytes.byte(at + 4) == components;
        }
        at = nextMarker(bytes, at + 2 + bytes.big(at + 2, 2));
    }
    size.images = 1 + scans / kUsualScans;
    return size;
}

} // namespace osgSkin
