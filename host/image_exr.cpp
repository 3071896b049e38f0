// SPDX-License-Identifier: Apache-2.0
// OpenEXR out: linear light, float channels R, G, B, A. The only file that sees OpenEXR.
#include "host/output.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <exception>

namespace ovc {

Result<Done> write_exr(const Image& image, const std::filesystem::path& path) {
    try {
        Imf::Header header(int(image.width), int(image.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        for (int channel = 0; channel < 4; ++channel) {
            const char name[] = {"RGBA"[channel], '\0'};
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            // Slices are declared writable for reading and writing alike; writing a file only reads
            // them.
            char* first =
                const_cast<char*>(reinterpret_cast<const char*>(&image.pixels[0][channel]));
            frame.insert(name,
                         Imf::Slice(Imf::FLOAT, first, sizeof(vec4), sizeof(vec4) * image.width));
        }
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(int(image.height));
        return Done{};
    } catch (const std::exception& e) {
        return Error{e.what()};
    }
}

} // namespace ovc
