// SPDX-License-Identifier: Apache-2.0
// LateGl: stands between this process and its driver, for tests. It does what GL is asked to do as
// late as GL allows, and in another order where GL allows that, as a GPU may and llvmpipe does not.
#pragma once

#include "gpu/gl/gl.h"

#include <array>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace ovc {

/// While it lives, commands of the calling thread's context wait in a list. They are carried out
///   - when something is asked for that needs them: a fence, a query's result, memory that is read
///   or mapped;
///   - now and then, a few at a time.
/// A copy out of a buffer that a shader writes goes before the shader where no barrier is between
/// them. Mapped memory that the device will write holds rubbish until then.
class LateGl {
public:
    /// The effects of a missing wait, one of which a test may choose.
    enum class Lie { None, FencesArePassed, BarriersDoNothing };

    /// There is one at a time. A context is current, in which no pass is under way.
    explicit LateGl(unsigned seed, Lie lie = Lie::None);
    /// Carries out what is left.
    ~LateGl();
    LateGl(const LateGl&) = delete;

    /// Returns how many runs of a shader were waiting at most.
    size_t max_shaders() const { return max_shaders_; }

private:
    struct Hooks; // the functions that take the place of GL's
    /// A place in the sequence of commands that this process can wait for: of a fence, or the end
    /// of a query.
    using Mark = uint64_t;
    struct Command {
        std::function<void()> run;
        Mark mark = 0; // that is passed here; 0: none
    };

    void add(std::function<void()> run, Mark mark = 0);
    Mark add_mark();
    void run_until(Mark mark);
    void run_next();
    void run_all();
    void add_shader(std::function<void()> run);
    void add_barrier(std::function<void()> run);
    void add_copy(std::function<void()> run, GLuint from, GLuint to, GLintptr offset,
                  GLsizeiptr bytes);
    GLenum wait(Mark fence);

    const Lie lie_;
    std::mt19937 random_;
    std::list<Command> list_; // the next to be carried out comes first
    size_t shaders_ = 0;      // in the list
    size_t max_shaders_ = 0;
    Mark last_mark_ = 0;
    std::set<Mark> pending_marks_;
    GLuint query_ = 0;                    // that has begun
    std::map<GLuint, Mark> query_ends_;   // by the names of queries
    std::map<GLuint, std::byte*> mapped_; // buffers that this process reads
    GLuint pack_buffer_ = 0;
    std::map<GLuint, GLuint> texture_buffers_; // the buffer of a texture
    std::array<GLuint, 64> written_units_{};   // the buffer of an image that is written; or 0
    std::set<GLuint> unordered_;               // buffers that shaders write, with no barrier since
    std::list<Command>::iterator first_shader_ = list_.end(); // with no barrier since; or end()
    std::vector<std::function<void()>> restore_;
};

} // namespace ovc
