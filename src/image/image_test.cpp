#include "image/image.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfRgbaFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace shaderx::image {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("shaderx_image_test_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string store(const std::string& name, const std::string& content) const {
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }
    static std::string load(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string codeOf(const std::string& file, const ReadLimits& limits = {}) const {
        Diagnostics diagnostics;
        if (readImage(file, diagnostics, limits)) return diagnostics.all().empty() ? "" : "read, but reported";
        if (diagnostics.all().size() != 1) return "not one diagnostic";
        return diagnostics.all()[0].code;
    }

    fs::path folder_;
    Diagnostics diagnostics_;
};

Image floats(int width, int height, int channels) {
    Image out = Image::ofFloats(width, height, channels);
    for (std::size_t i = 0; i < out.floats.size(); i++) out.floats[i] = 0.01f * static_cast<float>(i) - 0.3f;
    return out;
}

Image bytes(int width, int height, int channels) {
    Image out = Image::ofBytes(width, height, channels);
    for (std::size_t i = 0; i < out.bytes.size(); i++) out.bytes[i] = static_cast<std::uint8_t>(i * 37 + 11);
    return out;
}

TEST_F(ImageFiles, PngKeepsBytesAndChannels) {
    for (int channels = 1; channels <= 4; channels++) {
        const Image in = bytes(7, 5, channels);
        ASSERT_TRUE(writePng(path("a.png"), in, diagnostics_)) << diagnostics_.text();
        const Result<Image> out = readImage(path("a.png"), diagnostics_);
        ASSERT_TRUE(out) << diagnostics_.text();
        EXPECT_FALSE(out->isFloat);
        EXPECT_EQ(out->width, 7);
        EXPECT_EQ(out->height, 5);
        EXPECT_EQ(out->channels, channels);
        EXPECT_EQ(out->bytes, in.bytes);
    }
}

TEST_F(ImageFiles, PngEncodesLinearFloats) {
    Image in = Image::ofFloats(4, 1, 4);
    in.floats = {0.25f, 0.5f, -1, 1, 0.1f, 0.2f, 0.3f, 0.5f, NAN, INFINITY, 0, 1, 0, 0, 0, 0};
    ASSERT_TRUE(writePng(path("a.png"), in, diagnostics_, {.exposure = 1}));
    const Result<Image> out = readImage(path("a.png"), diagnostics_);
    ASSERT_TRUE(out);
    const auto encoded = [](float v) { return static_cast<int>(linearToSrgb(v) * 255 + 0.5f); };
    EXPECT_EQ(out->bytes[0], encoded(0.5f));
    EXPECT_EQ(out->bytes[1], 255);
    EXPECT_EQ(out->bytes[2], 0);
    EXPECT_EQ(out->bytes[4], encoded(0.4f));  // alpha divided out, one stop up
    EXPECT_EQ(out->bytes[7], 128);
    EXPECT_EQ(out->bytes[8], 0);
    EXPECT_EQ(out->bytes[9], 255);
    EXPECT_EQ(out->bytes[15], 0);
}

TEST_F(ImageFiles, ExrKeepsFloats) {
    for (int channels = 1; channels <= 4; channels++) {
        const Image in = floats(33, 17, channels);
        ASSERT_TRUE(writeExr(path("a.exr"), in, diagnostics_)) << diagnostics_.text();
        const Result<Image> out = readImage(path("a.exr"), diagnostics_);
        ASSERT_TRUE(out) << diagnostics_.text();
        EXPECT_TRUE(out->isFloat);
        EXPECT_EQ(out->channels, channels);
        EXPECT_EQ(out->floats, in.floats);
    }
}

TEST_F(ImageFiles, ExrOfTilesAndLevelsInALayer) {
    std::vector<float> values(50 * 40);
    for (std::size_t i = 0; i < values.size(); i++) values[i] = static_cast<float>(i);
    Imf::Header header(50, 40);
    header.setTileDescription({16, 16, Imf::MIPMAP_LEVELS});
    Imf::FrameBuffer buffer;
    for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 200));
    }
    {
        Imf::TiledOutputFile file(path("a.exr").c_str(), header, 0);
        file.setFrameBuffer(buffer);
        for (int level = 0; level < file.numLevels(); level++)
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
    const Result<Image> out = readImage(path("a.exr"), diagnostics_);
    ASSERT_TRUE(out) << diagnostics_.text();
    EXPECT_EQ(out->channels, 3);
    EXPECT_EQ(out->at(49, 39, 1), 1999);
    EXPECT_EQ(out->at(3, 20, 2), 1003);
}

