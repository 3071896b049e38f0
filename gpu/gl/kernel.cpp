// SPDX-License-Identifier: Apache-2.0
// Kernel: expands includes, compiles, and rewrites logs so that they name the file.
#include "gpu/gl/kernel.h"

#include "core/text/format_text.h"
#include "gpu/gl/program_store.h"
#include "gpu/gl/workarounds.h"
#include "shaders/layout.h"
#include "shaders/sources.h"

#include <algorithm>
#include <cassert>
#include <regex>

namespace ovc {

/// A program that the driver may still be at work on.
struct LinkingProgram {
    struct Stage {
        ShaderStage stage;
        std::string source;
        std::vector<std::string> files;
    };
    std::vector<Stage> stages;
    std::vector<gl::Shader> shaders; // none if it comes from the store
    gl::Program program;
};

namespace {

using ExpandedStage = LinkingProgram::Stage;

const ShaderSource* find_source(std::string_view name) {
    for (const ShaderSource& source : shader_sources())
        if (source.name == name)
            return &source;
    return nullptr;
}

/// Appends the file line by line; returns the name of a file that is missing, or nothing.
std::string append_expanded(std::string_view name, const std::string& defines,
                            std::vector<std::string>& files, std::string& out) {
    const ShaderSource* source = find_source(name);
    if (!source)
        return std::string(name);
    const size_t number = files.size();
    files.emplace_back(name);
    int line = 0;
    for (size_t at = 0; at < source->text.size();) {
        const size_t end = std::min(source->text.find('\n', at), source->text.size());
        const std::string_view text = source->text.substr(at, end - at);
        at = end + 1;
        ++line;
        constexpr std::string_view include = "#include \"";
        if (text.starts_with(include)) {
            const std::string_view rest = text.substr(include.size());
            out += format_text("#line 1 {}\n", files.size());
            if (std::string missing =
                    append_expanded(rest.substr(0, rest.find('"')), {}, files, out);
                !missing.empty())
                return missing;
            out += format_text("#line {} {}\n", line + 1, number);
            continue;
        }
        out += text;
        out += '\n';
        if (text.starts_with("#version"))
            out += format_text("{}#line {} {}\n", defines, line + 1, number);
    }
    return {};
}

std::string info_log(GLuint id, bool program) {
    GLint length = 0;
    (program ? glGetProgramiv : glGetShaderiv)(id, GL_INFO_LOG_LENGTH, &length);
    std::string log(size_t(std::max(length, 1)), '\0');
    (program ? glGetProgramInfoLog : glGetShaderInfoLog)(id, length, nullptr, log.data());
    log.resize(std::min(log.find('\0'), log.size()));
    return log;
}

gl::Shader begin_compile(const ExpandedStage& expanded) {
    gl::Shader shader(glCreateShader(expanded.stage.stage));
    const char* text = expanded.source.c_str();
    glShaderSource(shader.id(), 1, &text, nullptr);
    glCompileShader(shader.id());
    return shader;
}

Result<Done> check_compiled(const gl::Shader& shader, const ExpandedStage& expanded) {
    GLint ok = GL_FALSE;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
    if (ok)
        return Done{};
    return Error{
        format_text("the driver does not compile {}: {}", expanded.stage.source,
                    rewrite_log(info_log(shader.id(), /* program= */ false), expanded.files))};
}

/// Returns the renderer's name as a comment (Workaround::RendererInSources).
std::string driver_line() {
    if (!needs(Workaround::RendererInSources))
        return {};
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return format_text("// {}\n", renderer ? renderer : "");
}

bool compiles_fragment_shaders() {
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const std::string_view name = renderer ? renderer : "";
    return !needs(Workaround::NarrowFragments) || name.find("512 bits") == name.npos;
}

std::vector<std::string> sources_of(std::span<const ExpandedStage> stages) {
    std::vector<std::string> sources;
    for (const ExpandedStage& stage : stages)
        sources.push_back(stage.source);
    return sources;
}

} // namespace

std::vector<ShaderStage> stages_of(const ShaderConfig& config) {
    if (config.compute)
        return {{GL_COMPUTE_SHADER, "trace.comp.glsl"}};
    return {{GL_VERTEX_SHADER, "fullscreen.vert.glsl"}, {GL_FRAGMENT_SHADER, "trace.frag.glsl"}};
}

std::string ShaderConfig::defines() const {
    assert(pool_buffers > 0 && buffer_bits <= OVC_MAX_BUFFER_BITS && stack_depth > 0 && packet > 0);
    std::string each_buffer;
    for (uint32_t i = 0; i < pool_buffers; ++i)
        each_buffer += format_text("do_with({}) ", i);
    return format_text("#define OVC_ANY_HIT {}\n"
                       "#define OVC_CERTIFY {}\n"
                       "#define OVC_PORTALS {}\n"
                       "#define OVC_FLOAT_PAIRS {}\n"
                       "#define OVC_MAY_WAIT {}\n"
                       "#define OVC_TELL_ACTIVE {}\n"
                       "#define OVC_LOOSE_PAIRS {}\n"
                       "#define OVC_POOL_BUFFERS {}\n"
                       "#define OVC_EACH_BUFFER(do_with) {}\n"
                       "#define OVC_BUFFER_BITS {}\n"
                       "#define OVC_STACK_DEPTH {}\n"
                       "#define OVC_STACK {}\n"
                       "#define OVC_PACKET {}\n"
                       "#define OVC_CLAIMS {}\n"
                       "#define OVC_REFILL {}\n"
                       "#define OVC_BRANCHES {}\n"
                       "#define OVC_READS {}\n"
                       "#define OVC_GROUP_SIZE {}\n"
                       "#define OVC_MAX_ROUNDS {}\n"
                       "#define OVC_COUNTS {}\n",
                       any_hit, certify, portals, float_pairs, may_wait, tell_active, loose_pairs,
                       pool_buffers, each_buffer, buffer_bits, stack_depth, int(stack), packet,
                       claims, refill, branches, int(reads), group_size, max_rounds, counts);
}

/// Does everything that asks nothing of the driver that it would have to wait for.
static Result<LinkingProgram> begin_link(std::span<const ShaderStage> stages,
                                         const std::string& defines) {
    const auto is_fragment = [](const ShaderStage& s) { return s.stage == GL_FRAGMENT_SHADER; };
    if (std::any_of(stages.begin(), stages.end(), is_fragment) && !compiles_fragment_shaders())
        return Error{
            "llvmpipe crashes on fragment shaders where LP_NATIVE_VECTOR_WIDTH is 512: take the "
            "compute kernel, or unset LP_NATIVE_VECTOR_WIDTH"};
    LinkingProgram linking{{}, {}, gl::Program(glCreateProgram())};
    for (const ShaderStage& stage : stages) {
        ExpandedStage next{stage, {}, {}};
        Result<std::string> source =
            expand_shader(stage.source, driver_line() + defines, next.files);
        if (!source)
            return source.error();
        next.source = std::move(*source);
        linking.stages.push_back(std::move(next));
    }
    const GLuint program = linking.program.id();
    if (ProgramStore(ProgramStore::default_folder()).load(sources_of(linking.stages), program))
        return linking;
    for (const ExpandedStage& stage : linking.stages) {
        linking.shaders.push_back(begin_compile(stage));
        glAttachShader(program, linking.shaders.back().id());
    }
    glProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    glLinkProgram(program);
    return linking;
}

static Result<gl::Program> finish_link(LinkingProgram linking) {
    if (linking.shaders.empty())
        return std::move(linking.program);
    for (size_t i = 0; i < linking.shaders.size(); ++i)
        if (const Result<Done> ok = check_compiled(linking.shaders[i], linking.stages[i]); !ok)
            return ok.error();
    GLint ok = GL_FALSE;
    glGetProgramiv(linking.program.id(), GL_LINK_STATUS, &ok);
    if (!ok)
        return Error{"the driver does not link the kernel: " +
                     info_log(linking.program.id(), /* program= */ true)};
    ProgramStore(ProgramStore::default_folder())
        .keep(sources_of(linking.stages), linking.program.id());
    return std::move(linking.program);
}

Result<gl::Program> link_program(std::span<const ShaderStage> stages, const std::string& defines) {
    Result<LinkingProgram> linking = begin_link(stages, defines);
    if (!linking)
        return linking.error();
    return finish_link(std::move(*linking));
}

Result<std::string> expand_shader(std::string_view name, const std::string& defines,
                                  std::vector<std::string>& files) {
    std::string out;
    const std::string missing = append_expanded(name, defines, files, out);
    if (!missing.empty())
        return Error{format_text("no shader source is called '{}'", missing)};
    return out;
}

std::string rewrite_log(const std::string& log, const std::vector<std::string>& files) {
    static const std::regex place(R"((\d+)[:(](\d+)\)?)", std::regex::optimize);
    std::string out;
    for (size_t at = 0; at < log.size();) {
        const size_t end = std::min(log.find('\n', at), log.size());
        const std::string line = log.substr(at, end - at);
        at = end + 1;
        std::smatch match;
        const bool named = std::regex_search(line, match, place) && match.position() == 0 &&
                           match[1].length() < 6 && size_t(std::stoi(match[1])) < files.size();
        out +=
            named ? files[size_t(std::stoi(match[1]))] + ":" + match[2].str() + match.suffix().str()
                  : line;
        out += '\n';
    }
    return out;
}

KernelCache::KernelCache() = default;
KernelCache::KernelCache(KernelCache&&) noexcept = default;
KernelCache& KernelCache::operator=(KernelCache&&) noexcept = default;
KernelCache::~KernelCache() = default;

Result<GLuint> KernelCache::program(const ShaderConfig& config) {
    for (const Compiled& compiled : programs_)
        if (compiled.config == config)
            return compiled.program.id();
    const auto begun = std::ranges::find(begun_, config, &Begun::config);
    Result<gl::Program> program = Error{};
    if (begun == begun_.end()) {
        program = link_program(stages_of(config), config.defines());
    } else {
        const auto linking = std::move(begun->linking);
        begun_.erase(begun); // once, whatever comes of it
        program = finish_link(std::move(*linking));
    }
    if (!program)
        return program.error();
    programs_.push_back({config, std::move(*program)});
    return programs_.back().program.id();
}

void KernelCache::begin(const ShaderConfig& config) {
    if (std::ranges::find(programs_, config, &Compiled::config) != programs_.end() ||
        std::ranges::find(begun_, config, &Begun::config) != begun_.end())
        return;
    if (Result<LinkingProgram> linking = begin_link(stages_of(config), config.defines()))
        begun_.push_back({config, std::make_unique<LinkingProgram>(std::move(*linking))});
}

bool KernelCache::is_ready(const ShaderConfig& config) const {
    const auto begun = std::ranges::find(begun_, config, &Begun::config);
    if (begun == begun_.end() || begun->linking->shaders.empty() ||
        !epoxy_has_gl_extension("GL_KHR_parallel_shader_compile"))
        return true;
    GLint complete = GL_TRUE;
    glGetProgramiv(begun->linking->program.id(), GL_COMPLETION_STATUS_KHR, &complete);
    return complete == GL_TRUE;
}

} // namespace ovc
