// SPDX-License-Identifier: MIT
// Pictures that OpenSceneGraph's readers would follow beyond their ends, or for ever.
#include "GltfBuilder.h"
#include "PictureFiles.h"

#include <osgSkinImport/ReadScene>

namespace {

using std::string_literals::operator""s;
using test::big;
using test::Drawn;
using test::drawnWith;
using test::expectRefused;
using test::little;
using test::savePicture;
using test::with;
using test::written;

/// A TGA picture of 5 x 3 pixels.
/// \param kind 1: by a table of two colours, 2: by colours; 8 more: packed
std::string tga(int kind, const std::string& pixels) {
    const bool mapped = (kind & 7) == 1;
    return little(0, 1) + little(mapped ? 1 : 0, 1) + little(std::uint32_t(kind), 1) +
           little(0, 2) + little(mapped ? 2 : 0, 2) + little(mapped ? 24 : 0, 1) + little(0, 4) +
           little(5, 2) + little(3, 2) + little(mapped ? 8 : 24, 1) + little(0, 1) +
           (mapped ? "\x01\x02\x03\x04\x05\x06" : "") + pixels;
}

/// A TGA picture of 5 x 3 packed colours with a table, of which it uses none.
std::string tgaWithTable(std::uint32_t colours, std::uint32_t bits, std::size_t tableBytes) {
    const std::string row = "\x84"
                            "abc";
    const std::string header = with(with(tga(10, {}), 1, "\1"), 5, little(colours, 2));
    return with(header, 7, little(bits, 1)) + std::string(tableBytes, '\x7f') + row + row + row +
           std::string(26, '\0');
}

/// An SGI picture of 5 x 3 grey pixels, each row packed.
std::string sgi(const std::string& row) {
    std::string text = "\x01\xda\x01\x01"s + big(2, 2) + big(5, 2) + big(3, 2) + big(1, 2);
    text.resize(512, '\0');
    for (int y = 0; y < 3; ++y) text += big(512 + 24, 4);
    for (int y = 0; y < 3; ++y) text += big(std::uint32_t(row.size()), 4);
    return text + row;
}

/// A BMP picture of 5 x 3 pixels with two colours of sixteen.
std::string bmp(const std::string& row) {
    std::string text = "BM" + little(0, 8) + little(62, 4) + little(40, 4) + little(5, 4) +
                       little(3, 4) + little(1, 2) + little(4, 2) + little(0, 4 * 4) +
                       little(2, 4) + little(0, 4) + "\x01\x02\x03\x04\x05\x06\x07\x08";
    return text + row + row + row;
}

/// A GIF picture of one size, its frames of one pixel each.
std::string gif(std::uint32_t width, std::uint32_t height, std::size_t frames,
                const std::string& extension = {}) {
    std::string text = "GIF89a" + little(width, 2) + little(height, 2) + "\x80\0\0"s + "abcdef";
    text += extension;
    for (std::size_t i = 0; i < frames; ++i)
        text += "," + little(0, 4) + little(1, 2) + little(1, 2) + "\0\x02\x02\x44\x01\0"s;
    return text + ";";
}

/// A JPEG file's beginning and so many scans.
std::string jpeg(std::uint32_t side, std::size_t scans) {
    std::string text = "\xff\xd8\xff\xc2"s + big(11, 2) + "\x08"s + big(side, 2) + big(side, 2) +
                       "\x01\x01\x11\0"s;
    for (std::size_t i = 0; i < scans; ++i)
        text += "\xff\xda"s + big(8, 2) + "\x01\x01\0\0\0\0"s + "\x55\xff\0\x55"s;
    return text + "\xff\xd9";
}

std::string tiffEntry(std::uint32_t tag, std::uint32_t value) {
    return little(tag, 2) + little(4, 2) + little(1, 4) + little(value, 4);
}

std::string tiff(std::uint32_t width, std::uint32_t samples, std::uint32_t photometric) {
    const auto entry = tiffEntry;
    return "II*\0"s + little(8, 4) + little(5, 2) + entry(256, width) + entry(257, 60000) +
           entry(258, 8) + entry(262, photometric) + entry(277, samples) + little(0, 4);
}

/// A TIFF picture of 5 x 3 samples of eight bits, each row and plane for itself, with more tags at
/// its end.
std::string tiffOfPlanes(std::uint32_t samples, std::uint32_t photometric, std::uint32_t planes,
                         const std::string& more = {}) {
    const std::uint32_t tags = std::uint32_t(10 + more.size() / 12), rows = 3 * samples;
    const std::uint32_t lists = 8 + 2 + 12 * tags + 4, pixels = lists + 4 * 2 * rows;
    const auto list = [&](std::uint32_t tag, std::uint32_t at) {
        return little(tag, 2) + little(4, 2) + little(rows, 4) + little(at, 4);
    };
    std::string text = "II*\0"s + little(8, 4) + little(tags, 2) + tiffEntry(256, 5) +
                       tiffEntry(257, 3) +
                       (little(258, 2) + little(3, 2) + little(1, 4) + little(8, 4)) +
                       tiffEntry(259, 1) + tiffEntry(262, photometric) + list(273, lists) +
                       tiffEntry(277, samples) + tiffEntry(278, 1) + list(279, lists + 4 * rows) +
                       tiffEntry(284, planes) + more + little(0, 4);
    for (std::uint32_t row = 0; row < rows; ++row) text += little(pixels + 5 * row, 4);
    for (std::uint32_t row = 0; row < rows; ++row) text += little(5, 4);
    return text + std::string(std::size_t(5) * rows, 'p');
}

std::string dds(std::uint32_t width, std::uint32_t height) {
    std::string text = "DDS " + little(124, 4) + little(0x1007, 4) + little(height, 4) +
                       little(width, 4) + little(0, 14 * 4) + little(32, 4) + little(4, 4) + "DXT1";
    text.resize(128, '\0');
    return text + "12345678";
}

} // namespace