TEST_F(ImageFiles, ExrFillsItsDisplayWindow) {
    // Data from (2, 2) to (5, 3) in a display of 4 × 4: two columns lie outside. Colours as such, and as luminance and
    // chroma.
    for (const Imf::RgbaChannels channels : {Imf::WRITE_RGBA, Imf::WRITE_YC}) {
        const std::vector<Imf::Rgba> pixels(8, Imf::Rgba(0.5f, 0.5f, 0.5f, 0.25f));
        {
            const Imf::Header header({{0, 0}, {3, 3}}, {{2, 2}, {5, 3}});
            Imf::RgbaOutputFile file(path("a.exr").c_str(), header, channels, 0);
            file.setFrameBuffer(pixels.data() - 2 - 2 * 4, 1, 4);
            file.writePixels(2);
        }
        const Result<Image> out = readImage(path("a.exr"), diagnostics_);
        ASSERT_TRUE(out) << diagnostics_.text();
        EXPECT_EQ(out->width, 4);
        EXPECT_EQ(out->height, 4);
        EXPECT_EQ(out->channels, channels == Imf::WRITE_RGBA ? 4 : 3);
        EXPECT_EQ(out->at(1, 2, 0), 0);
        EXPECT_EQ(out->at(3, 0, 0), 0);
        EXPECT_NEAR(out->at(2, 2, 0), 0.5f, 1e-3);
        EXPECT_NEAR(out->at(3, 3, 2), 0.5f, 1e-3);
    }
}

TEST_F(ImageFiles, PfmKeepsFloatsBottomRowFirst) {
    for (int channels : {1, 3}) {
        const Image in = floats(5, 3, channels);
        ASSERT_TRUE(writePfm(path("a.pfm"), in, diagnostics_));
        const Result<Image> out = readImage(path("a.pfm"), diagnostics_);
        ASSERT_TRUE(out) << diagnostics_.text();
        EXPECT_EQ(out->floats, in.floats);
    }
    const std::string big("Pf 1 2 1.0\n\x3f\x80\0\0\x40\0\0\0", 19);
    const Result<Image> out = readImage(store("big.pfm", big), diagnostics_);
    ASSERT_TRUE(out) << diagnostics_.text();
    EXPECT_EQ(out->floats, (std::vector<float>{2, 1}));
}

TEST_F(ImageFiles, RadianceHdrIsFloat) {
    const std::string file("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n\x80\x40\x20\x81\x80\x80\x80\x84", 54);
    const Result<Image> out = readImage(store("a.hdr", file), diagnostics_);
    ASSERT_TRUE(out) << diagnostics_.text();
    EXPECT_TRUE(out->isFloat);
    EXPECT_EQ(out->channels, 3);
    EXPECT_EQ(out->floats, (std::vector<float>{1, 0.5f, 0.25f, 8, 8, 8}));
}

TEST_F(ImageFiles, BmpAndTga) {
    // One blue pixel (BGR in the file) each.
    const std::string bmp("BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18\0\0\0\0\0\4\0\0\0", 38);
    for (const std::string& file :
         {store("a.bmp", bmp + std::string(16, '\0') + std::string("\xff\0\0\0", 4)),
          store("a.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0\xff\0\0", 21))}) {
        const Result<Image> out = readImage(file, diagnostics_);
        ASSERT_TRUE(out) << diagnostics_.text();
        EXPECT_EQ(out->bytes, (std::vector<std::uint8_t>{0, 0, 255}));
    }
}

TEST_F(ImageFiles, TruncatedAndChangedFilesAreReportedOrRead) {
    ASSERT_TRUE(writePng(path("a.png"), bytes(31, 13, 3), diagnostics_));
    ASSERT_TRUE(writeExr(path("a.exr"), floats(31, 13, 4), diagnostics_));
    ASSERT_TRUE(writePfm(path("a.pfm"), floats(9, 4, 3), diagnostics_));
    for (const char* name : {"a.png", "a.exr", "a.pfm"}) {
        const std::string whole = load(path(name));
        for (std::size_t n = 0; n + 20 < whole.size(); n += n < 400 ? 1 : 37)
            EXPECT_NE(codeOf(store("cut", whole.substr(0, n))), "") << name << " cut to " << n;
        for (std::size_t n = 0; n < whole.size(); n += n < 400 ? 1 : 29)
            for (const char flip : {'\xff', '\x01', '\x80'}) {
                std::string changed = whole;
                changed[n] = static_cast<char>(changed[n] ^ flip);
                codeOf(store("changed", changed), {.maxPixels = 1 << 22});
            }
    }
}

