// SPDX-License-Identifier: Apache-2.0
// The C API of Open Image Denoise by dlopen. Its header is not needed, so that a build knows
// nothing of it; the declarations here are those of its documentation, versions 1.4 and 2.
#include "host/output/denoiser.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

using OidnObject = void*; // a device or a filter

struct OidnFunctions {
    OidnObject (*new_device)(int type);
    void (*commit_device)(OidnObject device);
    int (*device_error)(OidnObject device, const char** message);
    void (*release_device)(OidnObject device);
    OidnObject (*new_filter)(OidnObject device, const char* type);
    void (*set_image)(OidnObject filter, const char* name, void* data, int format, size_t width,
                      size_t height, size_t offset, size_t pixel_stride, size_t row_stride);
    void (*set_flag)(OidnObject filter, const char* name, bool value);
    void (*commit_filter)(OidnObject filter);
    void (*execute_filter)(OidnObject filter);
    void (*release_filter)(OidnObject filter);
};

/// A device of this kind reads memory where it lies. Those of GPUs do not.
static constexpr int kCpuDevice = 1;
static constexpr int kThreeFloats = 3;
static constexpr const char* kLibraries[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                             "libOpenImageDenoise.so.0", "libOpenImageDenoise.so"};

template <class F>
static bool find(void* library, const char* name, F& function) {
    function = reinterpret_cast<F>(dlsym(library, name));
    return function != nullptr;
}

static bool find_all(void* library, OidnFunctions& oidn) {
    return find(library, "oidnNewDevice", oidn.new_device) &&
           find(library, "oidnCommitDevice", oidn.commit_device) &&
           find(library, "oidnGetDeviceError", oidn.device_error) &&
           find(library, "oidnReleaseDevice", oidn.release_device) &&
           find(library, "oidnNewFilter", oidn.new_filter) &&
           find(library, "oidnSetSharedFilterImage", oidn.set_image) &&
           (find(library, "oidnSetFilterBool", oidn.set_flag) ||
            find(library, "oidnSetFilter1b", oidn.set_flag)) && // before version 2
           find(library, "oidnCommitFilter", oidn.commit_filter) &&
           find(library, "oidnExecuteFilter", oidn.execute_filter) &&
           find(library, "oidnReleaseFilter", oidn.release_filter);
}

Result<const Denoiser*> Denoiser::load() {
    static OidnFunctions functions{};
    static const Denoiser denoiser(functions);
    if (functions.release_filter)
        return &denoiser;
    for (const char* const name : kLibraries)
        if (void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
            if (find_all(library, functions))
                return &denoiser;
            functions = {};
            return Error{fmt::format("--denoise: {} lacks functions that are needed", name)};
        }
    return Error{fmt::format("--denoise needs Intel's Open Image Denoise, and {} cannot be loaded; "
                             "where its folder is not one of the system's, name it in "
                             "LD_LIBRARY_PATH",
                             kLibraries[0])};
}

/// Returns the three channels of a feature, pixel by pixel.
static std::vector<float> feature(std::span<const Layer> layers, std::string_view name,
                                  size_t pixels) {
    std::vector<float> values(3 * pixels);
    int channel = 0;
    for (const Layer& layer : layers)
        if (layer.name.starts_with(name) && layer.name.size() == name.size() + 2) {
            for (size_t i = 0; i < pixels; ++i)
                values[3 * i + size_t(channel)] = std::bit_cast<float>(layer.values[i]);
            ++channel;
        }
    assert(channel == 3);
    return values;
}

Result<Done> Denoiser::denoise(Image& image, std::span<const Layer> features) const {
    const size_t pixels = image.pixels.size();
    std::vector<float> color(3 * pixels), output(3 * pixels);
    for (size_t i = 0; i < pixels; ++i)
        for (size_t channel = 0; channel < 3; ++channel)
            color[3 * i + channel] = image.pixels[i][int(channel)];
    std::vector<float> albedo = feature(features, "albedo", pixels);
    std::vector<float> normal = feature(features, "normal", pixels);

    const OidnObject device = oidn_.new_device(kCpuDevice);
    oidn_.commit_device(device);
    const OidnObject filter = oidn_.new_filter(device, "RT");
    for (const auto& [name, data] : {std::pair("color", &color), std::pair("albedo", &albedo),
                                     std::pair("normal", &normal), std::pair("output", &output)})
        oidn_.set_image(filter, name, data->data(), kThreeFloats, image.width, image.height, 0, 0,
                        0);
    oidn_.set_flag(filter, "hdr", true); // light may be above 1
    oidn_.commit_filter(filter);
    oidn_.execute_filter(filter);
    const char* message = nullptr;
    const bool failed = oidn_.device_error(device, &message) != 0;
    const std::string said = message ? message : "";
    oidn_.release_filter(filter);
    oidn_.release_device(device);
    if (failed)
        return Error{fmt::format("--denoise: Open Image Denoise says: {}", said)};
    for (size_t i = 0; i < pixels; ++i)
        image.pixels[i] =
            vec4(output[3 * i], output[3 * i + 1], output[3 * i + 2], image.pixels[i].a);
    return Done{};
}

} // namespace ovc
