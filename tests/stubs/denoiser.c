/* SPDX-License-Identifier: Apache-2.0 */
/* Stands in for Open Image Denoise: it has the functions of its C API that are used, refuses what
 * that would refuse, and mixes its pictures in known shares, so that a test sees what it was given.
 */
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static const char* failure;
static float* images[4]; /* color, albedo, normal, output */
static size_t pixels;
static bool is_hdr, is_committed;

static const char* const kImages[] = {"color", "albedo", "normal", "output"};

void* oidnNewDevice(int type) {
    failure = type == 1 ? NULL : "no such device";
    memset(images, 0, sizeof(images));
    is_hdr = is_committed = false;
    return &failure;
}

void oidnCommitDevice(void* device) {
    (void)device;
}

int oidnGetDeviceError(void* device, const char** message) {
    (void)device;
    *message = failure;
    return failure ? 3 : 0;
}

void oidnReleaseDevice(void* device) {
    (void)device;
}

void* oidnNewFilter(void* device, const char* type) {
    if (strcmp(type, "RT") != 0)
        failure = "unknown filter type";
    return device;
}

void oidnSetSharedFilterImage(void* filter, const char* name, void* data, int format, size_t width,
                              size_t height, size_t offset, size_t pixel_stride,
                              size_t row_stride) {
    (void)filter;
    if (format != 3 || offset != 0 || pixel_stride != 0 || row_stride != 0)
        failure = "unsupported image format";
    for (int i = 0; i < 4; ++i)
        if (strcmp(name, kImages[i]) == 0)
            images[i] = data;
    pixels = width * height;
}

void oidnSetFilterBool(void* filter, const char* name, bool value) {
    (void)filter;
    if (strcmp(name, "hdr") == 0)
        is_hdr = value;
}

void oidnCommitFilter(void* filter) {
    (void)filter;
    is_committed = true;
}

void oidnExecuteFilter(void* filter) {
    (void)filter;
    if (!is_committed || !is_hdr || !images[0] || !images[1] || !images[2] || !images[3])
        failure = "the filter is not complete";
    if (failure)
        return;
    for (size_t i = 0; i < 3 * pixels; ++i)
        images[3][i] = 0.5f * images[0][i] + 0.25f * images[1][i] + 0.125f * images[2][i];
}

void oidnReleaseFilter(void* filter) {
    (void)filter;
}
