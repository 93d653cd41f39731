// SPDX-License-Identifier: MIT
#include "pictures/pixels/GifPixels.h"

#include <gif_lib.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

extern "C" int readGif(GifFileType* gif, GifByteType* to, int length) {
    auto& rest = *static_cast<std::string_view*>(gif->UserData);
    const std::size_t taken = std::min(rest.size(), static_cast<std::size_t>(length));
    std::memcpy(to, rest.data(), taken);
    rest.remove_prefix(taken);
    return static_cast<int>(taken);
}

struct CloseGif {
    void operator()(GifFileType* gif) const { DGifCloseFile(gif, nullptr); }
};

class GifReader {
public:
    explicit GifReader(const PictureBytes& bytes)
        : _bytes(bytes), _rest(bytes.all()), _gif(DGifOpen(&_rest, readGif, &_error)) {
        if (_gif == nullptr) refuse(_error);
        _line.resize(static_cast<std::size_t>(_gif->SWidth));
    }

    void readThrough() {
        for (;;) {
            GifRecordType record = UNDEFINED_RECORD_TYPE;
            take(DGifGetRecordType(_gif.get(), &record));
            if (record == TERMINATE_RECORD_TYPE) return;
            if (record == IMAGE_DESC_RECORD_TYPE) readFrame();
            if (record == EXTENSION_RECORD_TYPE) readExtension();
        }
    }

private:
    void readFrame() {
        take(DGifGetImageDesc(_gif.get()));
        const GifImageDesc& frame = _gif->Image;
        _bytes.require(frame.Left + frame.Width <= _gif->SWidth &&
                           frame.Top + frame.Height <= _gif->SHeight,
                       "a GIF picture with a frame that is not within it");
        for (int y = 0; y < frame.Height; ++y)
            take(DGifGetLine(_gif.get(), _line.data(), frame.Width));
    }

    void readExtension() {
        int kind = 0;
        GifByteType* block = nullptr;
        take(DGifGetExtension(_gif.get(), &kind, &block));
        while (block != nullptr) take(DGifGetExtensionNext(_gif.get(), &block));
    }

    void take(int result) const {
        if (result == GIF_ERROR) refuse(_gif->Error);
    }
    [[noreturn]] void refuse(int error) const {
        const char* const reason = GifErrorString(error);
        _bytes.fail("a GIF picture whose pixels cannot be unpacked: " +
                    std::string(reason != nullptr ? reason : "no reason is told"));
    }

    const PictureBytes& _bytes;
    std::string_view _rest;
    int _error = 0;
    const std::unique_ptr<GifFileType, CloseGif> _gif;
    std::vector<GifPixelType> _line;
};

} // namespace

void unpackGif(const PictureBytes& bytes) {
    GifReader(bytes).readThrough();
}

} // namespace osgSkin
