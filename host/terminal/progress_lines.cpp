// SPDX-License-Identifier: Apache-2.0
// Each line is written at once, so that whoever reads a pipe need not wait for the next.
#include "host/terminal/progress_lines.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>

namespace ovc {

static constexpr double kSecondsBetweenEvents = 0.25;

Result<ProgressLines> ProgressLines::open(const std::string& path) {
    ProgressLines lines;
    if (path.empty())
        return lines;
    lines.file_.reset(path == "-" ? stdout : std::fopen(path.c_str(), "w"));
    if (!lines.file_)
        return Error{fmt::format("--progress: cannot open '{}': {}", path, std::strerror(errno))};
    lines.path_ = path;
    if (path != "-")
        std::signal(SIGPIPE, SIG_IGN); // a reader of the pipe that ends does not end the rendering
    return lines;
}

void ProgressLines::put(const std::string& line) {
    const bool written =
        std::fputs((line + "\n").c_str(), file_.get()) >= 0 && std::fflush(file_.get()) == 0;
    if (!written && failure_ == 0)
        failure_ = errno;
}

void ProgressLines::progress(uint32_t frame, double share, const RenderReport& report) {
    const double seconds = watch_.seconds();
    if (!file_ || seconds < next_seconds_)
        return;
    next_seconds_ = seconds + kSecondsBetweenEvents;
    put(nlohmann::ordered_json{{"event", "progress"},
                               {"frame", frame},
                               {"done", share},
                               {"seconds", seconds},
                               {"rays", report.rays.total()}}
            .dump());
}

void ProgressLines::picture(uint32_t frame, const std::string& file, bool finished) {
    if (file_)
        put(nlohmann::ordered_json{
            {"event", "picture"}, {"frame", frame}, {"file", file}, {"finished", finished}}
                .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

Result<Done> ProgressLines::end(bool complete) {
    if (file_)
        put(nlohmann::ordered_json{{"event", "end"}, {"complete", complete}}.dump());
    if (failure_ == 0 || failure_ == EPIPE)
        return Done{};
    return Error{
        fmt::format("--progress: lines of '{}' are lost: {}", path_, std::strerror(failure_))};
}

} // namespace ovc
