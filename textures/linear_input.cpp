// SPDX-License-Identifier: Apache-2.0
#include "textures/linear_input.h"

#include "textures/pyramid.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

namespace {

/// The pictures by their names. The cache hands nothing else to an input.
struct NamedPictures {
    std::mutex mutex;
    std::map<std::string, NamedPicture> by_name;
    uint64_t next = 0;
};

NamedPictures& named_pictures() {
    static NamedPictures pictures;
    return pictures;
}

float linear(float code, double gamma) {
    if (gamma != 0)
        return std::pow(std::max(code, 0.0f), float(gamma));
    return code <= 0.04045f ? code / 12.92f
                            : std::pow((code + 0.055f) / 1.055f, 2.4f); // IEC 61966-2-1
}

/// Returns the name of a file by which OpenImageIO tries the right reader first. Not all readers
/// take a picture from memory, so it does not try them in turn.
std::string name_of(std::span<const unsigned char> bytes) {
    const auto begins = [&](std::string_view magic) {
        return bytes.size() >= magic.size() &&
               std::equal(magic.begin(), magic.end(), bytes.begin(), [](char a, unsigned char b) {
                   return static_cast<unsigned char>(a) == b;
               });
    };
    return begins("\x89PNG") ? "picture.png" : begins("\xff\xd8") ? "picture.jpg" : "picture.exr";
}

/// Returns what keeps a picture of this kind from being read, or nothing. A damaged header may
/// claim any size. OpenImageIO ends the process where an int cannot count the tiles.
std::string refusal(const OIIO::ImageSpec& spec) {
    constexpr int64_t kMaxTiles = int64_t(1) << 30;
    constexpr int64_t kMaxValues = int64_t(1) << 28; // of the rows that are held at once
    if (spec.nchannels < 1 || spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.deep)
        return "it has no pixels";
    const int64_t width = spec.width, height = spec.height;
    const int64_t rows = std::min<int64_t>(height, std::max(spec.tile_height, Pyramid::kTile));
    const auto tiles = [&](int64_t across, int64_t down) {
        return (width / across + 1) * (height / down + 1);
    };
    if (tiles(Pyramid::kTile, Pyramid::kTile) > kMaxTiles ||
        (spec.tile_width > 0 &&
         tiles(spec.tile_width, std::max(1, spec.tile_height)) > kMaxTiles) ||
        width * rows > kMaxValues / spec.nchannels)
        return "found " + std::to_string(width) + " x " + std::to_string(height) +
               " pixels, which are too many";
    return {};
}

class LinearInput final : public OIIO::ImageInput {
public:
    ~LinearInput() override { close(); }

    const char* format_name() const override { return "overcast"; }
    using ImageInput::open;
    bool open(const std::string& name, OIIO::ImageSpec& spec) override;

    bool close() override {
        input_.reset();
        memory_.reset();
        pyramid_.reset();
        return true;
    }

    int current_miplevel() const override { return level_; }
    bool seek_subimage(int subimage, int miplevel) override;
    /// All pictures have tiles here.
    bool read_native_scanline(int, int, int, int, void*) override { return false; }
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

private:
    bool fail(const std::string& message) {
        errorfmt("{}", message);
        return false;
    }
    void take_format(const OIIO::ImageSpec& file);
    bool read_tile_at(int subimage, int miplevel, int x, int y, int z, void* data);
    bool make_pyramid();
    bool read_rows(int first, int count, std::vector<float>& values);
    void decode(std::vector<float>& values) const;

    NamedPicture picture_;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;
    std::unique_ptr<OIIO::ImageInput> input_;
    OIIO::ImageSpec finest_;           // of the file
    bool is_encoded_ = false;          // its values are codes
    bool has_mipmaps_ = false;         // they and the tiles are those of the file
    int level_ = 0;                    // that m_spec describes
    std::unique_ptr<Pyramid> pyramid_; // made when the first tile is asked for
    std::string failure_;              // why it could not be made; empty: it could, or is not yet
};

bool LinearInput::open(const std::string& name, OIIO::ImageSpec& spec) {
    {
        const std::scoped_lock lock(named_pictures().mutex);
        const auto at = named_pictures().by_name.find(name);
        if (at == named_pictures().by_name.end())
            return false;
        picture_ = at->second;
    }
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); // colors stay where the opacity is 0
    if (!picture_.bytes.empty())
        memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(picture_.bytes.data(),
                                                                  picture_.bytes.size());
    void* const memory = memory_.get();
    if (memory)
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &memory);
    input_ = ImageInput::open(memory ? name_of(picture_.bytes) : picture_.file, &config);
    if (!input_)
        return fail(OIIO::geterror());
    finest_ = input_->spec();
    if (const std::string why = refusal(finest_); !why.empty())
        return fail(why);
    has_mipmaps_ = finest_.tile_width > 0 && input_->seek_subimage(0, 1);
    if (!seek_subimage(0, 0))
        return false;
    spec = m_spec;
    return true;
}

