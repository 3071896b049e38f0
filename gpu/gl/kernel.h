// SPDX-License-Identifier: Apache-2.0
// Kernel: turns a ShaderConfig into a program. A cache keeps the programs by their configuration.
#pragma once

#include "core/result.h"
#include "gpu/gl/gl_object.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// The rounds of an invocation's loops after which the kernel gives its ray up, on drivers that
/// would end the loops a little later (Workaround::CountedRounds).
inline constexpr uint32_t kMaxCountedRounds = 65000;

/// Where a ray's stack lies: in an array of its invocation, which a GPU keeps in memory, in
/// registers, or in memory that a work group of the compute kernel shares.
enum class StackPlace { Array, Registers, Shared };

/// The choice of a kernel, with every switch of shaders/config.glsl, as a value. The tracer derives
/// it from what the query, the pages and the driver need.
struct ShaderConfig {
    bool compute = false; // which wrapper; not a switch of config.glsl
    bool any_hit = false;
    bool certify = true;
    bool portals = false;
    bool float_pairs = false; // portals compute rays in pairs of floats
    bool may_wait = false;
    bool tell_active = false;
    bool loose_pairs = false;
    uint32_t pool_buffers = 1;
    uint32_t buffer_bits = 25;
    uint32_t stack_depth = 16;
    StackPlace stack = StackPlace::Registers;
    uint32_t packet = 1; // rays that an invocation traces together
    bool claims = false; // subgroups claim their rays from a counter
    bool refill = false; // a lane takes the next packet when its own is done; with claims
    bool branches = false;
    TexelReads reads = TexelReads::Images;
    uint32_t group_size = 64;         // of the compute kernel
    uint32_t max_rounds = 0x7fffffff; // of all loops of a ray
    bool counts = false;              // answers tell rounds and units; not with claims

    bool operator==(const ShaderConfig&) const = default;
    /// All defines, one a line, in fixed order.
    std::string defines() const;
};

/// Returns a source with its #include lines replaced by the embedded files, and `defines` after the
/// #version line. Lines keep their numbers by #line, whose second number counts the files in
/// `files`. Error: a file that is not embedded.
Result<std::string> expand_shader(std::string_view name, const std::string& defines,
                                  std::vector<std::string>& files);

/// Returns a driver's log with "2:57" or "2(57)" at the start of lines turned into
/// "traverse.glsl:57".
std::string rewrite_log(const std::string& log, const std::vector<std::string>& files);

struct ShaderStage {
    GLenum stage;
    std::string_view source; // "trace.frag.glsl"
};

/// Returns the stages of a kernel.
std::vector<ShaderStage> stages_of(const ShaderConfig& config);

/// Returns a program of the stages, each expanded with `defines`; from the ProgramStore if it is
/// kept there. The context must be current. Error: the driver's log.
Result<gl::Program> link_program(std::span<const ShaderStage> stages, const std::string& defines);

struct LinkingProgram;

/// Keeps programs. All calls need the context current.
class KernelCache {
public:
    KernelCache();
    KernelCache(KernelCache&&) noexcept;
    KernelCache& operator=(KernelCache&&) noexcept;
    ~KernelCache();

    /// The program for `config`, compiled on first use. Error: the driver's log.
    Result<GLuint> program(const ShaderConfig& config);
    /// Has the driver begin to compile the program, beside other work if it can.
    void begin(const ShaderConfig& config);
    /// Whether program() would not wait for a program that begin() was called for, as far as the
    /// driver tells (GL_KHR_parallel_shader_compile).
    bool is_ready(const ShaderConfig& config) const;

private:
    struct Compiled {
        ShaderConfig config;
        gl::Program program;
    };
    struct Begun {
        ShaderConfig config;
        std::unique_ptr<LinkingProgram> linking;
    };
    std::vector<Compiled> programs_;
    std::vector<Begun> begun_;
};

} // namespace ovc