TEST(Pictures, OfEachFormatAreDrawn) {
    for (const char* extension :
         {"png", "jpg", "jpeg", "bmp", "rgb", "ppm", "tif", "tiff", "dds"}) {
        const std::string content = written(extension);
        if (content.empty()) continue; // no such writer
        const std::string name = std::string("whole.") + extension;
        savePicture(name, content);
        const Drawn drawn = drawnWith(name);
        ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
        EXPECT_EQ(drawn.image->s(), 5) << extension;
        EXPECT_EQ(drawn.image->t(), 3) << extension;
    }
    const std::string colours(45, 'c');
    const std::pair<const char*, std::string> others[] = {
        {"plain.tga", tga(2, colours)},
        {"packed.tga", tga(10, "\x84"
                               "abc\x84"
                               "abc\x84"
                               "abc")},
        {"mapped.tga", tga(1, std::string(15, '\1'))},
        {"packed.sgi", sgi("\x05z\0"s)},
        {"table.bmp", bmp("\x10\x01\x10\0"s)},
        {"one.gif", gif(5, 3, 1)}};
    for (const auto& [name, content] : others) {
        savePicture(name, content);
        const Drawn drawn = drawnWith(name);
        ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
        EXPECT_EQ(drawn.image->s(), 5) << name;
    }
}

