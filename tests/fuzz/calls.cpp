// SPDX-License-Identifier: Apache-2.0
// fuzz_calls: a player that reads calls from bytes, beside a model that knows what each must
// return (tests/fuzz/call_model.h).
#include "tests/fuzz/calls.h"

#include "core/file/test_archive.h"
#include "tests/fuzz/call_model.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <thread>

namespace ovc {
namespace {

using namespace fuzz;

/// Asked by commits and plans: stops some, and calls back, which must be refused.
struct Progress {
    Slot* slot = nullptr;
    int calls_left = 0;

    static int told(void* user, double done, const char* stage) {
        auto& self = *static_cast<Progress*>(user);
        OVC_REQUIRE(done >= 0 && done <= 1 && stage);
        OVC_REQUIRE(api().commit(self.slot->scene) != OVC_OK);
        return self.calls_left-- == 0;
    }
};

class Player {
public:
    Player(ovc_device device, bool shares_budget, Choices choices)
        : device_(device), shares_budget_(shares_budget), choices_(choices) {}
    ~Player() {
        for (Slot& slot : slots_)
            if (slot.state != Slot::Null)
                api().destroy_scene(slot.scene);
    }
    Player(const Player&) = delete;

    void play() {
        static constexpr void (Player::*kCalls[])() = {
            &Player::create_scene,   &Player::create_scene,  &Player::add_mesh,
            &Player::add_mesh,       &Player::commit,        &Player::commit,
            &Player::intersect,      &Player::intersect,     &Player::intersect_behind,
            &Player::occluded,       &Player::tell,          &Player::save,
            &Player::stream,         &Player::destroy_scene, &Player::ask_device,
            &Player::race,           &Player::add_instance,  &Player::purge,
            &Player::ask_one_by_one, &Player::submit,        &Player::update_mesh,
            &Player::update_mesh,    &Player::move,          &Player::remove};
        for (int calls = 0; calls < 60 && !choices_.over(); ++calls)
            (this->*kCalls[choices_.below(std::size(kCalls))])();
    }

private:
    Slot& any_slot() { return slots_[choices_.below(uint32_t(slots_.size()))]; }

    /// The expected result, or a failure that says why.
    void check(ovc_result got, ovc_result expected) {
        if (got != expected)
            std::fprintf(stderr, "%d, not %d: %s\n", got, expected, api().last_error(device_));
        OVC_REQUIRE(got == expected);
        if (got != OVC_OK)
            OVC_REQUIRE(std::strlen(api().last_error(device_)) > 10 ||
                        std::strlen(api().last_error(nullptr)) > 10);
    }

    void create_scene() {
        Slot& slot = any_slot();
        if (slot.state == Slot::Open || slot.state == Slot::Committed)
            return;
        auto config = sized<ovc_scene_config>();
        const uint8_t kind = choices_.byte();
        config.gpu_memory_bytes = kind & 1 ? 40000 + 400 * choices_.byte() : 0;
        config.leaf_triangles = kind & 2 ? 1 + choices_.below(16) : 0;
        config.kernel = kind & 4 ? 1 + choices_.below(2) : 0;
        config.tell_active = kind & 8 ? 1 : 0;
        if (kind & 16) {
            config.progress = Progress::told;
            config.progress_user = &progress_[size_t(&slot - slots_.data())];
            progress_[size_t(&slot - slots_.data())] = {&slot, choices_.byte()};
        }
        if (kind & 32 && !saved_.empty() && saved_.back().size() > 0) {
            config.saved = saved_.back().data();
            config.saved_bytes = saved_.back().size();
        }
        const bool spoilt = kind >= 240;
        if (spoilt)
            spoil(config, choices_);
        ovc_scene scene = nullptr;
        const ovc_result result = api().create_scene(device_, &config, &scene);
        OVC_REQUIRE((result == OVC_OK) == (scene != nullptr));
        if (spoilt || result != OVC_OK)
            return check(result, config.gpu_memory_bytes && !spoilt ? OVC_ERROR_OUT_OF_BUDGET
                                                                    : OVC_ERROR_INVALID_ARGUMENT);
        slot = Slot{};
        std::erase_if(shared_, [&](const auto& mesh) { return mesh.first == &slot; });
        std::erase_if(first_, [&](const auto& mesh) { return mesh.first.first == &slot; });
        slot.scene = scene;
        slot.state = Slot::Open;
        slot.tells_active = config.tell_active;
    }

