// SPDX-License-Identifier: Apache-2.0
// LateGl: takes the places of GL's functions in libepoxy's table.
#include "gpu/late/late_gl.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace ovc {
namespace {

LateGl* late = nullptr;
constexpr int kRubbish = 0xa5;

/// GL's own function of a place in libepoxy's table.
template <auto& Place>
std::remove_cvref_t<decltype(Place)> real = nullptr;

} // namespace

struct LateGl::Hooks {
    /// Puts `function` in the place.
    template <auto& Place>
    static void take(const char* name, std::remove_cvref_t<decltype(Place)> function) {
        real<Place> =
            reinterpret_cast<std::remove_cvref_t<decltype(Place)>>(eglGetProcAddress(name));
        assert(real<Place>);
        Place = function;
        late->restore_.emplace_back([] { Place = real<Place>; });
    }

    /// A function that waits in the list, with its arguments.
    template <auto& Place, class Function = std::remove_cvref_t<decltype(Place)>>
    struct Listed;
    template <auto& Place, class... Arguments>
    struct Listed<Place, void (*)(Arguments...)> {
        static void call(Arguments... arguments) {
            late->add([=] { real<Place>(arguments...); });
        }
    };
    /// A function that needs everything before it.
    template <auto& Place, class Function = std::remove_cvref_t<decltype(Place)>>
    struct Waiting;
    template <auto& Place, class Value, class... Arguments>
    struct Waiting<Place, Value (*)(Arguments...)> {
        static Value call(Arguments... arguments) {
            late->run_all();
            return real<Place>(arguments...);
        }
    };

    template <auto& Place>
    static void list(const char* name) {
        take<Place>(name, Listed<Place>::call);
    }
    template <auto& Place>
    static void wait(const char* name) {
        take<Place>(name, Waiting<Place>::call);
    }

    static void use_program(GLuint program);
    static void take_all();

