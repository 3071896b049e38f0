// SPDX-License-Identifier: Apache-2.0
// Streams: wraps the caller's functions as a StreamHost, and passes on the rays that it pushes.
#include "plugin/abi/stream_call.h"

#include "core/text/format_text.h"
#include "plugin/abi/float_mode.h"
#include "plugin/abi/query_call.h"
#include "plugin/structure/in_stream.h"

#include <algorithm>
#include <cassert>

namespace ovc {
namespace {

class CallbackHost final : public StreamHost {
public:
    CallbackHost(ovc_stream_t& stream, const ovc_stream_host& host, HostFloatMode& mode)
        : stream_(stream), host_(host), mode_(mode) {}

    bool more(RayStream& rays, size_t wanted) override {
        return call(rays, [&] { return host_.more(host_.user, &stream_, wanted); });
    }
    bool hits(RayStream& rays, std::span<const uint64_t> tokens,
              std::span<const Hit> hits) override {
        return answered(rays, {sizeof(ovc_stream_answers), tokens.size(), tokens.data(),
                               reinterpret_cast<const ovc_hit*>(hits.data()), nullptr});
    }
    bool occlusions(RayStream& rays, std::span<const uint64_t> tokens,
                    std::span<const uint8_t> occluded) override {
        return answered(rays, {sizeof(ovc_stream_answers), tokens.size(), tokens.data(), nullptr,
                               occluded.data()});
    }

private:
    bool answered(RayStream& rays, const ovc_stream_answers& answers) {
        return call(rays, [&] { return host_.answered(host_.user, &stream_, &answers); });
    }

    template <class Function>
    bool call(RayStream& rays, Function&& function) {
        stream_.rays = &rays;
        const int stop = mode_.call(function);
        stream_.rays = nullptr;
        const auto stopped = [](const AskedFilter& filter) { return filter.stopped(); };
        return stop == 0 && std::ranges::none_of(stream_.filters, stopped);
    }

    ovc_stream_t& stream_;
    const ovc_stream_host& host_;
    HostFloatMode& mode_;
};

/// Marks the scene as streaming on this thread while it lives.
class Streaming {
public:
    explicit Streaming(ovc_scene scene) : scene_(scene) {
        assert(scene_->streaming == std::thread::id()); // this thread has the scene's turn
        scene_->streaming = std::this_thread::get_id();
        scene_->stream.scene = scene;
        scene_->stream.magic = kStreamMagic;
        in_stream = true;
    }
    ~Streaming() {
        scene_->stream.magic = 0;
        scene_->stream.filters.clear();
        scene_->streaming = std::thread::id();
        in_stream = before_;
    }
    Streaming(const Streaming&) = delete;

private:
    ovc_scene scene_;
    const bool before_ = in_stream;
};

} // namespace

namespace {

/// Returns the filter of the query, which lives until the stream ends; null where it has none.
HitFilter* kept_filter(ovc_stream stream, const ovc_query& query) {
    if (!query.filter)
        return nullptr;
    for (AskedFilter& filter : stream->filters)
        if (filter.is_of(query.filter, query.filter_user))
            return &filter;
    return &stream->filters.emplace_back(query.filter, query.filter_user);
}

} // namespace

ovc_result stream(ovc_scene scene, const ovc_stream_host* host) {
    HostFloatMode mode;
    return on_scene(scene, "stream", [&] {
        if (!host)
            invalid("stream: host is NULL");
        check_size<ovc_stream_host>("ovc_stream_host", host->struct_size);
        if (!host->more || !host->answered)
            invalid("ovc_stream_host.more or answered is NULL");
        Structure& structure = committed(scene, "stream");
        const Streaming streaming(scene);
        CallbackHost callbacks(scene->stream, *host, mode);
        check(structure.stream(callbacks));
    });
}

ovc_result push(ovc_stream stream, const ovc_ray* rays, const uint64_t* tokens, size_t ray_count,
                uint32_t any_hit, const ovc_query* query) {
    if (!stream || stream->magic != kStreamMagic)
        return fail_without_device(OVC_ERROR_INVALID_ARGUMENT,
                                   "push: stream is NULL or not a stream");
    // Only the stream's own thread may push: others could not know when the stream ends.
    if (stream->scene->streaming != std::this_thread::get_id())
        return fail_without_device(OVC_ERROR_INVALID_STATE,
                                   "push: called from another thread than the stream's");
    return guard(stream->scene->device->messages, [&] {
        if (!stream->rays)
            throw Failure{OVC_ERROR_INVALID_STATE,
                          "push: called from outside of the functions of the stream's host"};
        if (ray_count && (!rays || !tokens))
            invalid("push: rays or tokens is NULL");
        if (any_hit > 1)
            invalid(format_text("push: any_hit is {}, expected 0 or 1", any_hit));
        const ovc_query asked = complete(query);
        refuse_notes("push", asked);
        refuse_progress("push", asked);
        check_structure("push", asked, committed(stream->scene, "push"));
        const Exclusions without = exclusions_of(asked, ray_count);
        HitFilter* const filter = kept_filter(stream, asked);
        std::vector<Ray> room;
        stream->rays->push({any_hit == 1,
                            rays_of(asked, rays, ray_count).in_double(room),
                            without.skip,
                            {tokens, ray_count},
                            without.after,
                            without.sieves.masks,
                            {&filter, filter ? size_t(1) : 0}});
    });
}

} // namespace ovc