    void add_mesh() {
        Slot& slot = any_slot();
        const uint8_t kind = choices_.byte();
        std::vector<float>& positions = positions_.emplace_back();
        const size_t triangles = choices_.below(24);
        const size_t stride = kind & 1 ? 4 : 3; // floats
        for (size_t i = 0; i < triangles * 3 * stride; ++i)
            positions.push_back(float(choices_.coordinate()));
        if (kind & 2 && !positions.empty())
            positions[choices_.below(uint32_t(positions.size()))] = NAN;
        auto mesh = sized<ovc_mesh>();
        mesh.positions = positions.data();
        mesh.stride = stride * sizeof(float);
        mesh.vertex_count = triangles * 3;
        mesh.origin[0] = kind & 4 ? 1e6 * choices_.coordinate() : 0;
        mesh.flags = kind & 8 && stride == 3 ? OVC_MESH_SHARED : 0;
        std::vector<uint32_t> indices;
        if (kind & 16 && !mesh.flags) {
            for (size_t i = 0; i < triangles * 3; ++i)
                indices.push_back(choices_.below(uint32_t(triangles * 3)));
            mesh.indices = indices.empty() ? nullptr : indices.data();
            mesh.triangle_count = indices.size() / 3;
        }
        const bool spoilt = kind >= 240;
        if (spoilt)
            spoil(mesh, choices_);
        uint32_t id = 0;
        const ovc_result result = api().add_mesh(slot.scene, &mesh, &id);
        const ovc_result expected = slot.expected(false);
        check(result, expected == OVC_OK && spoilt ? OVC_ERROR_INVALID_ARGUMENT : expected);
        if (result != OVC_OK)
            return;
        std::vector<vec3> corners;
        for (size_t i = 0; i < triangles * 3; ++i) {
            const float* p = &positions[(indices.empty() ? i : indices[i]) * stride];
            corners.emplace_back(p[0], p[1], p[2]);
        }
        slot.soup.chunks.push_back(
            Chunk::owning({mesh.origin[0], mesh.origin[1], mesh.origin[2]}, std::move(corners)));
        slot.sources.push_back(id);
        if (mesh.flags & OVC_MESH_SHARED)
            shared_.insert({&slot, id});
        slot.state = Slot::Open;
        OVC_REQUIRE(id + 1 == slot.soup.chunks.size());
    }

    /// Gives some triangles new corners. Those of meshes that are shared are left alone, because
    /// the bytes are then the model's too.
    void update_mesh() {
        Slot& slot = any_slot();
        const uint32_t mesh = choices_.below(4), first = choices_.below(8);
        std::vector<vec3> corners(3 * (1 + choices_.below(12)));
        for (vec3& corner : corners)
            corner = {choices_.coordinate(), choices_.coordinate(), choices_.coordinate()};
        auto update = sized<ovc_mesh>();
        update.positions = &corners.data()->x;
        update.vertex_count = corners.size();
        const bool there = slot.is_there(mesh) && slot.sources[mesh] == mesh &&
                           first + corners.size() / 3 <= slot.soup.chunks[mesh].size() &&
                           !shared_.contains({&slot, mesh});
        if (slot.is_there(mesh))
            update.origin[0] = slot.soup.chunks[mesh].origin().x;
        const ovc_result expected = slot.expected(false);
        check(api().update_mesh(slot.scene, mesh, &update, first),
              expected == OVC_OK && !there ? OVC_ERROR_INVALID_ARGUMENT : expected);
        if (expected != OVC_OK || !there)
            return;
        slot.state = Slot::Open;
        slot.soup.chunks[mesh].set_corners(first, corners);
    }

    void move() {
        Slot& slot = any_slot();
        const uint32_t mesh = choices_.below(6);
        Transform transform = kIdentity;
        for (size_t row = 0; row < 3; ++row)
            transform.rows[row][3] = choices_.coordinate();
        transform.rows[0][1] = choices_.below(2) ? choices_.coordinate() : 0;
        const bool placed = choices_.below(4) > 0;
        const ovc_result expected = slot.expected(false);
        check(api().update_instance(slot.scene, mesh, placed ? transform.rows[0].data() : nullptr),
              expected == OVC_OK && !slot.is_there(mesh) ? OVC_ERROR_INVALID_ARGUMENT : expected);
        if (expected != OVC_OK || !slot.is_there(mesh))
            return;
        Chunk& chunk = slot.soup.chunks[mesh];
        if (const auto first = first_.find({&slot, mesh}); first != first_.end())
            chunk.place_anew(placed ? then(first->second, transform) : first->second);
        else
            chunk.place_anew(placed ? std::optional(transform) : std::nullopt);
        if (chunk.size() > 0)
            slot.state = Slot::Open;
    }