    static void sub_data(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data) {
        const auto* const bytes = static_cast<const std::byte*>(data);
        late->add([=, copy = std::vector(bytes, bytes + size)] {
            real<epoxy_glNamedBufferSubData>(buffer, offset, size, copy.data());
        });
    }
    static void clear(GLuint buffer, GLenum internal, GLintptr offset, GLsizeiptr size,
                      GLenum format, GLenum type, const void* data) {
        GLuint word = 0;
        std::memcpy(&word, data, sizeof(word));
        late->add([=] {
            real<epoxy_glClearNamedBufferSubData>(buffer, internal, offset, size, format, type,
                                                  &word);
        });
    }
    static void copy(GLuint from, GLuint to, GLintptr from_offset, GLintptr to_offset,
                     GLsizeiptr size) {
        late->add_copy(
            [=] { real<epoxy_glCopyNamedBufferSubData>(from, to, from_offset, to_offset, size); },
            from, to, to_offset, size);
    }
    static void read_pixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format,
                            GLenum type, void* to) {
        const auto read = [=] { real<epoxy_glReadPixels>(x, y, width, height, format, type, to); };
        if (late->pack_buffer_ == 0) {
            late->run_all();
            read();
            return;
        }
        assert(format == GL_RGBA_INTEGER && type == GL_UNSIGNED_INT);
        late->add_copy(read, 0, late->pack_buffer_, reinterpret_cast<GLintptr>(to),
                       GLsizeiptr(width) * height * 16);
    }
    static void bind_buffer(GLenum target, GLuint buffer) {
        if (target == GL_PIXEL_PACK_BUFFER)
            late->pack_buffer_ = buffer;
        Listed<epoxy_glBindBuffer>::call(target, buffer);
    }
    static void* map(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
        late->run_all();
        void* const memory = real<epoxy_glMapNamedBufferRange>(buffer, offset, length, access);
        if (memory && (access & GL_MAP_PERSISTENT_BIT) && (access & GL_MAP_READ_BIT))
            late->mapped_[buffer] = static_cast<std::byte*>(memory) - offset;
        return memory;
    }
    static void texture_buffer(GLuint texture, GLenum format, GLuint buffer, GLintptr offset,
                               GLsizeiptr size) {
        late->texture_buffers_[texture] = buffer;
        real<epoxy_glTextureBufferRange>(texture, format, buffer, offset, size);
    }
    static void bind_image(GLuint unit, GLuint texture, GLint level, GLboolean layered, GLint layer,
                           GLenum access, GLenum format) {
        late->written_units_[unit] = access == GL_READ_ONLY ? 0 : late->texture_buffers_[texture];
        Listed<epoxy_glBindImageTexture>::call(unit, texture, level, layered, layer, access,
                                               format);
    }
    static void dispatch(GLuint x, GLuint y, GLuint z) {
        late->add_shader([=] { real<epoxy_glDispatchCompute>(x, y, z); });
    }
    static void draw(GLenum mode, GLint first, GLsizei count) {
        late->add_shader([=] { real<epoxy_glDrawArrays>(mode, first, count); });
    }
    static void barrier(GLbitfield bits) {
        late->add_barrier([=] { real<epoxy_glMemoryBarrier>(bits); });
    }
    static GLsync fence(GLenum, GLbitfield) { return reinterpret_cast<GLsync>(late->add_mark()); }
    static GLenum wait_for(GLsync fence, GLbitfield, GLuint64) {
        return late->wait(reinterpret_cast<Mark>(fence));
    }
    static void delete_fence(GLsync) {}
    static void begin_query(GLenum target, GLuint query) {
        late->query_ = query;
        Listed<epoxy_glBeginQuery>::call(target, query);
    }
    static void end_query(GLenum target) {
        Listed<epoxy_glEndQuery>::call(target);
        late->query_ends_[late->query_] = late->add_mark();
    }
    static void query_result(GLuint query, GLenum what, GLuint64* result) {
        late->run_until(late->query_ends_[query]);
        real<epoxy_glGetQueryObjectui64v>(query, what, result);
    }
    static void flush() {} // a command that is sent need not be carried out soon
};

void LateGl::Hooks::take_all() {
    list<epoxy_glUseProgram>("glUseProgram");
    list<epoxy_glBindTextureUnit>("glBindTextureUnit");
    list<epoxy_glBindBufferRange>("glBindBufferRange");
    list<epoxy_glProgramUniform1i>("glProgramUniform1i");
    list<epoxy_glBindFramebuffer>("glBindFramebuffer");
    list<epoxy_glBindVertexArray>("glBindVertexArray");
    list<epoxy_glViewport>("glViewport");
    list<epoxy_glDisable>("glDisable");
    wait<epoxy_glFinish>("glFinish");
    wait<epoxy_glBufferData>("glBufferData"); // of the buffer that is bound
    wait<epoxy_glGetNamedBufferSubData>("glGetNamedBufferSubData");
    wait<epoxy_glClearNamedBufferData>("glClearNamedBufferData");
    wait<epoxy_glDeleteBuffers>("glDeleteBuffers");
    wait<epoxy_glDeleteTextures>("glDeleteTextures");
    wait<epoxy_glDeleteFramebuffers>("glDeleteFramebuffers");
    wait<epoxy_glDeleteVertexArrays>("glDeleteVertexArrays");
    wait<epoxy_glDeleteQueries>("glDeleteQueries");
    wait<epoxy_glDeleteProgram>("glDeleteProgram");
    take<epoxy_glNamedBufferSubData>("glNamedBufferSubData", sub_data);
    take<epoxy_glClearNamedBufferSubData>("glClearNamedBufferSubData", clear);
    take<epoxy_glCopyNamedBufferSubData>("glCopyNamedBufferSubData", copy);
    take<epoxy_glReadPixels>("glReadPixels", read_pixels);
    take<epoxy_glBindBuffer>("glBindBuffer", bind_buffer);
    take<epoxy_glMapNamedBufferRange>("glMapNamedBufferRange", map);
    take<epoxy_glTextureBufferRange>("glTextureBufferRange", texture_buffer);
    take<epoxy_glBindImageTexture>("glBindImageTexture", bind_image);
    take<epoxy_glDispatchCompute>("glDispatchCompute", dispatch);
    take<epoxy_glDrawArrays>("glDrawArrays", draw);
    take<epoxy_glMemoryBarrier>("glMemoryBarrier", barrier);
    take<epoxy_glFenceSync>("glFenceSync", fence);
    take<epoxy_glClientWaitSync>("glClientWaitSync", wait_for);
    take<epoxy_glDeleteSync>("glDeleteSync", delete_fence);
    take<epoxy_glFlush>("glFlush", flush);
    take<epoxy_glBeginQuery>("glBeginQuery", begin_query);
    take<epoxy_glEndQuery>("glEndQuery", end_query);
    take<epoxy_glGetQueryObjectui64v>("glGetQueryObjectui64v", query_result);
}

