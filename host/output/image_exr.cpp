// SPDX-License-Identifier: Apache-2.0
// Writes linear light to OpenEXR as float channels R, G, B, A, and layers; reads whatever channels
// there are. No other file includes OpenEXR.
#include "host/diff/channels.h"
#include "host/output/output.h"

#include "importers/picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <exception>
#include <stdexcept>
#include <string_view>

namespace ovc {

/// Many times the rows that OpenEXR compresses together.
static constexpr uint32_t kRowsAtOnce = 64;

static constexpr const char* kColors[] = {"R", "G", "B", "A"};

static Imf::PixelType type_of(const Layer& layer) {
    return layer.type == Layer::Type::Float ? Imf::FLOAT : Imf::UINT;
}

/// A file in memory, because OpenEXR goes back to fill in a table, and a pipe cannot.
class MemoryStream final : public Imf::OStream {
public:
    explicit MemoryStream(std::string& bytes) : OStream("memory"), bytes_(bytes) {}

    void write(const char* data, int size) override {
        bytes_.resize(std::max(bytes_.size(), at_ + size_t(size)));
        std::copy(data, data + size, bytes_.begin() + std::ptrdiff_t(at_));
        at_ += size_t(size);
    }
    uint64_t tellp() override { return at_; }
    void seekp(uint64_t at) override { at_ = at; }

private:
    std::string& bytes_;
    size_t at_ = 0;
};

/// The bytes of a file, because OpenEXR goes back and forth in one.
class BytesStream final : public Imf::IStream {
public:
    explicit BytesStream(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}

    bool read(char* to, int size) override {
        if (at_ > bytes_.size() || size_t(size) > bytes_.size() - at_)
            throw std::runtime_error("it ends early");
        std::copy_n(&bytes_[at_], size, to);
        at_ += size_t(size);
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t at) override { at_ = at; }

private:
    const std::string_view bytes_;
    size_t at_ = 0;
};

/// Returns a header that has the picture's channels and the layers.
static Imf::Header header_of(const PixelSource& image, const FileContents& contents) {
    Imf::Header header(int(image.width), int(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const FileNote& note : contents.notes)
        header.insert(note.name, Imf::StringAttribute(note.text));
    for (const char* name : kColors)
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    for (const Layer& layer : contents.layers) {
        assert(layer.values.size() == image.size());
        header.channels().insert(layer.name, Imf::Channel(type_of(layer)));
    }
    return header;
}

/// Writes rows from `first` on, of which `pixels` holds the picture's.
static void write_rows(Imf::OutputFile& file, uint32_t first, std::vector<vec4>& pixels,
                       uint32_t width, std::span<const Layer> layers) {
    const int64_t rows = int64_t(pixels.size()) / width;
    const Imath::V2i corner(0, int(first));
    Imf::FrameBuffer frame;
    for (int channel = 0; channel < 4; ++channel)
        frame.insert(kColors[channel],
                     Imf::Slice::Make(Imf::FLOAT, &pixels[0][channel], corner, width, rows,
                                      sizeof(vec4), sizeof(vec4) * width));
    for (const Layer& layer : layers)
        frame.insert(layer.name,
                     Imf::Slice::Make(type_of(layer), &layer.values[size_t(first) * width], corner,
                                      width, rows, sizeof(uint32_t), sizeof(uint32_t) * width));
    file.setFrameBuffer(frame);
    file.writePixels(int(rows));
}

Result<std::string> encode_exr(const PixelSource& image, const FileContents& contents) {
    try {
        std::string bytes;
        MemoryStream stream(bytes);
        {
            Imf::OutputFile file(stream, header_of(image, contents));
            for (uint32_t y = 0; y < image.height; y += kRowsAtOnce) {
                const uint32_t rows = std::min(kRowsAtOnce, image.height - y);
                std::vector<vec4> pixels(size_t(rows) * image.width);
                image.read(size_t(y) * image.width, pixels);
                write_rows(file, y, pixels, image.width, contents.layers);
            }
        } // the destructor has written the table of lines
        return bytes;
    } catch (const std::exception& e) {
        return Error{e.what()};
    }
}

/// Reads all channels, halves as floats.
static Result<Channels> read_all(Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || uint64_t(width) * uint64_t(height) > kMaxPixels)
        return Error{fmt::format("found a picture of {} x {}, expected 1 to {} pixels", width,
                                 height, kMaxPixels)};
    const Imath::V2i corner = file.header().displayWindow().min;
    Channels channels{uint32_t(width),
                      uint32_t(height),
                      Coding::Linear,
                      {},
                      int64_t(window.min.x) - corner.x,
                      int64_t(window.min.y) - corner.y};
    const Imf::ChannelList& list = file.header().channels();
    for (auto one = list.begin(); one != list.end(); ++one) {
        if (one.channel().xSampling != 1 || one.channel().ySampling != 1)
            return Error{fmt::format("the channel {} has fewer samples than the picture has pixels",
                                     one.name())};
        const auto type = one.channel().type == Imf::UINT ? Layer::Type::Uint : Layer::Type::Float;
        channels.all.push_back({one.name(), type, std::vector<uint32_t>(channels.size())});
    }
    Imf::FrameBuffer frame;
    for (Layer& layer : channels.all)
        frame.insert(layer.name, Imf::Slice::Make(type_of(layer), layer.values.data(), window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return channels;
}

Result<Channels> read_exr(std::string_view bytes) {
    try {
        BytesStream stream(bytes);
        if (const int parts = Imf::MultiPartInputFile(stream).parts(); parts > 1)
            return Error{fmt::format("found an OpenEXR picture of {} parts, expected one", parts)};
        stream.seekg(0);
        Imf::InputFile file(stream);
        return read_all(file);
    } catch (const std::exception& e) {
        return Error{fmt::format("found a damaged OpenEXR picture: {}", e.what())};
    }
}

} // namespace ovc