    void remove() {
        Slot& slot = any_slot();
        const uint32_t mesh = choices_.below(6);
        const ovc_result expected = slot.expected(false);
        check(api().remove_mesh(slot.scene, mesh),
              expected == OVC_OK && !slot.is_there(mesh) ? OVC_ERROR_INVALID_ARGUMENT : expected);
        if (expected != OVC_OK || !slot.is_there(mesh))
            return;
        Chunk& chunk = slot.soup.chunks[mesh];
        if (chunk.size() > 0)
            slot.state = Slot::Open;
        slot.removed.push_back(std::move(chunk));
        chunk = Chunk::owning(dvec3(0), {});
        slot.sources[mesh] = OVC_NONE;
    }

    /// Where its mesh is: all its triangles are duplicates, and the smaller number answers.
    void add_instance() {
        Slot& slot = any_slot();
        auto instance = sized<ovc_instance>();
        instance.mesh = choices_.below(4);
        const ovc_result result = api().add_instance(slot.scene, &instance, nullptr);
        const ovc_result expected = slot.expected(false);
        const bool there = slot.is_there(instance.mesh);
        check(result, expected == OVC_OK && !there ? OVC_ERROR_INVALID_ARGUMENT : expected);
        if (result != OVC_OK)
            return;
        if (const Transform* first = slot.soup.chunks[instance.mesh].transform())
            first_[{&slot, uint32_t(slot.sources.size())}] = *first;
        slot.soup.chunks.push_back(slot.soup.chunks[instance.mesh].instance());
        slot.sources.push_back(slot.sources[instance.mesh]);
        slot.state = Slot::Open;
    }

    void purge() {
        Slot& slot = any_slot();
        const bool alive = slot.state == Slot::Open || slot.state == Slot::Committed;
        check(api().purge(slot.scene), alive ? OVC_OK : OVC_ERROR_INVALID_ARGUMENT);
    }

    void commit() {
        Slot& slot = any_slot();
        const ovc_result result = api().commit(slot.scene);
        if (result == OVC_OK)
            slot.state = Slot::Committed;
        else if (slot.expected(false) != OVC_OK ||
                 (result != OVC_ERROR_CANCELLED && result != OVC_ERROR_OUT_OF_BUDGET))
            check(result, slot.expected(false));
    }

    void intersect() {
        Slot& slot = any_slot();
        const std::vector<ovc_ray> asked = rays_to(slot, choices_);
        const std::vector<ovc_triangle> skip = skips(slot, asked.size(), choices_);
        std::vector<ovc_hit> hits(asked.size());
        std::vector<uint32_t> leaf(asked.size()), passes(asked.size()), flagged(asked.size());
        auto query = sized<ovc_query>();
        query.skip = skip.data();
        if (choices_.below(2)) {
            query.leaf = leaf.data();
            query.passes = passes.data();
            query.flagged = flagged.data();
        }
        const bool spoilt = choices_.once_in(8);
        if (spoilt)
            query.struct_size = choices_.below(16);
        const ovc_result result =
            api().intersect(slot.scene, asked.data(), asked.size(), hits.data(), &query);
        check(result, spoilt ? OVC_ERROR_INVALID_ARGUMENT : slot.expected(true));
        for (size_t i = 0; result == OVC_OK && i < asked.size(); ++i)
            slot.check_hit(asked[i], skip[i], hits[i]);
    }

