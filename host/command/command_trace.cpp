// SPDX-License-Identifier: Apache-2.0
// overcast trace: reads rays and writes their hits.
#include "host/arguments/arguments.h"
#include "host/arguments/backend_arguments.h"
#include "host/arguments/log_arguments.h"
#include "host/backend/device_opening.h"
#include "host/backend/trace_stream.h"
#include "host/command/command.h"
#include "host/ranks/join_ranks.h"
#include "host/ranks/shared_calls.h"
#include "host/scene/scene_source.h"
#include "host/terminal/interrupt.h"

#include <unistd.h>

namespace ovc {

static constexpr const char* kTraceExamples =
    R"(Standard input, one ray a line:    ox oy oz dx dy dz [tmin tmax]
Standard output, one line a ray:   t u v mesh prim   or   miss   (with --any: hit or miss)
The hit lies at o + t d = (1 - u - v) a + u b + v c of the triangle's corners a, b, c. Without tmin and tmax a ray
begins at 0 and never ends; d need not be of unit length, t counts in its lengths. Numbers in an answer
are the shortest that read back as the same doubles. Numbers of a ray are separated by blanks or tabs, never by commas;
one too small for a double is 0. What follows a # is passed over, and so are blank lines; any other line that is no ray
ends the program with an error that names it, after the answers to the rays before it.

With --binary a ray is 8 little-endian doubles (ox oy oz tmin dx dy dz tmax: the record ovc_ray of overcast.h), a hit 3
doubles and 2 unsigned 32-bit integers (t u v mesh prim: ovc_hit; a miss has t infinite and both integers 4294967295);
with --any as well an answer is one byte, 1 or 0.

Examples:
  echo 0 0 9  0 0 -1 | overcast trace dragon.ply
  overcast trace dragon.ply --any < rays.txt > shadows.txt
  overcast trace dragon.ply --binary --gpu-memory 64M < rays.bin > hits.bin)";

namespace {

class Trace final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description(
            "Answers rays: where each first hits the scene, or whether it hits it at all.");
        source_.add_to(app);
        app.add_flag("--any", options_.any, "Only whether a ray hits anything");
        app.add_flag("--binary", options_.binary,
                     "Records of doubles instead of lines, in and out");
        log_.add_to(app);
        backend_.add_to(app);
        app.footer(kTraceExamples);
    }

    Result<int> run() override {
        const Result<LogLevel> level = log_.resolve();
        if (!level)
            return level.error();
        Result<BackendOptions> backend_options = backend_.resolve();
        if (!backend_options)
            return backend_options.error();
        if (const Result<Done> fine = source_.check(); !fine)
            return fine.error();
        if (const Result<Done> joined = join_ranks("trace", *backend_options, source_); !joined)
            return joined.error();
        const Ranks* const ranks = Ranks::of_run();
        const LogSink log =
            standard_error_log(ranks && !ranks->is_first() ? LogLevel::Error : *level);
        prepare_process(*backend_options);
        DeviceOpening opening(*backend_options);
        source_.host_bytes = backend_options->host_bytes;
        const Result<Scene> scene = open_scene(source_, log);
        if (!scene)
            return scene.error();
        backend_options->saved = scene->saved;
        backend_options->on_disk = scene->on_disk.get();
        Result<std::unique_ptr<Backend>> backend =
            make_backend(scene->soup, *backend_options, log, opening);
        if (!backend)
            return backend.error();
        if (ranks && !ranks->is_first()) {
            const Result<Done> done = serve_calls(*ranks, {&*backend, 1});
            return done ? Result<int>(kExitOk) : done.error();
        }
        if (ranks)
            backend = make_shared_backend(*ranks, std::move(*backend), 0);
        if (isatty(STDIN_FILENO))
            say(log, LogLevel::Info,
                options_.binary
                    ? "reading rays from the terminal, 64 bytes each; Ctrl-D ends them"
                    : "reading rays from the terminal, one a line: ox oy oz dx dy dz [tmin tmax]; "
                      "Ctrl-D ends them");
        Result<Done> done = trace_stream(**backend, STDIN_FILENO, STDOUT_FILENO, options_);
        Ranks::fail_all_unless(done);
        if (done && ranks)
            done = end_calls(*ranks);
        if (!done)
            return done.error();
        return kExitOk;
    }

private:
    SceneArguments source_;
    TraceOptions options_;
    BackendArguments backend_;
    LogArguments log_{LogLevel::Info};
};

} // namespace

std::unique_ptr<Subcommand> make_trace() {
    return std::make_unique<Trace>();
}

} // namespace ovc
