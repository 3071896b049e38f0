// SPDX-License-Identifier: Apache-2.0
// overcast.h for C++17 and later: owners for its handles, spans for its buffers, exceptions for its
// errors. It adds no more than that: overcast.h and docs/reference/abi.md say what a call does and
// promises, and any call may be made through the table as well.
#pragma once

#include "overcast.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#if __cplusplus >= 202002L
#include <span>
#endif

namespace overcast {

#if __cplusplus >= 202002L
template <class T>
using Span = std::span<T>;
#else
/// As much of std::span as is needed here.
template <class T>
class Span {
public:
    Span() = default;
    Span(T* data, size_t size) : data_(data), size_(size) {}
    /// From a vector, an array, or whatever else has data() and size().
    template <class Range, class = decltype(std::declval<Range&>().data())>
    Span(Range&& range) : data_(range.data()), size_(range.size()) {}

    T* data() const { return data_; }
    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }

private:
    T* data_ = nullptr;
    size_t size_ = 0;
};
#endif

/// Thrown for a call that did not return OVC_OK: code() is its result, what() the sentence of
/// last_error().
class Error : public std::runtime_error {
public:
    Error(ovc_result code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ovc_result code() const { return code_; }

private:
    ovc_result code_;
};

/// Returns a struct of overcast.h with its struct_size set and all else the default.
template <class T>
T make() {
    T value{};
    value.struct_size = sizeof(T);
    return value;
}

/// Three rows of four, as in ovc_instance.
using Transform = std::array<double, 12>;

/// Allocates memory that is aligned to 64, as ovc_scene_config.saved has to be.
template <class T>
struct AlignedAllocator {
    using value_type = T;
    static constexpr std::align_val_t kAlignment{64};

    AlignedAllocator() = default;
    template <class Other>
    AlignedAllocator(const AlignedAllocator<Other>&) {}
    T* allocate(size_t count) {
        return static_cast<T*>(::operator new(count * sizeof(T), kAlignment));
    }
    void deallocate(T* memory, size_t) noexcept { ::operator delete(memory, kAlignment); }
    friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
    friend bool operator!=(const AlignedAllocator&, const AlignedAllocator&) { return false; }
};

/// The bytes that Scene::save() returns.
struct SavedBytes : std::vector<std::byte, AlignedAllocator<std::byte>> {
    /// A copy for programs that were written for an ordinary vector.
    operator std::vector<std::byte>() const { return {begin(), end()}; }
};

/// Returns the table of the library that the program is linked with. Throws an Error where the
/// library is older than this header.
inline const ovc_api& linked_api() {
    const ovc_api* api = ovc_get_api(OVC_ABI_VERSION);
    if (api && api->struct_size >= sizeof(ovc_api))
        return *api;
    throw Error(OVC_ERROR_NO_DEVICE, "libovercast.so is older than overcast.h");
}

/// Prepares the process for devices; see ovc_api.prepare_process.
inline void prepare_process(ovc_kernel kernel = OVC_KERNEL_AUTO,
                            const ovc_api& api = linked_api()) {
    if (const ovc_result result = api.prepare_process(kernel); result != OVC_OK)
        throw Error(result, api.last_error(nullptr));
}

/// Owns a device, and its thread. Outlives its scenes. Move-only; a moved-from one is empty.
class Device {
public:
    explicit Device(const ovc_device_config& config = make<ovc_device_config>(),
                    const ovc_api& api = linked_api())
        : api_(&api) {
        ovc_device created = nullptr;
        if (const ovc_result result = api.create_device(&config, &created); result != OVC_OK)
            throw Error(result, api.last_error(nullptr));
        handle_ = {created, Destroy{&api}};
    }

    /// Returns all devices that there are.
    static std::vector<ovc_device_info> list(const ovc_api& api = linked_api()) {
        uint32_t count = 0;
        ovc_result result = api.list_devices(nullptr, 0, &count);
        std::vector<ovc_device_info> infos(count, make<ovc_device_info>());
        if (result == OVC_OK)
            result = api.list_devices(infos.data(), count, &count);
        if (result != OVC_OK)
            throw Error(result, api.last_error(nullptr));
        return infos;
    }

    ovc_device_info describe() const {
        auto info = make<ovc_device_info>();
        check(api_->describe_device(get(), &info));
        return info;
    }

