// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/gl_staging.h"

namespace ovc {

GlStaging::GlStaging(size_t bytes) : buffer_(bytes, GL_MAP_WRITE_BIT), memory_(buffer_.memory()) {}

void GlStaging::copy(size_t from, size_t bytes, uint32_t buffer, uint64_t to) {
    glCopyNamedBufferSubData(buffer_.id(), buffer, GLintptr(from), GLintptr(to), GLsizeiptr(bytes));
}

uint64_t GlStaging::fence() {
    fences_.emplace_back();
    return passed_ + fences_.size();
}

void GlStaging::wait(uint64_t fence) {
    for (; passed_ < fence && !fences_.empty(); ++passed_) {
        fences_.front().wait();
        fences_.pop_front();
    }
}

} // namespace ovc
