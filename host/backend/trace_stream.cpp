// SPDX-License-Identifier: Apache-2.0
// The loop that reads rays, traces them and writes their answers.
#include "host/backend/trace_stream.h"

#include "host/backend/ray_text.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

namespace ovc {

static_assert(std::endian::native == std::endian::little, "the binary form is little-endian");

/// A batch waits this long for more rays: too short for a person to notice, and long enough for a
/// pipe to be filled again.
static constexpr int kMillisecondsPatience = 20;
static constexpr size_t kReadBytes = size_t(1) << 16;
/// No ray takes more characters than this; a longer line is not text.
static constexpr size_t kLongestLine = 4096;

class TraceStream {
public:
    TraceStream(Backend& backend, int in, int out, const TraceOptions& options)
        : backend_(backend), in_(in), out_(out), options_(options) {
        assert(options.batch_rays > 0); // answer() steps by it
    }

    Result<Done> run() {
        for (bool more = true; more;) {
            const Result<bool> got = read_some();
            if (!got)
                return got.error();
            more = *got;
            Result<Done> parsed = options_.binary ? parse_binary(!more) : parse_text(!more);
            if (!parsed || !more || rays_.size() >= options_.batch_rays || !more_is_waiting())
                if (Result<Done> answered = answer(); !answered)
                    return answered;
            if (!parsed)
                return parsed;
        }
        return Done{};
    }

private:
    /// Appends the bytes of one read() to pending_. Returns false at the end of the input.
    Result<bool> read_some() {
        const size_t old_size = pending_.size();
        pending_.resize(old_size + kReadBytes);
        ssize_t count;
        do
            count = read(in_, pending_.data() + old_size, kReadBytes);
        while (count < 0 && errno == EINTR);
        pending_.resize(old_size + size_t(std::max<ssize_t>(count, 0)));
        if (count < 0)
            return Error{fmt::format("cannot read rays: {}", std::strerror(errno))};
        return count > 0;
    }

    bool more_is_waiting() const {
        pollfd waiting{in_, POLLIN, 0};
        return poll(&waiting, 1, kMillisecondsPatience) > 0;
    }

    /// Turns whole lines into rays. A line without an end counts where at_end.
    Result<Done> parse_text(bool at_end) {
        size_t begin = 0;
        while (begin < pending_.size()) {
            size_t end = pending_.find('\n', begin);
            if (end == std::string::npos) {
                if (!at_end && pending_.size() - begin <= kLongestLine)
                    break;
                end = pending_.size();
            }
            ++line_;
            const std::string_view line = std::string_view(pending_).substr(begin, end - begin);
            if (line.size() > kLongestLine)
                return Error{fmt::format(
                    "standard input, line {}: longer than {} characters, expected a ray{}", line_,
                    kLongestLine,
                    line.find('\0') == line.npos ? "" : "; rays that are no text need --binary")};
            if (!is_blank_line(line)) {
                const Result<Ray> ray = parse_ray(line);
                if (!ray)
                    return Error{
                        fmt::format("standard input, line {}: {}", line_, ray.error().message)};
                rays_.push_back(*ray);
            }
            begin = end + 1;
        }
        pending_.erase(0, begin);
        return Done{};
    }

    Result<Done> parse_binary(bool at_end) {
        const size_t count = pending_.size() / sizeof(Ray);
        const size_t old_count = rays_.size();
        rays_.resize(old_count + count);
        std::memcpy(static_cast<void*>(rays_.data() + old_count), pending_.data(),
                    count * sizeof(Ray));
        pending_.erase(0, count * sizeof(Ray));
        line_ += count;
        if (at_end && !pending_.empty())
            return Error{fmt::format("standard input, ray {}: found {} bytes, expected {}",
                                     line_ + 1, pending_.size(), sizeof(Ray))};
        return Done{};
    }

    /// Traces the rays that have been read, and writes the answers.
    Result<Done> answer() {
        for (size_t first = 0; first < rays_.size(); first += options_.batch_rays) {
            const size_t count = std::min(options_.batch_rays, rays_.size() - first);
            const std::span<const Ray> rays(rays_.data() + first, count);
            Result<Done> done = options_.any ? answer_occlusion(rays) : answer_nearest(rays);
            if (!done)
                return done;
        }
        rays_.clear();
        return Done{};
    }

    Result<Done> answer_nearest(std::span<const Ray> rays) {
        hits_.resize(rays.size());
        if (Result<Done> done = backend_.intersect(rays, {}, hits_); !done)
            return done;
        if (options_.binary)
            return write_all(hits_.data(), hits_.size() * sizeof(Hit));
        text_.clear();
        for (const Hit& hit : hits_)
            append_hit(text_, hit);
        return write_all(text_.data(), text_.size());
    }

    Result<Done> answer_occlusion(std::span<const Ray> rays) {
        occluded_.resize(rays.size());
        if (Result<Done> done = backend_.occluded(rays, {}, occluded_); !done)
            return done;
        if (options_.binary)
            return write_all(occluded_.data(), occluded_.size());
        text_.clear();
        for (const uint8_t hit : occluded_)
            text_ += hit ? "hit\n" : "miss\n";
        return write_all(text_.data(), text_.size());
    }

    Result<Done> write_all(const void* data, size_t size) {
        const char* bytes = static_cast<const char*>(data);
        while (size > 0) {
            const ssize_t count = write(out_, bytes, size);
            if (count < 0 && errno != EINTR)
                return Error{fmt::format("cannot write hits: {}", std::strerror(errno))};
            bytes += std::max<ssize_t>(count, 0);
            size -= size_t(std::max<ssize_t>(count, 0));
        }
        return Done{};
    }

    Backend& backend_;
    const int in_, out_;
    const TraceOptions options_;
    std::string pending_; // bytes that are read and no ray yet
    uint64_t line_ = 0;   // text lines, or binary rays, so far
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<uint8_t> occluded_;
    std::string text_;
};

Result<Done> trace_stream(Backend& backend, int in, int out, const TraceOptions& options) {
    return TraceStream(backend, in, out, options).run();
}

} // namespace ovc