    /// Asks for one hit behind the other, from a place that may be none, and for all at once.
    void intersect_behind() {
        Slot& slot = any_slot();
        const std::vector<ovc_ray> asked = rays_to(slot, choices_);
        std::vector<ovc_hit> hits(asked.size(), {-HUGE_VAL, 0, 0, OVC_NONE, OVC_NONE});
        for (ovc_hit& place : hits)
            if (choices_.once_in(4))
                place = {choices_.coordinate(), NAN, 0, choices_.below(4), choices_.below(24)};
        const std::vector<ovc_hit> begin = hits;
        auto query = sized<ovc_query>();
        query.after = begin.data();
        std::vector<uint64_t> counts(asked.size()), found(asked.size());
        const ovc_result result = api().all_hits(slot.scene, asked.data(), asked.size(), 0, nullptr,
                                                 counts.data(), &query);
        check(result, slot.expected(true));
        query.after = hits.data(); // in place
        for (bool more = result == OVC_OK; more;) {
            const std::vector<ovc_hit> before = hits;
            check(api().intersect(slot.scene, asked.data(), asked.size(), hits.data(), &query),
                  OVC_OK);
            more = false;
            for (size_t i = 0; i < asked.size(); ++i) {
                Hit place{before[i].t, 0, 0, {before[i].mesh, before[i].prim}};
                const Hit expected =
                    slot.nearest_hit(asked[i], {OVC_NONE, OVC_NONE}, HitPlace(place));
                OVC_REQUIRE(hits[i].mesh == expected.id.mesh && hits[i].prim == expected.id.prim);
                OVC_REQUIRE(std::memcmp(&hits[i].t, &expected.t, sizeof expected.t) == 0);
                found[i] += expected.is_hit();
                more = more || expected.is_hit();
            }
        }
        for (size_t i = 0; result == OVC_OK && i < asked.size(); ++i)
            OVC_REQUIRE(found[i] == counts[i]);
    }

    void occluded() {
        Slot& slot = any_slot();
        const std::vector<ovc_ray> asked = rays_to(slot, choices_);
        const std::vector<ovc_triangle> skip = skips(slot, asked.size(), choices_);
        std::vector<uint8_t> answers(asked.size(), 7);
        auto query = sized<ovc_query>();
        query.skip = skip.data();
        const ovc_result result =
            api().occluded(slot.scene, asked.data(), asked.size(), answers.data(), &query);
        check(result, slot.expected(true));
        for (size_t i = 0; result == OVC_OK && i < asked.size(); ++i)
            OVC_REQUIRE(answers[i] == slot.nearest_hit(asked[i], skip[i]).is_hit());
    }

    void ask_one_by_one() {
        Slot& slot = any_slot();
        for (const ovc_ray& ray : rays_to(slot, choices_)) {
            ovc_hit hit{};
            uint8_t shadow = 7;
            check(api().intersect1(slot.scene, &ray, &hit, nullptr), slot.expected(true));
            check(api().occluded1(slot.scene, &ray, &shadow, nullptr), slot.expected(true));
            if (slot.state != Slot::Committed)
                return;
            slot.check_hit(ray, {OVC_NONE, OVC_NONE}, hit);
            OVC_REQUIRE(shadow == (hit.mesh != OVC_NONE));
        }
    }