TEST(Pictures, AreAsLargeAsTheirFilesAreWorth) {
    const std::string png = with(written("png"), 16, big(40000, 4) + big(40000, 4));
    expectRefused("large.png", png, "a picture of 40000 x 40000 pixels, expected at most 1677");
    expectRefused("none.png", with(png, 16, big(0, 4)), "of 0 x 40000 pixels, expected 1 to 65536");
    expectRefused("large.jpg", jpeg(60000, 1), "60000 x 60000 pixels, expected at most");
    expectRefused("scans.jpg", jpeg(4000, 3000), "4000 x 4000 pixels, 188 times");
    expectRefused("frames.gif", gif(3000, 3000, 200), "3000 x 3000 pixels, 202 times");
    expectRefused("large.tif", tiff(60000, 4, 2), "60000 x 60000 pixels, expected at most");
    expectRefused("large.ppm", "P3\n60000 60000\n255\n1 2 3\n", "60000 x 60000 pixels");
    expectRefused("long.ppm", "P3\n# wide\n600000 2\n255\n", "a PNM picture without a size");
    expectRefused("large.dds", dds(8000, 8000), "expected at least 32000000");
    expectRefused("large.bmp", with(bmp("\x10\x01\x10\0"s), 18, little(60000, 4)),
                  "expected at least");
    const std::string row(65536, 'g');
    savePicture("longest.pgm", "P5\n65536 1\n255\n" + row);
    EXPECT_TRUE(drawnWith("longest.pgm").image.valid()) << drawnWith("longest.pgm").notices;
    savePicture("highest.pgm", "P5\n1 65536\n255\n" + row);
    EXPECT_TRUE(drawnWith("highest.pgm").image.valid()) << drawnWith("highest.pgm").notices;
    expectRefused("longer.pgm", "P5\n65537 1\n255\n" + row + "g", "a PNM picture without a size");
    expectRefused("higher.pgm", "P5\n1 65537\n255\n" + row + "g", "a PNM picture without a size");
    savePicture("small.png", written("png"));
    EXPECT_TRUE(drawnWith("small.png", "maxPixels=1").image.valid());
    expectRefused("option.png", with(written("png"), 16, big(300, 4) + big(300, 4)),
                  "(option maxPixels)", "maxPixels=100");
}

/// What libjpeg refuses when the pixels are there already, OpenSceneGraph's reader loses.
TEST(Pictures, EndBehindTheirOnlyScan) {
    const std::string whole = written("jpg");
    ASSERT_GT(whole.size(), 100u);
    const auto goesOn = [&](const std::string& more) {
        return whole.substr(0, whole.size() - 2) + more + whole.substr(whole.size() - 2);
    };
    const std::string scan = whole.substr(whole.rfind("\xff\xda"));
    for (const std::string& more :
         {"\xff\x2c"s, "\xff\xff\x2c"s, "\xff\xc4\0\3\0"s, "\xff\xdb\0\3\7"s, "\xff\xc8"s,
          "\xff\xf7"s, scan.substr(0, scan.size() - 2)})
        expectRefused("more.jpg", goesOn(more), "a JPEG picture that goes on behind its last scan");
    for (const std::string& more :
         {"\xff\xfe\0\4ab"s, "\xff\xe1\0\4ab"s, "\xff\xff\xff"s, "\xff\xd0"s}) {
        savePicture("comment.jpg", goesOn(more));
        EXPECT_TRUE(drawnWith("comment.jpg").image.valid()) << drawnWith("comment.jpg").notices;
    }
    savePicture("cut.jpg", whole.substr(0, whole.size() - 2));
    EXPECT_TRUE(drawnWith("cut.jpg").image.valid()) << drawnWith("cut.jpg").notices;
}

/// OpenSceneGraph's reader loses a picture that libpng refuses half way.
TEST(Pictures, PngPixelsUnpack) {
    const std::string whole = written("png");
    const std::size_t pixels = whole.find("IDAT"), end = whole.find("IEND");
    ASSERT_LT(end, whole.size());
    for (const std::size_t at : {pixels + 4, pixels + 9, end - 12, end - 6})
        expectRefused("broken.png", with(whole, at, {static_cast<char>(whole[at] ^ 0x55)}),
                      "a PNG picture whose pixels cannot be unpacked");
    expectRefused("none.png", whole.substr(0, pixels - 4) + whole.substr(end - 4),
                  "a PNG picture whose pixels cannot be unpacked");
}

