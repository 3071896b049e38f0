// SPDX-License-Identifier: Apache-2.0
// Turns GL's error flag into a sentence.
#include "gpu/gl/gl_check.h"

#include "core/text/format_text.h"
#include "gpu/gl/gl.h"

namespace ovc {

Result<Done> check_gl(const char* doing) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR)
        return Done{};
    while (glGetError() != GL_NO_ERROR) {
    }
    if (error == GL_OUT_OF_MEMORY)
        return Error{
            format_text("the GPU is out of memory while {}; a smaller budget may work", doing),
            ErrorKind::OutOfGpuMemory};
    return Error{format_text("OpenGL error 0x{} while {}", hexadecimal(error, 4), doing)};
}

} // namespace ovc