    /// Waits for it, cancels it, or destroys its scene.
    void submit() {
        Slot& slot = any_slot();
        const std::vector<ovc_ray> asked = rays_to(slot, choices_);
        std::vector<ovc_hit> hits(asked.size());
        ovc_ticket ticket = nullptr;
        const ovc_result submitted = api().submit_intersect(slot.scene, asked.data(), asked.size(),
                                                            hits.data(), nullptr, &ticket);
        check(submitted, slot.expected(true));
        OVC_REQUIRE((submitted == OVC_OK) == (ticket != nullptr));
        const uint32_t end = choices_.below(4);
        if (ticket && end == 1)
            check(api().cancel(ticket), OVC_OK);
        if (ticket && end == 2) {
            api().destroy_scene(slot.scene);
            slot.state = Slot::Destroyed;
        }
        const ovc_result result = api().wait(ticket);
        if (!ticket)
            return check(result, OVC_ERROR_INVALID_ARGUMENT);
        OVC_REQUIRE(result == OVC_OK || (result == OVC_ERROR_CANCELLED && (end == 1 || end == 2)));
        for (size_t i = 0; result == OVC_OK && i < asked.size(); ++i)
            slot.check_hit(asked[i], {OVC_NONE, OVC_NONE}, hits[i]);
        uint32_t done = 0;
        check(api().poll(ticket, &done, nullptr), OVC_OK);
        OVC_REQUIRE(done == 1);
        api().release(ticket);
        check(api().poll(ticket, &done, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    }

    void tell() {
        Slot& slot = any_slot();
        auto statistics = sized<ovc_statistics>();
        check(api().statistics(slot.scene, &statistics), slot.expected(true));
        auto active = sized<ovc_active>();
        const ovc_result committed = slot.expected(true);
        check(api().active(slot.scene, &active),
              committed == OVC_OK && !slot.tells_active ? OVC_ERROR_INVALID_ARGUMENT : committed);
        auto plan = sized<ovc_plan>();
        const ovc_result planned = api().plan(slot.scene, &plan);
        if (slot.state == Slot::Null || slot.state == Slot::Destroyed)
            check(planned, OVC_ERROR_INVALID_ARGUMENT);
        else
            OVC_REQUIRE(planned == OVC_OK || planned == OVC_ERROR_OUT_OF_BUDGET ||
                        planned == OVC_ERROR_CANCELLED);
    }

    void save() {
        Slot& slot = any_slot();
        struct Sink {
            test::ArchiveMemory memory;
            int parts_left;
        } sink{{}, choices_.once_in(4) ? int(choices_.below(8)) : 1000000};
        const auto write = [](void* user, const void* bytes, size_t size) {
            auto& to = *static_cast<Sink*>(user);
            to.memory.append({static_cast<const std::byte*>(bytes), size});
            return int(to.parts_left-- == 0);
        };
        const ovc_result result = api().save(slot.scene, write, &sink);
        if (result == OVC_ERROR_CANCELLED)
            return check(slot.expected(true), OVC_OK);
        if (result != OVC_ERROR_INVALID_ARGUMENT || !slot.has_lost_meshes())
            check(result, slot.expected(true));
        if (result != OVC_OK)
            return;
        // Kept, perhaps damaged, for scenes of the same meshes or others.
        test::ArchiveMemory& memory = saved_.emplace_back(std::move(sink.memory));
        if (choices_.below(2) && memory.size() > 0)
            memory.data()[memory.size() * choices_.byte() / 256] ^= std::byte(choices_.byte());
    }

    /// The host of a stream pushes some rays, checks each answer, and pushes again for some.
    struct Streamer {
        Player& player;
        const Slot& slot;
        int calls_left; // then it stops
        std::vector<std::pair<ovc_ray, bool>> pushed{};
        std::vector<int> answers{};

        int push(ovc_stream stream) {
            const std::vector<ovc_ray> asked = rays_to(slot, player.choices_);
            const bool any_hit = player.choices_.below(2);
            std::vector<uint64_t> tokens;
            for (const ovc_ray& ray : asked) {
                tokens.push_back(pushed.size());
                pushed.emplace_back(ray, any_hit);
                answers.push_back(0);
            }
            OVC_REQUIRE(api().push(stream, asked.data(), tokens.data(), asked.size(), any_hit,
                                   nullptr) == OVC_OK);
            OVC_REQUIRE(api().push(stream, asked.data(), tokens.data(), 1, 2, nullptr) != OVC_OK);
            OVC_REQUIRE(api().commit(slot.scene) == OVC_ERROR_INVALID_STATE);
            api().destroy_scene(slot.scene); // refused
            return calls_left-- == 0;
        }
        static int more(void* user, ovc_stream stream, size_t) {
            auto& self = *static_cast<Streamer*>(user);
            return self.player.choices_.over() ? 0 : self.push(stream);
        }
        static int answered(void* user, ovc_stream stream, const ovc_stream_answers* told) {
            auto& self = *static_cast<Streamer*>(user);
            for (size_t i = 0; i < told->count; ++i) {
                const auto& [ray, any_hit] = self.pushed[told->tokens[i]];
                ++self.answers[told->tokens[i]];
                OVC_REQUIRE(any_hit == (told->hits == nullptr));
                if (any_hit)
                    OVC_REQUIRE(told->occluded[i] ==
                                self.slot.nearest_hit(ray, {OVC_NONE, OVC_NONE}).is_hit());
                else
                    self.slot.check_hit(ray, {OVC_NONE, OVC_NONE}, told->hits[i]);
            }
            if (self.player.choices_.once_in(8))
                self.ask_another();
            return self.player.choices_.once_in(3) ? self.push(stream) : 0;
        }
        /// Another scene may have no room beside the stream's.
        void ask_another() {
            const Slot& other = player.any_slot();
            const std::vector<ovc_ray> asked = rays_to(other, player.choices_);
            if (&other == &slot)
                return;
            std::vector<ovc_hit> hits(asked.size());
            const ovc_result result =
                api().intersect(other.scene, asked.data(), asked.size(), hits.data(), nullptr);
            if (result == OVC_ERROR_OUT_OF_BUDGET)
                OVC_REQUIRE(player.shares_budget_);
            else
                player.check(result, other.expected(true));
            for (size_t i = 0; result == OVC_OK && i < asked.size(); ++i)
                other.check_hit(asked[i], {OVC_NONE, OVC_NONE}, hits[i]);
        }
    };

    void stream() {
        Slot& slot = any_slot();
        Streamer streamer{*this, slot, choices_.byte()};
        auto host = sized<ovc_stream_host>();
        host.user = &streamer;
        host.more = Streamer::more;
        host.answered = Streamer::answered;
        const ovc_result result = api().stream(slot.scene, &host);
        if (result == OVC_ERROR_CANCELLED)
            return check(slot.expected(true), OVC_OK);
        check(result, slot.expected(true));
        if (result == OVC_OK)
            OVC_REQUIRE(std::count(streamer.answers.begin(), streamer.answers.end(), 1) ==
                        std::ptrdiff_t(streamer.answers.size()));
    }

    void destroy_scene() {
        Slot& slot = any_slot();
        api().destroy_scene(slot.scene);
        if (slot.state != Slot::Null)
            slot.state = Slot::Destroyed;
    }

    void ask_device() {
        auto info = sized<ovc_device_info>();
        check(api().describe_device(device_, &info), OVC_OK);
        check(api().describe_device(nullptr, &info), OVC_ERROR_INVALID_ARGUMENT);
        info.struct_size = choices_.byte();
        check(api().describe_device(device_, &info), OVC_ERROR_INVALID_ARGUMENT);
        const bool has_scenes = std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) {
            return slot.state == Slot::Open || slot.state == Slot::Committed;
        });
        if (has_scenes)
            api().destroy_device(device_); // refused
    }

