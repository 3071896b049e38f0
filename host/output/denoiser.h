// SPDX-License-Identifier: Apache-2.0
// Denoiser runs Intel's Open Image Denoise, where the user has it. It is loaded for --denoise and
// by nothing else.
#pragma once

#include "core/file/image.h"
#include "core/result.h"
#include "host/output/output.h"

#include <span>

namespace ovc {

/// The functions of the library, in OidnFunctions of denoiser.cpp.
struct OidnFunctions;

class Denoiser {
public:
    /// Loads the library, version 2 or 1, once in a process. Error: it is not there, or lacks a
    /// function.
    static Result<const Denoiser*> load();

    /// Replaces the image's light by what the library makes of it; alpha stays. features: the
    /// layers albedo.R, .G, .B and normal.X, .Y, .Z, in this order or the other, among others that
    /// it skips; a word a pixel. Error: the library's own.
    Result<Done> denoise(Image& image, std::span<const Layer> features) const;

private:
    explicit Denoiser(const OidnFunctions& functions) : oidn_(functions) {}

    const OidnFunctions& oidn_;
};

} // namespace ovc