bool LinearInput::seek_subimage(int subimage, int miplevel) {
    const lock_guard lock(*this);
    if (!input_ || subimage != 0 || miplevel < 0)
        return false;
    if (has_mipmaps_) {
        if (!input_->seek_subimage(0, miplevel) || !refusal(input_->spec()).empty())
            return false;
        take_format(input_->spec());
    } else {
        if (miplevel >= Pyramid::levels(finest_.width, finest_.height))
            return false;
        take_format(finest_);
        m_spec.x = m_spec.y = m_spec.full_x = m_spec.full_y = 0;
        m_spec.width = m_spec.full_width = Pyramid::size_at(finest_.width, miplevel);
        m_spec.height = m_spec.full_height = Pyramid::size_at(finest_.height, miplevel);
        m_spec.tile_width = m_spec.tile_height = Pyramid::kTile;
        m_spec.tile_depth = 1;
    }
    level_ = miplevel;
    return true;
}

/// Whole numbers become halves, which resolve the codes of 8 bits; those of 16 become floats.
void LinearInput::take_format(const OIIO::ImageSpec& file) {
    m_spec = file;
    is_encoded_ = !m_spec.format.is_floating_point() && picture_.gamma != 1;
    m_spec.channelformats.clear();
    if (!m_spec.format.is_floating_point())
        m_spec.set_format(m_spec.format.size() == 1 ? OIIO::TypeHalf : OIIO::TypeFloat);
}

void LinearInput::decode(std::vector<float>& values) const {
    const size_t channels = size_t(m_spec.nchannels);
    for (size_t i = 0; is_encoded_ && i < values.size(); ++i)
        if (int(i % channels) != m_spec.alpha_channel)
            values[i] = linear(values[i], picture_.gamma);
}

/// Reads whole rows of the finest level, counted from 0.
bool LinearInput::read_rows(int first, int count, std::vector<float>& values) {
    const int y = finest_.y + first;
    values.resize(size_t(count) * size_t(finest_.width) * size_t(finest_.nchannels));
    const bool done =
        finest_.tile_width > 0
            ? input_->read_tiles(0, 0, finest_.x, finest_.x + finest_.width, y, y + count,
                                 finest_.z, finest_.z + 1, 0, finest_.nchannels, OIIO::TypeFloat,
                                 values.data())
            : input_->read_scanlines(0, 0, y, y + count, finest_.z, 0, finest_.nchannels,
                                     OIIO::TypeFloat, values.data());
    if (!done)
        return fail(failure_ = input_->geterror());
    decode(values);
    return true;
}

bool LinearInput::make_pyramid() {
    if (!failure_.empty())
        return fail(failure_);
    auto made =
        std::make_unique<Pyramid>(finest_.width, finest_.height, finest_.nchannels, m_spec.format);
    const size_t row = size_t(finest_.width) * size_t(finest_.nchannels);
    const int step = finest_.tile_width > 0 ? finest_.tile_height : 16;
    std::vector<float> values;
    for (int y = 0; y < finest_.height; y += step) {
        const int rows = std::min(step, finest_.height - y);
        if (!read_rows(y, rows, values))
            return false;
        for (int i = 0; i < rows; ++i)
            made->add_row(std::span(values).subspan(size_t(i) * row, row));
    }
    pyramid_ = std::move(made);
    return true;
}

/// Several threads of the cache may ask for tiles at once. A tile that cannot be read has no
/// values; whoever samples asks the picture's ReadFailure afterwards.
bool LinearInput::read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) {
    const lock_guard lock(*this);
    if (!read_tile_at(subimage, miplevel, x, y, z, data))
        picture_.failure->note(geterror());
    return true;
}

bool LinearInput::read_tile_at(int subimage, int miplevel, int x, int y, int z, void* data) {
    if (!seek_subimage(subimage, miplevel))
        return fail("a level of it cannot be read");
    if (has_mipmaps_) {
        std::vector<float> values(m_spec.tile_pixels() * size_t(m_spec.nchannels));
        if (!input_->read_tile(x, y, z, OIIO::TypeFloat, values.data()))
            return fail(input_->geterror());
        decode(values);
        return OIIO::convert_pixel_values(OIIO::TypeFloat, values.data(), m_spec.format, data,
                                          int(values.size()));
    }
    try {
        return (pyramid_ || make_pyramid()) && (pyramid_->read_tile(size_t(miplevel), x, y, data) ||
                                                fail("its scratch file cannot be read"));
    } catch (const std::exception& e) {
        return fail(e.what());
    }
}

} // namespace

void ReadFailure::note(const std::string& sentence) {
    const std::scoped_lock lock(mutex_);
    if (!is_noted_)
        sentence_ = sentence;
    is_noted_ = true;
}

std::string ReadFailure::sentence() const {
    const std::scoped_lock lock(mutex_);
    return sentence_;
}

std::string name_picture(const NamedPicture& picture) {
    NamedPictures& pictures = named_pictures();
    const std::scoped_lock lock(pictures.mutex);
    std::string name = "overcast-" + std::to_string(pictures.next++);
    pictures.by_name.emplace(name, picture);
    return name;
}

void forget_picture(const std::string& name) {
    const std::scoped_lock lock(named_pictures().mutex);
    named_pictures().by_name.erase(name);
}

OIIO::ImageInput* make_linear_input() {
    return new LinearInput;
}

} // namespace ovc