/// ... and every GIF picture behind one that giflib refuses.
TEST(Pictures, GifPixelsUnpack) {
    const std::string whole = gif(5, 3, 2);
    const std::size_t frame = whole.rfind(',');
    expectRefused("broken.gif", with(whole, frame + 12, "\xff"),
                  "a GIF picture whose pixels cannot be unpacked");
    expectRefused("wide.gif", with(whole, frame + 5, little(6, 2)),
                  "a frame that is not within it");
    expectRefused("right.gif", with(whole, frame + 1, little(5, 2)),
                  "a frame that is not within it");
    expectRefused("high.gif", with(whole, frame + 7, little(4, 2)),
                  "a frame that is not within it");
    expectRefused("few.gif", with(whole, frame + 7, little(3, 2)),
                  "a GIF picture whose pixels cannot be unpacked");
    savePicture("after.gif", gif(5, 3, 1));
    EXPECT_TRUE(drawnWith("after.gif").image.valid()) << drawnWith("after.gif").notices;
}

/// As nearly all have: how long a frame stays, a remark, how often they are shown.
TEST(Pictures, GifExtensionsAreReadOver) {
    const std::string extensions =
        "!\xf9\x04\0\0\0\0\0"s + "!\xfe\x03xyz\x02xy\0"s + "!\xff\x0bNETSCAPE2.0\x03\x01\0\0\0"s;
    savePicture("extended.gif", gif(5, 3, 1, extensions));
    EXPECT_TRUE(drawnWith("extended.gif").image.valid()) << drawnWith("extended.gif").notices;
    const std::string open = gif(5, 3, 1, "!\xfe\x03xyz"s);
    expectRefused("open.gif", open.substr(0, open.rfind("xyz") + 3), "open.gif");
}

/// A thousand texts of 8 kB can unpack to 8 GB.
TEST(Pictures, PngTextsAreFew) {
    const std::string whole = written("png");
    const std::size_t first = 33;
    const auto withTexts = [&](const std::string& chunk, const std::string& content, int count) {
        std::string texts;
        for (int i = 0; i < count; ++i)
            texts += big(std::uint32_t(content.size()), 4) + chunk + content + big(0, 4);
        return whole.substr(0, first) + texts + whole.substr(first);
    };
    const std::string packed = "key\0\0"s + std::string(8000, 'x');
    for (const std::string chunk : {"zTXt", "iCCP"})
        expectRefused("texts.png", withTexts(chunk, packed, 9), "more than 64 MB");
    expectRefused("texts.png", withTexts("iTXt", "key\0\1"s + std::string(8000, 'x'), 9),
                  "more than 64 MB");
    const std::pair<const char*, std::string> fine[] = {
        {"zTXt", packed.substr(0, 100)}, {"iTXt", packed}, {"iTXt", "key"}, {"tEXt", packed}};
    for (const auto& [chunk, content] : fine) {
        savePicture("text.png", withTexts(chunk, content, 9));
        EXPECT_TRUE(drawnWith("text.png").image.valid()) << chunk << drawnWith("text.png").notices;
    }
}

TEST(Pictures, OfAModelCountTogether) {
    // Larger than its file is worth.
    const int side = 200;
    const std::string small = written("png", side, side);
    ASSERT_LT(16 * small.size(), std::size_t(side) * side);
    std::string materials, text = "mtllib picture_many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (const std::string name : {"first", "second", "third"}) {
        savePicture("picture_" + name + ".png", small);
        materials += "newmtl " + name + "\nmap_Kd picture_" + name + ".png\n";
        text += "usemtl " + name + "\nf 1/1 2/1 3/1\n";
    }
    savePicture("picture_many.mtl", materials);
    savePicture("picture_many.obj", text);
    const auto drawn = [&](std::size_t pixels) {
        const osg::ref_ptr<osgDB::Options> words =
            new osgDB::Options("maxPixels=" + std::to_string(pixels));
        std::size_t count = 0;
        for (const osgSkin::MeshPart& part :
             osgSkin::importMesh(testing::TempDir() + "picture_many.obj", words).parts)
            if (part.geometry->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE))
                ++count;
        return count;
    };
    const std::size_t each = std::size_t(side) * side - 16 * small.size();
    EXPECT_EQ(drawn(3 * each), 3u);
    const test::Notices notices;
    EXPECT_EQ(drawn(2 * each), 2u);
    EXPECT_TRUE(notices.say("of four bytes beside those before it (option maxPixels)"))
        << notices.text();
}

