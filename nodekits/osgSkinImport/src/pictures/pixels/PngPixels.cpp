// SPDX-License-Identifier: MIT
#include "pictures/pixels/PngPixels.h"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

/// What libpng reads, and why it refused it.
struct PngFile {
    std::string_view rest;
    std::string reason;
};

extern "C" {
void readPng(png_structp png, png_bytep to, std::size_t length) {
    auto& file = *static_cast<PngFile*>(png_get_io_ptr(png));
    if (length > file.rest.size()) png_error(png, "the file ends");
    std::memcpy(to, file.rest.data(), length);
    file.rest.remove_prefix(length);
}

void refusePng(png_structp png, png_const_charp reason) {
    static_cast<PngFile*>(png_get_error_ptr(png))->reason = reason;
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}
}

class PngReader {
public:
    explicit PngReader(PngFile& file)
        : _png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &file, refusePng, ignoreWarning)) {
        if (_png == nullptr) return;
        _info = png_create_info_struct(_png);
        _end = png_create_info_struct(_png);
        png_set_read_fn(_png, &file, readPng);
    }
    ~PngReader() { png_destroy_read_struct(&_png, &_info, &_end); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    /// \return the bytes of a row; 0 where libpng refuses the picture
    std::size_t begin() {
        if (_end == nullptr || setjmp(png_jmpbuf(_png)) != 0) return 0;
        png_read_info(_png, _info);
        _passes = png_set_interlace_handling(_png);
        png_read_update_info(_png, _info);
        return png_get_rowbytes(_png, _info);
    }

    /// \return whether libpng has taken the picture to its end
    bool readThrough(std::vector<png_byte>& row) {
        if (setjmp(png_jmpbuf(_png)) != 0) return false;
        const png_uint_32 height = png_get_image_height(_png, _info);
        for (int pass = 0; pass < _passes; ++pass)
            for (png_uint_32 y = 0; y < height; ++y) png_read_row(_png, row.data(), nullptr);
        png_read_end(_png, _end);
        return true;
    }

private:
    png_structp _png;
    png_infop _info = nullptr;
    png_infop _end = nullptr;
    int _passes = 1;
};

} // namespace

void unpackPng(const PictureBytes& bytes) {
    PngFile file{bytes.all(), {}};
    PngReader reader(file);
    std::vector<png_byte> row(reader.begin());
    if (row.empty() || !reader.readThrough(row))
        bytes.fail("a PNG picture whose pixels cannot be unpacked: " + file.reason);
}

} // namespace osgSkin