LateGl::LateGl(unsigned seed, Lie lie) : lie_(lie), random_(seed) {
    assert(!late);
    late = this;
    Hooks::take_all();
}

LateGl::~LateGl() {
    run_all();
    for (const auto& restore : restore_)
        restore();
    late = nullptr;
}

void LateGl::add(std::function<void()> run, Mark mark) {
    list_.push_back({std::move(run), mark});
    if (random_() % 64 == 0) // the device gets around to some of it
        for (size_t count = random_() % list_.size(); count > 0; --count)
            run_next();
}

/// The driver itself may be late as well, so it is to be done with what comes before the mark.
LateGl::Mark LateGl::add_mark() {
    const Mark mark = ++last_mark_;
    pending_marks_.insert(mark);
    add([] { real<epoxy_glFinish>(); }, mark);
    return mark;
}

void LateGl::run_until(Mark mark) {
    while (pending_marks_.contains(mark))
        run_next();
}

void LateGl::run_next() {
    if (list_.begin() == first_shader_)
        first_shader_ = list_.end();
    const Command next = std::move(list_.front());
    list_.pop_front();
    pending_marks_.erase(next.mark);
    next.run();
}

void LateGl::run_all() {
    while (!list_.empty())
        run_next();
}

void LateGl::add_shader(std::function<void()> run) {
    for (const GLuint buffer : written_units_)
        if (buffer != 0)
            unordered_.insert(buffer);
    // llvmpipe itself is to be done with it (Workaround::FinishedPass).
    const auto run_and_finish = [this, run = std::move(run)] {
        run();
        real<epoxy_glFinish>();
        --shaders_;
    };
    list_.push_back({run_and_finish});
    max_shaders_ = std::max(max_shaders_, ++shaders_);
    if (first_shader_ == list_.end())
        first_shader_ = std::prev(list_.end());
}

void LateGl::add_barrier(std::function<void()> run) {
    if (lie_ == Lie::BarriersDoNothing)
        return;
    unordered_.clear();
    first_shader_ = list_.end();
    add(std::move(run));
}

void LateGl::add_copy(std::function<void()> run, GLuint from, GLuint to, GLintptr offset,
                      GLsizeiptr bytes) {
    if (const auto mapped = mapped_.find(to); mapped != mapped_.end())
        std::memset(mapped->second + offset, kRubbish, size_t(bytes));
    if (unordered_.contains(from) && first_shader_ != list_.end())
        list_.insert(first_shader_, {std::move(run)});
    else
        add(std::move(run));
}

GLenum LateGl::wait(Mark fence) {
    if (lie_ == Lie::FencesArePassed || !pending_marks_.contains(fence))
        return GL_ALREADY_SIGNALED;
    if (random_() % 3 == 0)
        return GL_TIMEOUT_EXPIRED; // whoever waits asks again
    run_until(fence);
    return GL_CONDITION_SATISFIED;
}

} // namespace ovc