    ovc_device get() const { return handle_.get(); }
    const ovc_api& api() const { return *api_; }
    /// Throws an Error unless the result is OVC_OK. For calls through the table, on this thread.
    void check(ovc_result result) const {
        if (result != OVC_OK)
            throw Error(result, api_->last_error(get()));
    }

private:
    struct Destroy {
        const ovc_api* api;
        void operator()(ovc_device device) const { api->destroy_device(device); }
    };
    const ovc_api* api_;
    std::unique_ptr<ovc_device_t, Destroy> handle_{nullptr, Destroy{nullptr}};
};

/// Rays pushed from within the functions of Scene::stream().
class Stream {
public:
    Stream(const Device& device, ovc_stream handle) : device_(device), handle_(handle) {}
    void push(Span<const ovc_ray> rays, Span<const uint64_t> tokens, bool any_hit,
              const ovc_query* query = nullptr) {
        if (tokens.size() != rays.size())
            throw Error(OVC_ERROR_INVALID_ARGUMENT, "push: rays and tokens differ in number");
        device_.check(
            device_.api().push(handle_, rays.data(), tokens.data(), rays.size(), any_hit, query));
    }

private:
    const Device& device_;
    ovc_stream handle_;
};

/// A call that was submitted. Its buffers must stay as they are until it is done. Destroying the
/// Ticket cancels the call and waits until it has ended, and must come before the device is
/// destroyed. Move-only.
class Ticket {
public:
    Ticket(const Device& device, ovc_ticket handle)
        : device_(&device), handle_(handle, Release{&device.api()}) {}
    /// Returns when the call is done; throws its Error where it failed.
    void wait() const { device_->check(device_->api().wait(get())); }
    bool done() const {
        uint32_t done = 0;
        device_->check(device_->api().poll(get(), &done, nullptr));
        return done != 0;
    }
    /// Returns the share of rays answered, from 0 to 1.
    double progress() const {
        uint32_t done = 0;
        double share = 0;
        device_->check(device_->api().poll(get(), &done, &share));
        return share;
    }
    void cancel() const { device_->check(device_->api().cancel(get())); }
    ovc_ticket get() const { return handle_.get(); }

private:
    struct Release {
        const ovc_api* api;
        void operator()(ovc_ticket ticket) const { api->release(ticket); }
    };
    const Device* device_;
    std::unique_ptr<ovc_ticket_t, Release> handle_;
};

/// Owns a scene. The Device must outlive it and must not be moved meanwhile. Move-only.
class Scene {
public:
    explicit Scene(const Device& device, const ovc_scene_config& config = make<ovc_scene_config>())
        : device_(&device) {
        ovc_scene created = nullptr;
        device.check(api().create_scene(device.get(), &config, &created));
        handle_ = {created, Destroy{&api()}};
    }

    /// Returns the number of the mesh.
    uint32_t add(const ovc_mesh& mesh) {
        uint32_t number = OVC_NONE;
        check(api().add_mesh(get(), &mesh, &number));
        return number;
    }
    /// Returns the number of the mesh. positions: 3 numbers a vertex, float or double. indices: 3 a
    /// triangle; none: three vertices after each other are a triangle.
    template <class Number>
    uint32_t add(Span<const Number> positions, Span<const uint32_t> indices = {},
                 uint32_t flags = 0) {
        auto mesh = make<ovc_mesh>();
        if constexpr (std::is_same_v<Number, double>)
            mesh.positions_double = positions.data();
        else
            mesh.positions = positions.data();
        if (positions.size() % 3 || indices.size() % 3)
            throw Error(OVC_ERROR_INVALID_ARGUMENT,
                        "add: positions and indices come three at a time");
        mesh.vertex_count = positions.size() / 3;
        mesh.indices = indices.empty() ? nullptr : indices.data();
        mesh.triangle_count = indices.size() / 3;
        mesh.flags = flags;
        return add(mesh);
    }
    uint32_t add_instance(uint32_t mesh, const Transform& transform) {
        auto instance = make<ovc_instance>();
        instance.mesh = mesh;
        instance.transform = transform.data();
        uint32_t number = OVC_NONE;
        check(api().add_instance(get(), &instance, &number));
        return number;
    }
    /// Gives triangles of a mesh new corners; see ovc_api.update_mesh.
    void update(uint32_t number, const ovc_mesh& mesh, uint64_t first_triangle = 0) {
        check(api().update_mesh(get(), number, &mesh, first_triangle));
    }
    /// Puts a mesh or an instance somewhere else; see ovc_api.update_instance.
    void move(uint32_t number, const Transform& transform) {
        check(api().update_instance(get(), number, transform.data()));
    }
    void remove(uint32_t number) { check(api().remove_mesh(get(), number)); }
    void commit() { check(api().commit(get())); }

    /// hits: as many as rays.
    void intersect(Span<const ovc_ray> rays, Span<ovc_hit> hits,
                   const ovc_query* query = nullptr) const {
        same_number("intersect", rays.size(), hits.size());
        check(api().intersect(get(), rays.data(), rays.size(), hits.data(), query));
    }
    std::vector<ovc_hit> intersect(Span<const ovc_ray> rays,
                                   const ovc_query* query = nullptr) const {
        std::vector<ovc_hit> hits(rays.size());
        intersect(rays, hits, query);
        return hits;
    }
    /// hits: max_hits for each ray; counts: one for each ray, or none; see ovc_api.all_hits.
    void all_hits(Span<const ovc_ray> rays, size_t max_hits, Span<ovc_hit> hits,
                  Span<uint64_t> counts, const ovc_query* query = nullptr) const {
        same_number("all_hits", rays.size() * max_hits, hits.size());
        if (!counts.empty())
            same_number("all_hits", rays.size(), counts.size());
        check(api().all_hits(get(), rays.data(), rays.size(), max_hits, hits.data(), counts.data(),
                             query));
    }
    /// occluded: as many as rays, 1 or 0.
    void occluded(Span<const ovc_ray> rays, Span<uint8_t> occluded,
                  const ovc_query* query = nullptr) const {
        same_number("occluded", rays.size(), occluded.size());
        check(api().occluded(get(), rays.data(), rays.size(), occluded.data(), query));
    }
    /// Answers one ray. Any number of threads may call it at once.
    ovc_hit intersect1(const ovc_ray& ray, const ovc_query* query = nullptr) const {
        ovc_hit hit;
        check(api().intersect1(get(), &ray, &hit, query));
        return hit;
    }
    bool occluded1(const ovc_ray& ray, const ovc_query* query = nullptr) const {
        uint8_t occluded = 0;
        check(api().occluded1(get(), &ray, &occluded, query));
        return occluded != 0;
    }