    /// Two threads trace a scene, or two, while this one destroys the first, or not.
    void race() {
        Slot &slot = any_slot(), &other = any_slot();
        if (slot.state != Slot::Committed || other.state != Slot::Committed)
            return;
        const auto trace = [](const Slot& traced, const std::vector<ovc_ray>& with) {
            std::vector<ovc_hit> hits(with.size());
            const ovc_result result =
                api().intersect(traced.scene, with.data(), with.size(), hits.data(), nullptr);
            OVC_REQUIRE(result == OVC_OK || result == OVC_ERROR_INVALID_STATE ||
                        result == OVC_ERROR_INVALID_ARGUMENT);
            for (size_t i = 0; result == OVC_OK && i < with.size(); ++i)
                traced.check_hit(with[i], {OVC_NONE, OVC_NONE}, hits[i]);
        };
        const std::vector<ovc_ray> asked = rays_to(slot, choices_),
                                   asked_other = rays_to(other, choices_);
        const bool destroys = choices_.below(2);
        std::thread first([&] { trace(slot, asked); }), second([&] { trace(other, asked_other); });
        if (destroys)
            api().destroy_scene(slot.scene);
        first.join();
        second.join();
        if (destroys)
            slot.state = Slot::Destroyed;
    }

    const ovc_device device_;
    const bool shares_budget_;
    Choices choices_;
    std::array<Slot, 3> slots_;
    std::array<Progress, 3> progress_;
    std::set<std::pair<const Slot*, uint32_t>> shared_;
    std::map<std::pair<const Slot*, uint32_t>, Transform> first_; // what instances were placed by
    std::deque<std::vector<float>> positions_;                    // shared ones are used in place
    std::deque<test::ArchiveMemory> saved_;
};

} // namespace

bool fuzz_calls(const uint8_t* data, size_t size) {
    const auto opened = [](const ovc_device_config& config) {
        ovc_device device = nullptr;
        api().create_device(&config, &device);
        return device;
    };
    auto limits = sized<ovc_device_config>();
    static const ovc_device alone = opened(limits);
    limits.gpu_memory_bytes = 150000; // more than create_scene() asks for, less than three scenes
    limits.threads = 1;
    static const ovc_device shared = opened(limits);
    if (!alone || !shared)
        return false;
    Choices choices(data, size);
    const bool shares_budget = choices.below(2);
    Player(shares_budget ? shared : alone, shares_budget, choices).play();
    return true;
}

} // namespace ovc
