// SPDX-License-Identifier: Apache-2.0
// Calls without memory return a code, throw nothing through the C ABI, and leave every handle
// either whole or gone.
#include "core/stream/backlog.h"
#include "core/system/turn.h"
#include "plugin/ranks/transport/message_bytes.h"
#include "tests/misuse/field.h"
#include "tests/misuse/no_memory.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace ovc {
namespace {

using test::api;
using test::NoMemory;
using test::sized;
using testing::AnyOf;

/// Calls misses(allocations) with memory for no allocation, for one, and so on, until it returns
/// false. Returns how many allocations it takes.
int with_ever_more_memory(const std::function<bool(int)>& misses) {
    int allocations = 0;
    while (misses(allocations))
        ++allocations;
    return allocations;
}

/// Returns whether the call asked for more memory than for so many allocations.
template <class Call>
bool misses(int allocations, Call&& call, NoMemory::Of threads = NoMemory::Of::ThisThread) {
    const NoMemory none(allocations, threads);
    call();
    return none.was_missed();
}

class WithoutMemory : public test::DeviceTest {};

TEST_F(WithoutMemory, CallsOnHandlesThatAreNoneReturnACode) {
    ovc_scene destroyed = test::make_field(device.get());
    api().destroy_scene(destroyed);
    auto info = sized<ovc_device_info>();
    auto statistics = sized<ovc_statistics>();
    const std::vector<std::function<ovc_result()>> calls{
        [&] { return api().describe_device(nullptr, &info); },
        [&] { return api().commit(nullptr); },
        [&] { return api().statistics(destroyed, &statistics); },
        [&] { return api().push(nullptr, nullptr, nullptr, 0, 0, nullptr); },
        [&] { return api().wait(nullptr); },
        [&] { return api().list_devices(nullptr, 1, nullptr); },
    };
    for (size_t i = 0; i < calls.size(); ++i) {
        const int needed = with_ever_more_memory([&](int allocations) {
            ovc_result result = OVC_OK;
            const bool missed = misses(allocations, [&] { result = calls[i](); });
            EXPECT_EQ(result, missed ? OVC_ERROR_OUT_OF_MEMORY : OVC_ERROR_INVALID_ARGUMENT);
            return missed;
        });
        EXPECT_GT(needed, 0) << "call " << i << " makes a sentence";
    }
    with_ever_more_memory([&](int allocations) {
        return misses(allocations, [&] {
            api().destroy_device(nullptr);
            api().destroy_scene(nullptr);
            api().destroy_scene(destroyed);
            api().release(nullptr);
        });
    });
}

TEST_F(WithoutMemory, AThreadWithoutErrorsHasAnEmptyMessage) {
    std::string said = "nothing";
    std::thread([&] {
        const NoMemory none(0);
        said.assign(api().last_error(device.get()));
    }).join();
    EXPECT_EQ(said, "");
}

/// Collects what a device says.
struct Said {
    std::vector<std::string> errors;