TEST(Pictures, HaveWhatTheirReadersTakeForGranted) {
    expectRefused("short.tga",
                  tga(10, "\x02"
                          "abcabcabc\x8e"s),
                  "expected at least");
    expectRefused("colour.tga", tga(1, std::string(15, '\2')), "more colours than its table");
    expectRefused("kind.tga", with(tga(2, std::string(45, 'c')), 16, little(8, 1)),
                  "no TGA picture of a known kind");
    expectRefused("wide.sgi", sgi("\x06z\0"s), "a row of more pixels than it is wide");
    expectRefused("open.sgi", sgi("\x05z"s), "a row that has no end");
    expectRefused("long.sgi", with(sgi("\x05z\0"s), 512 + 12, big(1 << 20, 4)),
                  "expected at least");
    expectRefused("depth.sgi", with(sgi("\x05z\0"s), 10, big(7, 2)), "of an unknown kind");
    expectRefused("colour.bmp", bmp("\x10\x31\x10\0"s), "more colours than its table");
    for (const std::size_t row : {0u, 1u, 2u})
        expectRefused("row.bmp", with(bmp("\x10\x01\x10\0"s), 62 + 4 * row, "\x10\x31"),
                      "more colours than its table");
    expectRefused("bits.bmp", with(bmp("\x10\x01\x10\0"s), 28, little(12, 2)), "unknown length");
    expectRefused("left.bmp", with(bmp("\x10\x01\x10\0"s), 18, little(0xffffff00, 4)),
                  "of 0 x 3 pixels");
    std::string masks = with(with(bmp(std::string(12, 'x')), 28, little(16, 2)), 30, little(3, 4));
    expectRefused("masks.bmp", with(masks, 54, little(0, 8)), "whose pixels lack a colour");
    expectRefused("control.gif", gif(5, 3, 1, "!\xf9\0"s),
                  "a graphic control of less than 4 bytes");
    expectRefused("table.tiff", tiff(20, 3, 3), "more colours than its table");
    expectRefused("header.dds", with(dds(4, 4), 76, little(3, 4)), "no DDS picture");
    expectRefused("chunk.png", with(written("png"), 33, big(1 << 30, 4)),
                  "expected at least 1073741");
    expectRefused("short.png", written("png").substr(0, 8), "expected at least 33");
    expectRefused("text.png", "a text", "no PNG picture");
}

/// All rows of a picture may stand in the same place: four thousand million pixels in half a
/// megabyte.
TEST(Pictures, AreNotLookedThroughBeforeTheirSizeIs) {
    constexpr std::uint32_t side = 65535;
    std::string text = "\x01\xda\x01\x01"s + big(3, 2) + big(side, 2) + big(side, 2) + big(1, 2);
    text.resize(512, '\0');
    for (std::uint32_t y = 0; y < side; ++y) text += big(512 + 8 * side, 4);
    for (std::uint32_t y = 0; y < side; ++y) text += big(2 * side + 1, 4);
    for (std::uint32_t x = 0; x < side; ++x) text += "\x81z";
    expectRefused("rows.sgi", text + std::string(1, '\0'), "of 65535 x 65535 pixels");
}