    /// As intersect(), but returns at once; see ovc_api.submit_intersect.
    [[nodiscard]] Ticket submit_intersect(Span<const ovc_ray> rays, Span<ovc_hit> hits,
                                          const ovc_query* query = nullptr) const {
        same_number("submit_intersect", rays.size(), hits.size());
        ovc_ticket ticket = nullptr;
        check(api().submit_intersect(get(), rays.data(), rays.size(), hits.data(), query, &ticket));
        return Ticket(*device_, ticket);
    }
    [[nodiscard]] Ticket submit_occluded(Span<const ovc_ray> rays, Span<uint8_t> occluded,
                                         const ovc_query* query = nullptr) const {
        same_number("submit_occluded", rays.size(), occluded.size());
        ovc_ticket ticket = nullptr;
        check(api().submit_occluded(get(), rays.data(), rays.size(), occluded.data(), query,
                                    &ticket));
        return Ticket(*device_, ticket);
    }

    /// Calls more(Stream&, wanted) and answered(Stream&, const ovc_stream_answers&) as
    /// ovc_stream_host says. An exception of theirs stops the stream and is thrown here.
    template <class More, class Answered>
    void stream(More&& more, Answered&& answered) const {
        StreamHost<More, Answered> host{more, answered, *device_};
        auto functions = make<ovc_stream_host>();
        functions.user = &host;
        functions.more = [](void* user, ovc_stream handle, size_t wanted) {
            auto& h = *static_cast<StreamHost<More, Answered>*>(user);
            return h.run(handle, [&](Stream& stream) { h.more(stream, wanted); });
        };
        functions.answered = [](void* user, ovc_stream handle, const ovc_stream_answers* answers) {
            auto& h = *static_cast<StreamHost<More, Answered>*>(user);
            return h.run(handle, [&](Stream& stream) { h.answered(stream, *answers); });
        };
        const ovc_result result = api().stream(get(), &functions);
        if (host.thrown)
            std::rethrow_exception(host.thrown);
        check(result);
    }

    ovc_plan plan() const { return told<ovc_plan>(api().plan); }
    ovc_statistics statistics() const { return told<ovc_statistics>(api().statistics); }
    ovc_active active() const { return told<ovc_active>(api().active); }
    void purge() const { check(api().purge(get())); }
    /// Returns the bytes for ovc_scene_config.saved of a later scene.
    SavedBytes save() const {
        SavedBytes bytes;
        const auto append = [](void* user, const void* from, size_t size) {
            const auto* first = static_cast<const std::byte*>(from);
            try {
                auto& to = *static_cast<SavedBytes*>(user);
                to.insert(to.end(), first, first + size);
                return 0;
            } catch (const std::bad_alloc&) {
                return 1;
            }
        };
        check(api().save(get(), append, &bytes));
        return bytes;
    }

    ovc_scene get() const { return handle_.get(); }

private:
    struct Destroy {
        const ovc_api* api;
        void operator()(ovc_scene scene) const { api->destroy_scene(scene); }
    };
    /// Keeps an exception until stream() is back, because it must not cross C.
    template <class More, class Answered>
    struct StreamHost {
        std::remove_reference_t<More>& more;
        std::remove_reference_t<Answered>& answered;
        const Device& device;
        std::exception_ptr thrown{};

        template <class Call>
        int run(ovc_stream handle, Call&& call) {
            try {
                Stream stream(device, handle);
                call(stream);
                return 0;
            } catch (...) {
                thrown = std::current_exception();
                return 1;
            }
        }
    };

    const ovc_api& api() const { return device_->api(); }
    void check(ovc_result result) const { device_->check(result); }
    static void same_number(const char* call, size_t rays, size_t answers) {
        if (rays != answers)
            throw Error(OVC_ERROR_INVALID_ARGUMENT,
                        std::string(call) + ": " + std::to_string(rays) + " rays, but room for " +
                            std::to_string(answers) + " answers");
    }
    template <class T>
    T told(ovc_result (*tell)(ovc_scene, T*)) const {
        auto value = make<T>();
        check(tell(get(), &value));
        return value;
    }

    const Device* device_;
    std::unique_ptr<ovc_scene_t, Destroy> handle_{nullptr, Destroy{nullptr}};
};

} // namespace overcast
