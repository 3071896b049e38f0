// SPDX-License-Identifier: Apache-2.0
// Reads JPEG pictures with libjpeg.
#include "importers/pov/pictures/picture.h"

#include <csetjmp>
#include <cstdio>

#include <jpeglib.h> // needs FILE of cstdio

namespace ovc::pov {

namespace {

/// The state of reading a file. libjpeg reports errors by a jump, which skips the destructors of
/// local variables, so whatever needs one is a member.
struct Reading {
    jpeg_error_mgr errors{}; // libjpeg keeps a pointer to it
    jpeg_decompress_struct jpeg{};
    std::jmp_buf back;
    std::vector<uint8_t> row;
    Result<Picture> picture = Error{"found a damaged JPEG picture"};

    ~Reading() { jpeg_destroy_decompress(&jpeg); }
};

[[noreturn]] void on_error(j_common_ptr jpeg) {
    std::longjmp(static_cast<Reading*>(jpeg->client_data)->back, 1);
}

void on_message(j_common_ptr) {}

void decode(Reading& r, Bytes file) {
    jpeg_mem_src(&r.jpeg, file.data(), file.size());
    jpeg_read_header(&r.jpeg, TRUE);
    r.picture = make_picture(r.jpeg.image_width, r.jpeg.image_height);
    if (!r.picture)
        return;
    r.jpeg.out_color_space = JCS_RGB;
    jpeg_start_decompress(&r.jpeg);
    r.row.resize(size_t(r.jpeg.output_width) * 3);
    r.picture->gray = r.jpeg.num_components == 1;
    r.picture->pixels.reserve(r.picture->size());
    while (r.jpeg.output_scanline < r.jpeg.output_height) {
        JSAMPROW row = r.row.data();
        jpeg_read_scanlines(&r.jpeg, &row, 1);
        for (size_t x = 0; x < r.picture->width; ++x)
            r.picture->pixels.push_back({uint16_t(257 * row[3 * x]), uint16_t(257 * row[3 * x + 1]),
                                         uint16_t(257 * row[3 * x + 2]), 65535});
    }
}

} // namespace

Result<Picture> read_jpeg(Bytes file) {
    Reading reading;
    reading.jpeg.err = jpeg_std_error(&reading.errors);
    reading.errors.error_exit = on_error;
    reading.errors.output_message = on_message;
    reading.jpeg.client_data = &reading;
    if (setjmp(reading.back) != 0)
        return Error{"found a damaged JPEG picture"};
    jpeg_create_decompress(&reading.jpeg);
    reading.jpeg.client_data = &reading; // some versions clear it in jpeg_create_decompress
    decode(reading, file);
    return std::move(reading.picture);
}

} // namespace ovc::pov