TEST(Pictures, TgaTablesAreAsLongAsTheirReaderTakesThem) {
    // Of 300 colours of 15 bits each the reader goes over 600 bytes.
    for (const std::uint32_t bits : {15u, 16u, 24u, 32u}) {
        const std::size_t bytes = std::size_t(300) * ((bits + 7) / 8);
        savePicture("unused.tga", tgaWithTable(300, bits, bytes));
        EXPECT_TRUE(drawnWith("unused.tga").image.valid()) << drawnWith("unused.tga").notices;
        expectRefused("cut.tga", tgaWithTable(300, bits, bytes - 100), "expected at least");
    }
    for (const std::uint32_t bits : {0u, 1u, 8u, 17u, 25u, 33u, 255u})
        expectRefused("unknown.tga", tgaWithTable(300, bits, std::size_t(300) * (bits / 8)),
                      "a TGA picture whose table has colours of an unknown length");
}

/// However long it is: remarks and empty lines have no end.
TEST(Pictures, PnmHeadersAreReadToTheirEnd) {
    std::string header = "P6\n";
    while (header.size() < 4096 - 7) header += header.size() % 2 == 1 ? "#\n" : "\n";
    for (const char* rest : {"1846\n255\n", "0923\n255\n"})
        expectRefused("cut.ppm", header + "65536 2" + rest + std::string(1000, 'A'),
                      " pixels, expected at most");
    savePicture("long.ppm",
                "P6\n#" + std::string(9000, 'x') + "\n5 3\n255\n" + std::string(45, 'c'));
    const Drawn drawn = drawnWith("long.ppm");
    ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
    EXPECT_EQ(drawn.image->s(), 5);
    // What a locale may take for one number.
    expectRefused("locale.pgm", "P5\n5 3,000,000\n255\n" + std::string(15, 'c'),
                  "a PNM picture without a size");
}

TEST(Pictures, TiffPlanesApartAreColours) {
    const std::pair<const char*, std::string> drawn[] = {
        {"grey.tif", tiffOfPlanes(1, 1, 2)},
        {"together.tif", tiffOfPlanes(1, 1, 1)},
        {"colours.tif", tiffOfPlanes(3, 2, 2)},
        {"alpha.tif", tiffOfPlanes(4, 2, 2)},
        {"first.tif", tiffOfPlanes(1, 1, 1, tiffEntry(277, 4) + tiffEntry(284, 2))}};
    for (const auto& [name, content] : drawn) {
        savePicture(name, content);
        EXPECT_TRUE(drawnWith(name).image.valid()) << drawnWith(name).notices;
    }
    for (const std::uint32_t photometric : {0u, 1u})
        for (const std::uint32_t samples : {2u, 3u, 4u})
            expectRefused("apart.tif", tiffOfPlanes(samples, photometric, 2),
                          "a TIFF picture with planes apart that are no colours");
    expectRefused("few.tif", tiffOfPlanes(2, 2, 2), "planes apart that are no colours");
    // libtiff goes by the first of a tag's values.
    expectRefused("twice.tif", tiffOfPlanes(4, 1, 2, tiffEntry(284, 1) + tiffEntry(262, 2)),
                  "planes apart that are no colours");
    expectRefused("palette.tif", tiffOfPlanes(3, 3, 1, tiffEntry(262, 5)),
                  "more colours than its table");
}

/// libjpeg goes by the first.
TEST(Pictures, JpegsBeginOnce) {
    const std::string whole = written("jpg"), frame = "\xff\xc2"s + big(11, 2) + "\x08"s +
                                                      big(16, 2) + big(16, 2) + "\x01\x01\x11\0"s;
    const std::string large = jpeg(60000, 1);
    expectRefused("frames.jpg", large.substr(0, large.size() - 2) + frame + "\xff\xd9",
                  "a JPEG picture that begins twice");
    expectRefused("starts.jpg", "\xff\xd8" + whole, "a JPEG picture that begins twice");
    expectRefused("end.jpg", whole.substr(0, whole.size() - 2) + "\xff\xd8" + "\xff\xd9",
                  "a JPEG picture that");
    savePicture("tem.jpg", whole.substr(0, whole.size() - 2) + "\xff\x01" + "\xff\xd9");
    EXPECT_TRUE(drawnWith("tem.jpg").image.valid()) << drawnWith("tem.jpg").notices;
}