// One grey pixel of 128, from Huffman tables of one code each; `codes` of one bit in the first.
std::string jpeg(char codes) {
    const auto segment = [](char marker, const std::string& body) {
        return std::string{'\xff', marker, static_cast<char>((body.size() + 2) >> 8),
                           static_cast<char>(body.size() + 2)} +
               body;
    };
    const auto table = [](char id, char n) { return std::string{id, n} + std::string(15, n > 1 ? n : '\0'); };
    return "\xff\xd8" + segment('\xdb', std::string(1, '\0') + std::string(64, '\1')) +
           segment('\xc0', std::string("\x08\0\1\0\1\1\1\x11\0", 9)) +
           segment('\xc4', table('\0', codes) + std::string(codes > 1 ? 16 * codes : 1, '\0')) +
           segment('\xc4', table('\x10', 1) + std::string(1, '\0')) +
           segment('\xda', std::string("\1\1\0\0\x3f\0", 6)) + "\x3f\xff\xd9";
}

TEST_F(ImageFiles, JpegWithOversizedHuffmanTableIsDamaged) {
    const Result<Image> out = readImage(store("a.jpg", jpeg(1)), diagnostics_);
    ASSERT_TRUE(out) << diagnostics_.text();
    EXPECT_EQ(out->channels, 1);
    EXPECT_EQ(out->bytes, (std::vector<std::uint8_t>{128}));
    EXPECT_EQ(codeOf(store("b.jpg", jpeg(100))), "damaged-image");
    EXPECT_EQ(codeOf(store("c.jpg", '\xff' + jpeg(100))), "unknown-image-format");
}

TEST_F(ImageFiles, RefusesWhatIsNoPictureOrTooLarge) {
    EXPECT_EQ(codeOf(path("absent.png")), "cannot-read-image");
    EXPECT_EQ(codeOf(folder_.string()), "cannot-read-image");
    EXPECT_EQ(codeOf(store("text", "not a picture at all, just text")), "unknown-image-format");
    EXPECT_EQ(codeOf(store("empty", "")), "unknown-image-format");
    ASSERT_TRUE(writePng(path("a.png"), bytes(20, 20, 3), diagnostics_));
    ASSERT_TRUE(writeExr(path("a.exr"), floats(20, 20, 3), diagnostics_));
    for (const char* name : {"a.png", "a.exr"}) {
        EXPECT_EQ(codeOf(path(name), {.maxPixels = 399}), "image-too-large");
        EXPECT_EQ(codeOf(path(name), {.maxFileBytes = 10}), "image-too-large");
        EXPECT_NE(codeOf(path(name), {.maxSide = 19}), "");
    }
    EXPECT_EQ(codeOf(store("huge.pfm", "PF\n2000000 2000000\n-1\n")), "image-too-large");
}

TEST_F(ImageFiles, LeavesNothingHalfWritten) {
    EXPECT_FALSE(writePng(path("no/such/folder/a.png"), bytes(2, 2, 3), diagnostics_));
    EXPECT_FALSE(writeExr(folder_.string(), floats(2, 2, 3), diagnostics_));
    ASSERT_EQ(diagnostics_.errorCount(), 2u);
    EXPECT_EQ(diagnostics_.all()[0].code, "cannot-write-file");
    store("old.png", "old");
    fs::create_symlink("old.png", path("link.png"));
    EXPECT_TRUE(writePng(path("link.png"), bytes(2, 2, 3), diagnostics_));
    EXPECT_TRUE(fs::is_symlink(path("link.png")));
    EXPECT_EQ(codeOf(path("old.png")), "");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
    EXPECT_TRUE(writePng(path(std::string(251, 'x') + ".png"), bytes(2, 2, 3), diagnostics_));
    EXPECT_FALSE(writePng(path(std::string(252, 'x') + ".png"), bytes(2, 2, 3), diagnostics_));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3);
    EXPECT_TRUE(writePng("/dev/null", bytes(2, 2, 3), diagnostics_));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Image, RgbaHalvesAndFlips) {
    Image grey = Image::ofBytes(3, 2, 1);
    grey.bytes = {0, 100, 200, 50, 150, 250};
    EXPECT_EQ(halved(grey).bytes, (std::vector<std::uint8_t>{75, 225}));
    EXPECT_EQ(flipped(grey).bytes, (std::vector<std::uint8_t>{50, 150, 250, 0, 100, 200}));
    EXPECT_EQ(toRgba(halved(grey)).bytes, (std::vector<std::uint8_t>{75, 75, 75, 255, 225, 225, 225, 255}));
    Image two = Image::ofFloats(1, 1, 2);
    two.floats = {0.5f, 0.25f};
    EXPECT_EQ(toRgba(two).floats, (std::vector<float>{0.5f, 0.5f, 0.5f, 0.25f}));
    EXPECT_NEAR(srgbToLinear(linearToSrgb(0.3f)), 0.3f, 1e-6f);
}

}  // namespace
}  // namespace shaderx::image
