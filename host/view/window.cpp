// SPDX-License-Identifier: Apache-2.0
// GLFW and the few functions of OpenGL that draw pixels, all by name. Only the window's thread
// calls them.
#include "host/view/window.h"

#include "host/output/srgb.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

namespace ovc {

static constexpr const char* kGlfw = "libglfw.so.3";
static constexpr int kKeyEscape = 256, kIsPressed = 1; // of GLFW 3
static constexpr unsigned kColorBuffer = 0x4000, kRgb = 0x1907, kUnsignedByte = 0x1401,
                          kUnpackAlignment = 0x0cf5; // of OpenGL
static constexpr double kSecondsBetweenLooks = 0.05;

struct GlfwFunctions {
    int (*init)();
    void (*terminate)();
    int (*get_error)(const char** text);
    void* (*create_window)(int width, int height, const char* title, void* monitor, void* share);
    void (*make_current)(void* window);
    void* (*proc_address)(const char* name);
    int (*should_close)(void* window);
    int (*get_key)(void* window, int key);
    void (*swap_buffers)(void* window);
    void (*wait_events)(double seconds);
    void (*framebuffer_size)(void* window, int* width, int* height);
};

struct PixelDrawing {
    void (*clear)(unsigned mask);
    void (*viewport)(int x, int y, int width, int height);
    void (*raster_place)(float x, float y);
    void (*pixel_zoom)(float x, float y);
    void (*pixel_store)(unsigned name, int value);
    void (*draw_pixels)(int width, int height, unsigned format, unsigned type, const void* data);
};

template <class F>
static bool take(void* address, F& function) {
    function = reinterpret_cast<F>(address);
    return address != nullptr;
}

static Result<GlfwFunctions> load_glfw() {
    void* const library = dlopen(kGlfw, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!library)
        return Error{
            fmt::format("--view needs GLFW (Debian: libglfw3), and {} cannot be loaded", kGlfw)};
    GlfwFunctions glfw;
    const auto find = [&](const char* name, auto& function) {
        return take(dlsym(library, name), function);
    };
    if (find("glfwInit", glfw.init) && find("glfwTerminate", glfw.terminate) &&
        find("glfwGetError", glfw.get_error) && find("glfwCreateWindow", glfw.create_window) &&
        find("glfwMakeContextCurrent", glfw.make_current) &&
        find("glfwGetProcAddress", glfw.proc_address) &&
        find("glfwWindowShouldClose", glfw.should_close) && find("glfwGetKey", glfw.get_key) &&
        find("glfwSwapBuffers", glfw.swap_buffers) &&
        find("glfwWaitEventsTimeout", glfw.wait_events) &&
        find("glfwGetFramebufferSize", glfw.framebuffer_size))
        return glfw;
    return Error{fmt::format("--view: {} lacks functions that are needed", kGlfw)};
}

static bool load_drawing(const GlfwFunctions& glfw, PixelDrawing& gl) {
    const auto find = [&](const char* name, auto& function) {
        return take(glfw.proc_address(name), function);
    };
    return find("glClear", gl.clear) && find("glViewport", gl.viewport) &&
           find("glRasterPos2f", gl.raster_place) && find("glPixelZoom", gl.pixel_zoom) &&
           find("glPixelStorei", gl.pixel_store) && find("glDrawPixels", gl.draw_pixels);
}

struct Window::Shared {
    GlfwFunctions glfw{};
    std::string title;
    uint32_t width = 0, height = 0;
    std::mutex mutex;
    std::vector<uint8_t> codes; // red, green, blue, row by row from the top; guarded by mutex
    std::atomic<bool> is_new = false, ends = false, is_closed = false;
    std::thread thread;

    void run(std::promise<Result<Done>> opened);
    void draw(void* window, const PixelDrawing& gl);
};

/// Draws the picture as large as the window allows, with its proportions.
void Window::Shared::draw(void* window, const PixelDrawing& gl) {
    int w = 0, h = 0;
    glfw.framebuffer_size(window, &w, &h);
    gl.viewport(0, 0, w, h);
    gl.clear(kColorBuffer);
    const float zoom = std::min(float(w) / float(width), float(h) / float(height));
    const float share_x = zoom * float(width) / float(std::max(w, 1));
    const float share_y = zoom * float(height) / float(std::max(h, 1));
    gl.raster_place(-std::min(share_x, 1.0f), std::min(share_y, 1.0f)); // the upper left corner
    gl.pixel_zoom(zoom, -zoom);
    gl.pixel_store(kUnpackAlignment, 1);
    {
        const std::lock_guard lock(mutex);
        gl.draw_pixels(int(width), int(height), kRgb, kUnsignedByte, codes.data());
    }
    glfw.swap_buffers(window);
}

void Window::Shared::run(std::promise<Result<Done>> opened) {
    const auto fail = [&](const char* what) {
        const char* text = nullptr;
        glfw.get_error(&text);
        opened.set_value(
            Error{fmt::format("--view: {}: {}", what, text ? text : "GLFW does not say why")});
        glfw.terminate();
        is_closed = true;
    };
    if (!glfw.init())
        return fail("there is no display");
    void* const window =
        glfw.create_window(int(width), int(height), title.c_str(), nullptr, nullptr);
    if (!window)
        return fail("no window can be opened");
    glfw.make_current(window);
    PixelDrawing gl{};
    if (!load_drawing(glfw, gl))
        return fail("OpenGL lacks functions that are needed");
    opened.set_value(Done{});
    int drawn_width = 0, drawn_height = 0;
    while (!ends && !glfw.should_close(window) && glfw.get_key(window, kKeyEscape) != kIsPressed) {
        int w = 0, h = 0;
        glfw.framebuffer_size(window, &w, &h);
        if (is_new.exchange(false) || w != drawn_width || h != drawn_height)
            draw(window, gl);
        drawn_width = w;
        drawn_height = h;
        glfw.wait_events(kSecondsBetweenLooks);
    }
    glfw.make_current(nullptr);
    glfw.terminate(); // which destroys the window
    is_closed = true;
}

Window::Window(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}

Result<std::unique_ptr<Window>> Window::open(const std::string& title, uint32_t width,
                                             uint32_t height) {
    const Result<GlfwFunctions> glfw = load_glfw();
    if (!glfw)
        return glfw.error();
    auto shared = std::make_unique<Shared>();
    shared->glfw = *glfw;
    shared->title = title;
    shared->width = width;
    shared->height = height;
    shared->codes.resize(size_t(3) * width * height);
    std::promise<Result<Done>> opened;
    std::future<Result<Done>> is_open = opened.get_future();
    shared->thread = std::thread(&Shared::run, shared.get(), std::move(opened));
    std::unique_ptr<Window> window(new Window(std::move(shared)));
    if (const Result<Done> done = is_open.get(); !done)
        return done.error();
    return window;
}

Window::~Window() {
    shared_->ends = true;
    shared_->thread.join();
}

void Window::show(const Image& image) {
    const std::lock_guard lock(shared_->mutex);
    for (size_t i = 0; i < image.pixels.size() && 3 * i < shared_->codes.size(); ++i)
        for (size_t channel = 0; channel < 3; ++channel)
            shared_->codes[3 * i + channel] = srgb_byte(image.pixels[i][int(channel)]);
    shared_->is_new = true;
}

void Window::wait(const std::function<bool()>& goes_on) const {
    while (!shared_->is_closed && goes_on())
        std::this_thread::sleep_for(std::chrono::duration<double>(kSecondsBetweenLooks));
}

} // namespace ovc