    static void hear(void* self, ovc_log_level level, const char* text) {
        if (level == OVC_LOG_ERROR)
            static_cast<Said*>(self)->errors.emplace_back(text);
    }
};

TEST_F(WithoutMemory, ScenesAndTicketsAreGoneOnceTheyAreDestroyed) {
    Said said;
    auto config = sized<ovc_device_config>();
    config.log = Said::hear;
    config.log_user = &said;
    ovc_device other = nullptr;
    ASSERT_EQ(api().create_device(&config, &other), OVC_OK);
    const ovc_ray ray = test::into_cell(3, 1);
    with_ever_more_memory([&](int allocations) {
        ovc_scene scene = test::make_field(other);
        ovc_hit hits[8]{};
        ovc_ticket tickets[8]{};
        for (int i = 0; i < 8; ++i)
            EXPECT_EQ(api().submit_intersect(scene, &ray, 1, &hits[i], nullptr, &tickets[i]),
                      OVC_OK);
        api().wait(tickets[0]);
        const bool missed = misses(allocations, [&] {
            api().release(tickets[0]);
            api().destroy_scene(scene); // which cancels the calls that wait
        });
        for (int i = 1; i < 8; ++i)
            api().release(tickets[i]);
        EXPECT_EQ(api().commit(scene), OVC_ERROR_INVALID_ARGUMENT) << "it is destroyed";
        return missed;
    });
    api().destroy_device(other);
    EXPECT_THAT(said.errors, testing::IsEmpty()) << "the device has gone";
}

TEST_F(WithoutMemory, ADeviceThatIsUsedStays) {
    ovc_scene scene = test::make_field(device.get());
    with_ever_more_memory([&](int allocations) {
        return misses(allocations, [&] { api().destroy_device(device.get()); });
    });
    EXPECT_TRUE(test::field_answers(scene));
    api().destroy_scene(scene);
}

/// Each call of a scene's life, one of them without memory.
TEST_F(WithoutMemory, ASceneAnswersAsSoonAsThereIsMemoryAgain) {
    const ovc_mesh mesh = test::field_mesh();
    const ovc_ray ray = test::into_cell(7, 2);
    ovc_hit hit{};
    const std::vector<std::function<ovc_result(ovc_scene)>> calls{
        [&](ovc_scene scene) { return api().add_mesh(scene, &mesh, nullptr); },
        [](ovc_scene scene) { return api().commit(scene); },
        [&](ovc_scene scene) { return api().intersect(scene, &ray, 1, &hit, nullptr); },
        [&](ovc_scene scene) { return api().intersect1(scene, &ray, &hit, nullptr); },
    };
    for (size_t hungry = 0; hungry < calls.size(); ++hungry)
        with_ever_more_memory([&](int allocations) {
            ovc_scene scene = nullptr;
            EXPECT_EQ(api().create_scene(device.get(), nullptr, &scene), OVC_OK);
            bool missed = false;
            for (size_t i = 0; i < calls.size(); ++i) {
                ovc_result result = OVC_ERROR_OUT_OF_MEMORY;
                if (i == hungry) {
                    missed = misses(allocations, [&] { result = calls[i](scene); });
                    EXPECT_THAT(result, AnyOf(OVC_OK, OVC_ERROR_OUT_OF_MEMORY)) << "call " << i;
                }
                if (result != OVC_OK) {
                    EXPECT_EQ(calls[i](scene), OVC_OK) << "call " << i;
                }
            }
            EXPECT_TRUE(test::is_in_cell(hit, 7, 2));
            api().destroy_scene(scene);
            return missed;
        });
}

/// A scene, and changes of it that may end early.
class Change {
public:
    explicit Change(ovc_device device) {
        EXPECT_EQ(api().create_scene(device, nullptr, &scene_), OVC_OK);
        const ovc_mesh field = test::field_mesh();
        EXPECT_EQ(api().add_mesh(scene_, &field, nullptr), OVC_OK);
        EXPECT_EQ(add_placed(), OVC_OK);
        EXPECT_EQ(add_instance(), OVC_OK);
    }
    ~Change() { api().destroy_scene(scene_); }
    Change(const Change&) = delete;

    /// The numbers that these give are checked where they succeed.
    ovc_result add_placed(uint32_t flags = 0) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions = test::field_positions().data();
        mesh.vertex_count = 3;
        mesh.transform = kPlace;
        mesh.flags = flags;
        uint32_t number = OVC_NONE;
        const ovc_result result = api().add_mesh(scene_, &mesh, &number);
        if (result == OVC_OK) {
            EXPECT_EQ(number, meshes_++);
        }
        return result;
    }
    ovc_result add_instance() {
        auto instance = sized<ovc_instance>();
        instance.mesh = 1;
        instance.transform = kPlace;
        uint32_t number = OVC_NONE;
        const ovc_result result = api().add_instance(scene_, &instance, &number);
        if (result == OVC_OK) {
            EXPECT_EQ(number, meshes_++);
        }
        return result;
    }
    ovc_result move() { return api().update_instance(scene_, 2, kPlace); }
    ovc_result remove() { return api().remove_mesh(scene_, 1); }
    ovc_result commit() { return api().commit(scene_); }

    /// Returns where a ray along each place meets what is there, and how many triangles there are.
    std::vector<double> seen() {
        std::vector<double> seen;
        for (uint32_t place = 0; place < 8; ++place) {
            const ovc_ray ray{{0.25, 0.25 + 100 * place, 1}, 0, {0, 0, -1}, HUGE_VAL};
            ovc_hit hit{};
            EXPECT_EQ(api().intersect1(scene_, &ray, &hit, nullptr), OVC_OK);
            seen.push_back(hit.mesh);
        }
        auto statistics = sized<ovc_statistics>();
        EXPECT_EQ(api().statistics(scene_, &statistics), OVC_OK);
        seen.push_back(double(statistics.triangles));
        return seen;
    }

private:
    static constexpr double kPlace[12]{1, 0, 0, 0, 0, 1, 0, 100, 0, 0, 1, 0};

