// OpenEXR, read from and written to memory. Its exceptions end in this file.
#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <fmt/format.h>

#include "image/codecs.h"

namespace shaderx::image {

namespace {

class MemoryInput : public Imf::IStream {
  public:
    MemoryInput(const char* name, Bytes bytes) : IStream(name), bytes_(bytes) {}
    bool read(char to[], int count) override {
        if (count < 0 || static_cast<std::size_t>(count) > bytes_.size() - at_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = std::min<std::size_t>(at, bytes_.size()); }

  private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

class MemoryOutput : public Imf::OStream {
  public:
    MemoryOutput() : OStream("memory") {}
    void write(const char from[], int count) override {
        const std::size_t end = at_ + static_cast<std::size_t>(count);
        if (bytes.size() < end) bytes.resize(end);
        std::memcpy(bytes.data() + at_, from, static_cast<std::size_t>(count));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }

    std::vector<std::uint8_t> bytes;

  private:
    std::size_t at_ = 0;
};

// Which channels make the picture, in our order. Empty where the file stores luminance and chroma.
std::vector<std::string> pickChannels(const Imf::ChannelList& channels) {
    const auto has = [&](const std::string& name) { return channels.findChannel(name.c_str()) != nullptr; };
    if (has("RY") || has("BY")) return {};
    if (channels.begin() == channels.end()) return {};
    // The unnamed layer first, then the first channel's own.
    std::string layer;
    const std::string first = channels.begin().name();
    for (const std::string& prefix : {std::string(), first.substr(0, first.rfind('.') + 1)}) {
        layer = prefix;
        if (has(prefix + "R") || has(prefix + "Y")) break;
    }
    std::vector<std::string> out;
    if (has(layer + "R") && has(layer + "G") && has(layer + "B"))
        out = {layer + "R", layer + "G", layer + "B"};
    else if (has(layer + "Y"))
        out = {layer + "Y"};
    else
        out = {has(layer + "R") ? layer + "R" : first};
    if (has(layer + "A") && out[0] != layer + "A") out.push_back(layer + "A");
    return out;
}

struct Window {
    long long x, y, width, height;
    explicit Window(const Imath::Box2i& box)
        : x(box.min.x),
          y(box.min.y),
          width(static_cast<long long>(box.max.x) - box.min.x + 1),
          height(static_cast<long long>(box.max.y) - box.min.y + 1) {}
};

// Moves the data window's pixels to their places in the display window.
Image place(Image data, const Window& from, const Window& to) {
    if (from.x == to.x && from.y == to.y && from.width == to.width && from.height == to.height) return data;
    Image out = Image::ofFloats(static_cast<int>(to.width), static_cast<int>(to.height), data.channels);
    const long long x0 = std::max(from.x, to.x), x1 = std::min(from.x + from.width, to.x + to.width);
    const long long y0 = std::max(from.y, to.y), y1 = std::min(from.y + from.height, to.y + to.height);
    if (x0 >= x1) return out;
    for (long long y = y0; y < y1; y++) {
        const float* source = &data.floats[data.index(static_cast<int>(x0 - from.x), static_cast<int>(y - from.y), 0)];
        std::copy(source, source + (x1 - x0) * data.channels,
                  &out.floats[out.index(static_cast<int>(x0 - to.x), static_cast<int>(y - to.y), 0)]);
    }
    return out;
}

Image readChannels(Imf::InputFile& file, const std::vector<std::string>& names, const Window& window) {
    Image out = Image::ofFloats(static_cast<int>(window.width), static_cast<int>(window.height),
                                static_cast<int>(names.size()));
    const std::size_t pixel = names.size() * sizeof(float), row = pixel * static_cast<std::size_t>(window.width);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < names.size(); c++)
        buffer.insert(names[c],
                      Imf::Slice::Make(Imf::FLOAT, out.floats.data() + c, file.header().dataWindow(), pixel, row));
    file.setFrameBuffer(buffer);
    file.readPixels(file.header().dataWindow().min.y, file.header().dataWindow().max.y);
    return out;
}

Image readLuminanceChroma(MemoryInput& input, const Window& window) {
    input.seekg(0);
    Imf::RgbaInputFile file(input, 0);
    std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(window.width * window.height));
    // OpenEXR wants the address of the pixel (0, 0), which may lie outside; integers keep that arithmetic defined.
    const std::intptr_t offset =
        -static_cast<std::intptr_t>(window.x + window.y * window.width) * static_cast<std::intptr_t>(sizeof(Imf::Rgba));
    file.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(reinterpret_cast<std::intptr_t>(pixels.data()) + offset), 1,
                        static_cast<std::size_t>(window.width));
    file.readPixels(file.dataWindow().min.y, file.dataWindow().max.y);
    const bool alpha = (file.channels() & Imf::WRITE_A) != 0;
    Image out = Image::ofFloats(static_cast<int>(window.width), static_cast<int>(window.height), alpha ? 4 : 3);
    std::size_t o = 0;
    for (const Imf::Rgba& p : pixels) {
        for (const float v : {float(p.r), float(p.g), float(p.b)}) out.floats[o++] = v;
        if (alpha) out.floats[o++] = p.a;
    }
    return out;
}

Result<Image> decode(const Source& source) {
    // OpenEXR checks a header against these before it takes memory for the file's tables.
    Imf::Header::setMaxImageSize(source.limits.maxSide, source.limits.maxSide);
    Imf::Header::setMaxTileSize(source.limits.maxSide, source.limits.maxSide);
    MemoryInput input(source.path.c_str(), source.bytes);
    Imf::InputFile file(input, 0);
    const Imf::Header& header = file.header();
    if (header.hasType() && Imf::isDeepData(header.type())) return source.damaged("EXR", "deep pixels are not read");
    const Window data(header.dataWindow()), display(header.displayWindow());
    if (!source.allows(data.width, data.height) || !source.allows(display.width, display.height)) return Failure{};
    if (header.channels().begin() == header.channels().end()) return source.damaged("EXR", "it has no channels");
    const std::vector<std::string> names = pickChannels(header.channels());
    for (const std::string& name : names) {
        const Imf::Channel& channel = header.channels()[name];
        if (channel.xSampling != 1 || channel.ySampling != 1)
            return source.damaged("EXR", fmt::format("channel {} is subsampled", name));
    }
    return place(names.empty() ? readLuminanceChroma(input, data) : readChannels(file, names, data), data, display);
}

}  // namespace

Result<Image> decodeExr(const Source& source) {
    try {
        return decode(source);
    } catch (const std::bad_alloc&) {
        throw;  // reported by the caller
    } catch (const std::length_error&) {
        throw;
    } catch (const std::exception& error) {
        return source.damaged("EXR", error.what());
    }
}

bool writeExr(const std::string& path, const Image& image, Diagnostics& diagnostics) {
    static const std::array<std::vector<const char*>, 4> kNames{
        {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
    std::vector<float> values = image.floats;
    if (!image.isFloat)
        for (const std::uint8_t byte : image.bytes) values.push_back(static_cast<float>(byte) / 255.0f);
    const std::vector<const char*>& names = kNames[static_cast<std::size_t>(image.channels) - 1];
    const std::size_t pixel = names.size() * sizeof(float), row = pixel * static_cast<std::size_t>(image.width);
    MemoryOutput memory;
    try {
        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < names.size(); c++) {
            header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
            buffer.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c), pixel, row));
        }
        Imf::OutputFile file(memory, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    } catch (const std::exception& error) {
        return cannotWrite(path, error.what(), diagnostics);
    }
    return writeFile(path, memory.bytes, diagnostics);
}

}  // namespace shaderx::image
