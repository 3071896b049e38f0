// SPDX-License-Identifier: Apache-2.0
// Window shows a picture while it is made. It is drawn by GLFW, which is loaded for --view and by
// nothing else.
#pragma once

#include "core/file/image.h"
#include "core/result.h"

#include <functional>
#include <memory>
#include <string>

namespace ovc {

class Window {
public:
    /// Opens a window with a thread of its own, which draws it. Its picture has this size, and it
    /// too, unless the user changes that. Error: GLFW is not there, or there is no display.
    static Result<std::unique_ptr<Window>> open(const std::string& title, uint32_t width,
                                                uint32_t height);
    ~Window();
    Window(const Window&) = delete;

    /// Shows an image of linear light, as sRGB, in the place of the one before. Nothing happens
    /// where the window is closed.
    void show(const Image& image);

    /// Returns once the user has closed the window, by its button or Escape, or goes_on() says no,
    /// which is asked some twenty times a second.
    void wait(const std::function<bool()>& goes_on) const;

private:
    struct Shared;
    explicit Window(std::unique_ptr<Shared> shared);

    std::unique_ptr<Shared> shared_; // with the thread
};

} // namespace ovc