    ovc_scene scene_ = nullptr;
    uint32_t meshes_ = 1;
};

TEST_F(WithoutMemory, AChangeThatFailsChangesNothing) {
    using Call = std::function<ovc_result(Change&)>;
    const std::vector<Call> changes{
        [](Change& scene) { return scene.add_placed(); },
        [](Change& scene) { return scene.add_placed(OVC_MESH_TEMPLATE); },
        [](Change& scene) { return scene.add_instance(); },
        [](Change& scene) { return scene.move(); },
        [](Change& scene) { return scene.remove(); },
    };
    for (const bool is_committed : {false, true})
        for (const Call& change : changes) {
            const std::vector<double> expected = [&] {
                Change scene(device.get());
                EXPECT_EQ(change(scene), OVC_OK);
                EXPECT_EQ(scene.add_placed(), OVC_OK);
                EXPECT_EQ(scene.commit(), OVC_OK);
                return scene.seen();
            }();
            with_ever_more_memory([&](int allocations) {
                Change scene(device.get());
                std::vector<double> before;
                if (is_committed) {
                    EXPECT_EQ(scene.commit(), OVC_OK);
                    before = scene.seen();
                }
                ovc_result result = OVC_OK;
                const bool missed = misses(allocations, [&] { result = change(scene); });
                EXPECT_EQ(result, missed ? OVC_ERROR_OUT_OF_MEMORY : OVC_OK);
                if (missed) {
                    if (is_committed) {
                        EXPECT_EQ(scene.seen(), before) << "it takes rays as before";
                    }
                    EXPECT_EQ(change(scene), OVC_OK);
                }
                EXPECT_EQ(scene.add_placed(), OVC_OK); // which gets the next number
                EXPECT_EQ(scene.commit(), OVC_OK);
                EXPECT_EQ(scene.seen(), expected) << allocations;
                return missed;
            });
        }
}

TEST_F(WithoutMemory, APassThatFailsOnTheDevicesThreadLeavesNoTrace) {
    const test::AbiScene scene(test::make_field(device.get()));
    ASSERT_TRUE(test::field_answers(scene.get())); // its kernels are there now
    std::vector<ovc_ray> rays;
    for (uint32_t i = 0; i < 5000; ++i)
        rays.push_back(test::into_cell(i % test::kCells, 1));
    std::vector<ovc_hit> hits(rays.size());
    const int needed = with_ever_more_memory([&](int allocations) {
        ovc_result result = OVC_OK;
        const bool missed = misses(
            allocations,
            [&] {
                result =
                    api().intersect(scene.get(), rays.data(), rays.size(), hits.data(), nullptr);
            },
            NoMemory::Of::Library);
        EXPECT_THAT(result, AnyOf(OVC_OK, OVC_ERROR_OUT_OF_MEMORY));
        EXPECT_TRUE(test::field_answers(scene.get())) << allocations;
        return missed;
    });
    EXPECT_GT(needed, 0);
}

TEST(WithoutMemoryTurn, AThreadGivesItUp) {
    Turn turn;
    turn.lock();
    std::thread([&] {
        const NoMemory none(0);
        EXPECT_FALSE(turn.lock_while([] { return false; }));
        EXPECT_FALSE(none.was_missed());
    }).join();
    turn.unlock();
    EXPECT_TRUE(turn.try_lock()) << "nobody waits for it";
    turn.unlock();
}

TEST(WithoutMemoryMessage, ThatIsEmptyTakesNone) {
    const NoMemory none(0);
    {
        MessageBytes bytes;
        const MessageBytes moved(std::move(bytes));
    }
    EXPECT_FALSE(none.was_missed());
}

TEST(WithoutMemoryBacklog, TakesRaysWholeOrNot) {
    const std::vector<Ray> rays(40);
    const std::vector<TriangleId> skip(40);
    const std::vector<uint64_t> tokens(40);
    const std::vector<Hit> after(40);
    const std::vector<uint32_t> masks(40);
    with_ever_more_memory([&](int allocations) {
        Backlog backlog;
        backlog.push({false, rays, skip, tokens});
        bool thrown = false;
        const bool missed = misses(allocations, [&] {
            try {
                backlog.push({false, rays, skip, tokens, after, masks});
            } catch (const std::bad_alloc&) {
                thrown = true;
            }
        });
        EXPECT_EQ(thrown, missed);
        EXPECT_EQ(backlog.size(), missed ? 40u : 80u);
        return missed;
    });
}

} // namespace
} // namespace ovc