TEST(Pictures, DdsHeadersAreThere) {
    const std::string second = with(dds(4, 4), 84, "DX10");
    expectRefused("second.dds", second, "expected at least 148");
    expectRefused("header.dds", dds(0, 0).substr(0, 100), "expected at least 128");
    expectRefused("short.dds", dds(0, 0).substr(0, 82), "expected at least 128");
}

/// Readers count bytes in 31 bits.
TEST(Pictures, ThatNoReaderCountsAreRefused) {
    expectRefused("counted.ppm", "P6\n65536 21846\n255\n", "expected at most 2 GB when unpacked",
                  "maxPixels=100000000000");
}

TEST(Pictures, OfOtherFormatsAreReadWhereTheyAreNamed) {
    expectRefused("strange.ktx", "KTX", "expected one of bmp, bw, dds");
    savePicture("named.ktx", "KTX");
    const Drawn drawn = drawnWith("named.ktx", "pictures=ktx,hdr");
    EXPECT_FALSE(drawn.image.valid());
    EXPECT_EQ(drawn.notices.find("(option pictures)"), std::string::npos) << drawn.notices;
}

TEST(Pictures, AreLookedAtWithinGltf) {
    for (const bool large : {false, true}) {
        std::string png = written("png");
        if (large) png = with(png, 16, big(40000, 4) + big(40000, 4));
        test::GltfColumn column;
        std::vector<double> bytes;
        for (const char byte : png) bytes.push_back(double(static_cast<unsigned char>(byte)));
        column.accessor("SCALAR", bytes, 5121);
        column.json["images"] = {
            {{"bufferView", column.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
        column.json["textures"] = {{{"source", 0}}};
        column.json["materials"] = {
            {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        column.json["meshes"][0]["primitives"][0]["material"] = 0;
        const test::Notices notices;
        const osgSkin::ImportedMesh mesh =
            osgSkin::importMesh(column.save(large ? "picture_large.gltf" : "picture_whole.gltf"));
        const osg::StateSet& states = *mesh.parts.at(0).geometry->getStateSet();
        EXPECT_EQ(states.getTextureAttribute(0, osg::StateAttribute::TEXTURE) != nullptr, !large)
            << notices.text();
        EXPECT_EQ(notices.say("a picture of 40000 x 40000 pixels"), large) << notices.text();
    }
}

TEST(Pictures, AreLookedAtWithinSavedScenes) {
    for (const bool large : {false, true}) {
        savePicture("picture_inner.png", written("png"));
        const osg::ref_ptr<osg::Image> image =
            osgDB::readRefImageFile(testing::TempDir() + "picture_inner.png");
        ASSERT_TRUE(image.valid());
        std::string png = written("png");
        if (large) png = with(png, 16, big(40000, 4) + big(40000, 4));
        savePicture("picture_inner.png", png); // which is what is written
        const osg::ref_ptr<osg::Geometry> geometry =
            osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 1, 0});
        geometry->getOrCreateStateSet()->setTextureAttribute(0, new osg::Texture2D(image));
        const std::string path = testing::TempDir() + "picture_inner.osgb";
        const osg::ref_ptr<osgDB::Options> whole = new osgDB::Options("WriteImageHint=IncludeFile");
        ASSERT_TRUE(osgDB::writeNodeFile(*geometry, path, whole));
        if (large)
            expectError([&] { osgSkin::readScene(path, nullptr); },
                        "a picture of 40000 x 40000 pixels, expected at most");
        else
            EXPECT_TRUE(osgSkin::readScene(path, nullptr).valid());
    }
}
