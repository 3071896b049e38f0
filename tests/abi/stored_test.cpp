// SPDX-License-Identifier: Apache-2.0
// Tests scenes that lie on a disk: their answers are the same bits as in memory, whatever the
// budgets, and whatever cannot be read is said.
#include "core/file/test_archive.h"
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>
#include <regex>

namespace ovc {
namespace {

using test::api;
using testing::HasSubstr;

/// The disk of a host: it has the corners of a soup, and the saved levels.
class Disk {
public:
    Disk(const Soup& soup, test::ArchiveMemory saved) : soup_(soup), saved_(std::move(saved)) {
        for (const Chunk& chunk : soup.chunks)
            meshes_.push_back({this, chunk.double_corners().empty()
                                         ? std::as_bytes(chunk.corners())
                                         : std::as_bytes(chunk.double_corners())});
    }
    Disk(const Disk&) = delete;

    ovc_scene_config config(uint64_t host_bytes, uint64_t gpu_bytes = 0) {
        auto config = test::sized<ovc_scene_config>();
        config.gpu_memory_bytes = gpu_bytes;
        config.host_memory_bytes = host_bytes;
        config.read_saved = [](void* user, uint64_t offset, void* bytes, size_t size) {
            Disk& self = *static_cast<Disk*>(user);
            return self.read(self.saved_.bytes(), offset, bytes, size) ? 0 : 1;
        };
        config.read_user = this;
        config.saved_bytes = saved_.size();
        return config;
    }

    /// Returns a scene that reads from here, not committed.
    test::AbiScene scene(const test::Device& device, const ovc_scene_config& config) {
        ovc_scene scene = nullptr;
        EXPECT_EQ(api().create_scene(device.get(), &config, &scene), OVC_OK)
            << api().last_error(device.get());
        test::AbiScene owner(scene);
        for (size_t m = 0; m < meshes_.size(); ++m) {
            const ovc_mesh mesh = mesh_of(m);
            EXPECT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_OK)
                << api().last_error(device.get());
        }
        return owner;
    }

    /// Returns one whose other chunks are instances of the first.
    test::AbiScene scene_of_instances(const test::Device& device, const ovc_scene_config& config) {
        ovc_scene scene = nullptr;
        EXPECT_EQ(api().create_scene(device.get(), &config, &scene), OVC_OK);
        const ovc_mesh mesh = mesh_of(0);
        EXPECT_EQ(api().add_mesh(scene, &mesh, nullptr), OVC_OK);
        for (size_t i = 1; i < soup_.chunks.size(); ++i) {
            auto instance = test::sized<ovc_instance>();
            instance.transform = soup_.chunks[i].transform()->rows[0].data();
            EXPECT_EQ(api().add_instance(scene, &instance, nullptr), OVC_OK);
        }
        return test::AbiScene(scene);
    }

    ovc_mesh mesh_of(size_t m) {
        const Chunk& chunk = soup_.chunks[m];
        auto mesh = test::sized<ovc_mesh>();
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] = chunk.origin()[axis];
        if (chunk.transform())
            mesh.transform = chunk.transform()->rows[0].data();
        mesh.triangle_count = chunk.size();
        mesh.reads_doubles = !chunk.double_corners().empty();
        mesh.read_corners = [](void* user, uint64_t first, uint64_t count, void* corners) {
            const Mesh& self = *static_cast<Mesh*>(user);
            const size_t each = self.corners.size() / self.triangles();
            return self.disk->read(self.corners, first * each, corners, count * each) ? 0 : 1;
        };
        mesh.read_user = &meshes_[m];
        return mesh;
    }

    test::ArchiveMemory& saved() { return saved_; }
    uint64_t bytes() const {
        uint64_t all = saved_.size();
        for (const Mesh& mesh : meshes_)
            all += mesh.corners.size();
        return all;
    }

    /// So many reads succeed from now on.
    std::atomic<int64_t> reads_left{INT64_MAX};
    /// Where, in all bytes that are read from now on, a bit is wrong; none: -1.
    std::atomic<int64_t> wrong_byte{-1};

private:
    struct Mesh {
        Disk* disk;
        Bytes corners;
        uint32_t triangles() const {
            return disk->soup_.chunks[size_t(this - disk->meshes_.data())].size();
        }
    };

    bool read(Bytes from, uint64_t offset, void* bytes, size_t size) {
        if (offset > from.size() || size > from.size() - offset || reads_left-- <= 0)
            return false;
        std::memcpy(bytes, from.data() + offset, size);
        const int64_t wrong = wrong_byte.fetch_sub(int64_t(size));
        if (wrong >= 0 && wrong < int64_t(size))
            static_cast<std::byte*>(bytes)[wrong] ^= std::byte(4);
        return true;
    }

    const Soup& soup_;
    test::ArchiveMemory saved_;
    std::vector<Mesh> meshes_;
};

class Stored : public test::DeviceTest {
protected:
    void SetUp() override {
        auto config = test::sized<ovc_device_config>();
        config.threads = 4;
        ovc_device opened = nullptr;
        api().create_device(&config, &opened);
        device.reset(opened);
        if (!device)
            GTEST_SKIP() << api().last_error(nullptr);
    }

    /// Returns a committed scene in memory.
    test::AbiScene in_memory(const Soup& soup, uint64_t leaf_triangles, uint32_t precision) {
        auto config = test::sized<ovc_scene_config>();
        config.leaf_triangles = leaf_triangles;
        config.precision = precision;
        test::AbiScene scene = test::add_soup(device, soup, config);
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << error();
        return scene;
    }

    test::ArchiveMemory saved(const test::AbiScene& scene) {
        test::ArchiveMemory memory;
        const auto append = [](void* user, const void* bytes, size_t size) {
            static_cast<test::ArchiveMemory*>(user)->append(
                {static_cast<const std::byte*>(bytes), size});
            return 0;
        };
        EXPECT_EQ(api().save(scene.get(), append, &memory), OVC_OK) << error();
        return memory;
    }

    /// Returns the smallest budget of host memory that commit names.
    uint64_t smallest_host(Disk& disk) {
        const test::AbiScene scene = disk.scene(device, disk.config(1));
        EXPECT_EQ(api().commit(scene.get()), OVC_ERROR_OUT_OF_BUDGET);
        const std::string message = error();
        std::smatch found;
        EXPECT_TRUE(std::regex_match(
            message, found,
            std::regex("1 bytes of host memory are too few for this scene: the smallest number "
                       "that works is ([0-9]+)")))
            << message;
        return std::stoull(found[1]);
    }

    struct Answers {
        std::vector<ovc_hit> hits, all, behind;
        std::vector<uint64_t> counts;
        std::vector<uint8_t> occluded;

        void expect_same(const Answers& other) const {
            const auto same = [](const std::vector<ovc_hit>& a, const std::vector<ovc_hit>& b) {
                EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(ovc_hit)), 0);
            };
            same(hits, other.hits);
            same(all, other.all);
            same(behind, other.behind);
            EXPECT_EQ(counts, other.counts);
            EXPECT_EQ(occluded, other.occluded);
        }
    };

    /// Asks everything that rays may ask: from triangles, behind hits, and for all hits.
    Answers ask(const test::AbiScene& scene, const std::vector<Ray>& rays) {
        constexpr size_t kMaxHits = 3;
        const size_t n = rays.size();
        Answers found{.hits = test::answers(scene, rays),
                      .all = std::vector<ovc_hit>(n * kMaxHits),
                      .behind = std::vector<ovc_hit>(n),
                      .counts = std::vector<uint64_t>(n),
                      .occluded = std::vector<uint8_t>(n)};
        std::vector<ovc_triangle> skip;
        for (const ovc_hit& hit : found.hits)
            skip.push_back({hit.mesh, hit.prim});
        auto query = test::sized<ovc_query>();
        query.skip = skip.data();
        EXPECT_EQ(api().occluded(scene.get(), test::as_abi(rays), n, found.occluded.data(), &query),
                  OVC_OK)
            << error();
        query.after = found.hits.data();
        EXPECT_EQ(api().intersect(scene.get(), test::as_abi(rays), n, found.behind.data(), &query),
                  OVC_OK)
            << error();
        EXPECT_EQ(api().all_hits(scene.get(), test::as_abi(rays), n, kMaxHits, found.all.data(),
                                 found.counts.data(), nullptr),
                  OVC_OK)
            << error();
        return found;
    }
};

TEST_F(Stored, AnswersAreTheSameBitsUnderAnyBudgets) {
    auto soups = test::unpleasant_soups();
    soups.push_back({"grid", test::closed_grid(150)});
    for (const auto& [name, soup] : soups) {
        SCOPED_TRACE(name);
        const auto rays = test::unpleasant_rays(soup, 3, 150);
        const auto built =
            in_memory(soup, soup.triangle_count() > 10000 ? 1500 : 60, OVC_PRECISION_CERTIFIED);
        const Answers expected = ask(built, rays);
        Disk disk(soup, saved(built));
        const ovc_statistics before = test::statistics(built);
        const uint64_t smallest = smallest_host(disk);
        for (const uint64_t host :
             {smallest, std::max(smallest, disk.bytes() / 4), smallest + 2 * disk.bytes()})
            for (const uint64_t gpu :
                 {uint64_t(0), std::max<uint64_t>(before.level2_bytes / 10, 64 << 10)}) {
                SCOPED_TRACE(std::to_string(host) + " and " + std::to_string(gpu) + " bytes");
                auto scene = disk.scene(device, disk.config(host, gpu));
                auto plan = test::sized<ovc_plan>();
                ASSERT_EQ(api().plan(scene.get(), &plan), OVC_OK) << error();
                ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error();
                ask(scene, rays).expect_same(expected);
                const ovc_statistics after = test::statistics(scene);
                EXPECT_EQ(plan.leaves, after.leaves);
                EXPECT_EQ(plan.leaf_references, after.leaf_references);
                EXPECT_EQ(plan.level2_bytes, after.level2_bytes);
                EXPECT_EQ(plan.largest_page_bytes, after.largest_page_bytes);
                EXPECT_EQ(plan.saved_bytes, disk.saved().size());
                EXPECT_EQ(plan.smallest_host_bytes, smallest);
                EXPECT_EQ(plan.fits, 1u);
                EXPECT_LE(plan.host_bytes, host);
                EXPECT_GE(plan.host_bytes, after.host_budget_peak_bytes);
                EXPECT_EQ(after.leaves, before.leaves);
                EXPECT_EQ(after.leaf_references, before.leaf_references);
                EXPECT_EQ(after.level2_bytes, before.level2_bytes);
                EXPECT_EQ(after.twins, before.twins);
                EXPECT_EQ(after.host_budget_bytes, host);
                EXPECT_LE(after.host_budget_peak_bytes, host);
                if (before.leaves > 0) {
                    EXPECT_GE(after.disk_bytes, before.largest_page_bytes);
                    EXPECT_GT(after.disk_misses + after.disk_ahead, 0u);
                }
            }
    }
}

/// What was saved is cut already, so other budgets work than where a scene is built.
TEST_F(Stored, ThePlanNamesTheSmallestBudgetsThatWork) {
    Soup instances = test::closed_grid(20);
    for (int i = 1; i < 3000; ++i) {
        Transform moved = kIdentity;
        moved.rows[0][3] = i % 60 * 3;
        moved.rows[1][3] = i / 60 * 3;
        instances.chunks.push_back(instances.chunks[0].instance());
        instances.chunks.back().place(moved);
    }
    Soup meshes;
    for (int i = 0; i < 500; ++i)
        for (Chunk& chunk : test::closed_grid(3, dvec3(i % 30 * 2, i / 30 * 2, 0)).chunks)
            meshes.chunks.push_back(std::move(chunk));
    std::vector<Soup> soups;
    soups.push_back(std::move(instances));
    soups.push_back(std::move(meshes));
    soups.push_back(test::closed_grid(50));
    soups.push_back(test::random_soup(6, 5000, 0.5));
    for (const Soup& soup : soups) {
        SCOPED_TRACE(soup.triangle_count());
        const bool placed = soup.chunks.back().transform();
        const test::AbiScene built = in_memory(soup, 700, OVC_PRECISION_CERTIFIED);
        Disk disk(soup, saved(built));
        const auto scene_of = [&](uint64_t host, uint64_t gpu) {
            const ovc_scene_config config = disk.config(host, gpu);
            return placed ? disk.scene_of_instances(device, config) : disk.scene(device, config);
        };
        auto plan = test::sized<ovc_plan>();
        ASSERT_EQ(api().plan(scene_of(1 << 30, 0).get(), &plan), OVC_OK) << error();
        const uint64_t host = plan.smallest_host_bytes, gpu = plan.smallest_budget_bytes;
        EXPECT_GE(host, soup.chunks.size() * (placed ? 1000 : 500)) << "meshes take memory too";
        const test::AbiScene scene = scene_of(host, gpu);
        ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error();
        const auto rays = test::unpleasant_rays(soup, 7, 60);
        ask(scene, rays).expect_same(ask(built, rays));
        EXPECT_LE(test::statistics(scene).gpu_peak_bytes, gpu);
        EXPECT_EQ(api().commit(scene_of(host - 1, gpu).get()), OVC_ERROR_OUT_OF_BUDGET);
        EXPECT_EQ(api().commit(scene_of(host, gpu - 1).get()), OVC_ERROR_OUT_OF_BUDGET);
        EXPECT_THAT(error(), HasSubstr(" smallest that works is " + std::to_string(gpu) + " "));
    }
}

TEST_F(Stored, ASmallBudgetReadsPagesAgainAndALargeOneDoesNot) {
    const Soup soup = test::closed_grid(300);
    const auto rays = test::unpleasant_rays(soup, 5, 4000);
    const auto built = in_memory(soup, 2000, OVC_PRECISION_CERTIFIED);
    const auto expected = test::answers(built, rays);
    Disk disk(soup, saved(built));
    const uint64_t level2 = test::statistics(built).level2_bytes;
    const auto read_by = [&](uint64_t host) {
        auto scene = disk.scene(device, disk.config(host, level2 / 4));
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << error();
        for (int i = 0; i < 2; ++i) {
            const auto found = test::answers(scene, rays);
            EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(ovc_hit)),
                      0);
        }
        return test::statistics(scene).disk_bytes;
    };
    EXPECT_LE(read_by(4 * disk.bytes()), disk.bytes());
    EXPECT_GT(read_by(smallest_host(disk)), 2 * level2);
}

TEST_F(Stored, FastPrecisionAndInstancesLieOnADiskAsWell) {
    Soup soup = test::closed_grid(60);
    for (int i = 1; i < 12; ++i) {
        soup.chunks.push_back(soup.chunks[0].instance());
        Transform moved = kIdentity;
        moved.rows[0][3] = 3.0 * i;
        soup.chunks.back().place(moved);
    }
    const auto rays = test::unpleasant_rays(soup, 3, 1000);
    for (const uint32_t precision : {OVC_PRECISION_CERTIFIED, OVC_PRECISION_FAST}) {
        const auto built = in_memory(soup, 1000, precision);
        const auto expected = test::answers(built, rays);
        Disk disk(soup, saved(built));
        ovc_scene_config config = disk.config(1 << 30);
        config.precision = precision;
        test::AbiScene scene = disk.scene_of_instances(device, config);
        for (int64_t reads = 0;; reads = reads * 3 / 2 + 1) { // some for the boxes of instances
            disk.reads_left = reads;
            const ovc_result result = api().commit(scene.get());
            disk.reads_left = INT64_MAX;
            if (result == OVC_OK)
                break;
            EXPECT_EQ(result, OVC_ERROR_UNREADABLE);
            EXPECT_THAT(error(), HasSubstr("cannot be read"));
            scene = disk.scene_of_instances(device, config);
        }
        EXPECT_EQ(test::statistics(scene).instances, test::statistics(built).instances);
        const auto found = test::answers(scene, rays);
        for (size_t i = 0; i < found.size(); ++i) { // the tree over the pages is another one
            EXPECT_EQ(found[i].mesh, expected[i].mesh) << i;
            if (precision == OVC_PRECISION_CERTIFIED) {
                EXPECT_EQ(std::memcmp(&found[i], &expected[i], sizeof(ovc_hit)), 0) << i;
            } else if (found[i].mesh != OVC_NONE) {
                EXPECT_NEAR(found[i].t, expected[i].t, 1e-5) << i;
            }
        }
    }
}

/// A scene of several pages that lie on a disk, of which the budgets hold some.
struct Several {
    Soup soup = test::closed_grid(60);
    std::vector<Ray> rays = test::unpleasant_rays(soup, 3, 300);
};

/// Several on a disk that is spoiled while rays are traced.
class Spoiled : public Stored {
protected:
    void SetUp() override {
        Stored::SetUp();
        if (IsSkipped())
            return;
        const auto built = in_memory(several_.soup, 500, OVC_PRECISION_CERTIFIED);
        expected_ = test::answers(built, several_.rays);
        disk.emplace(several_.soup, saved(built));
        config_ = disk->config(smallest_host(*disk), test::statistics(built).level2_bytes / 2);
    }

    /// Traces the rays through a new scene, and expects the right hits: at once, or from the next
    /// call after an error that says `how` what was read is wrong. Counts the errors. spoil, mend:
    /// called before and after the first call.
    template <class Spoil, class Mend>
    void trace(const Spoil& spoil, const Mend& mend, const std::string& how) {
        const auto scene = disk->scene(device, config_);
        ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error();
        std::vector<ovc_hit> hits(several_.rays.size());
        spoil();
        const ovc_result result = api().intersect(scene.get(), test::as_abi(several_.rays),
                                                  hits.size(), hits.data(), nullptr);
        mend();
        if (result != OVC_OK) {
            ++failures;
            EXPECT_EQ(result, OVC_ERROR_UNREADABLE) << error();
            EXPECT_THAT(error(), testing::ContainsRegex(
                                     "^(the page of leaf [0-9]+|the corners of triangles [0-9]+ "
                                     "to [0-9]+ of mesh 0) " +
                                     how));
            hits = test::answers(scene, several_.rays);
        }
        EXPECT_EQ(std::memcmp(hits.data(), expected_.data(), hits.size() * sizeof(ovc_hit)), 0);
    }

    std::optional<Disk> disk;
    size_t failures = 0;
    const Several several_;
    std::vector<ovc_hit> expected_;
    ovc_scene_config config_{};
};

TEST_F(Spoiled, ReadsThatFailAreSaidAndTheNextCallWorks) {
    bool ran_out = true;
    for (int64_t reads = 0; ran_out; reads = reads * 3 / 2 + 1) {
        SCOPED_TRACE(reads);
        trace([&] { disk->reads_left = reads; },
              [&] {
                  ran_out = disk->reads_left < 0;
                  disk->reads_left = INT64_MAX;
              },
              "cannot be read$");
        if (HasFatalFailure())
            return;
    }
    EXPECT_GT(failures, 5u);
}

/// All pages fit, so rays do not wait for those that did not come.
TEST_F(Spoiled, AReadThatFailsWhenTheGpuIsFilledAgainLeavesNoGap) {
    const auto scene = disk->scene(device, disk->config(smallest_host(*disk)));
    ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error();
    std::vector<ovc_hit> hits(several_.rays.size());
    for (const int64_t reads : {0, 3, 8}) {
        ASSERT_EQ(api().purge(scene.get()), OVC_OK);
        disk->reads_left = reads;
        const ovc_result result = api().intersect(scene.get(), test::as_abi(several_.rays),
                                                  hits.size(), hits.data(), nullptr);
        disk->reads_left = INT64_MAX;
        EXPECT_EQ(result, OVC_ERROR_UNREADABLE);
        hits = test::answers(scene, several_.rays);
        EXPECT_EQ(std::memcmp(hits.data(), expected_.data(), hits.size() * sizeof(ovc_hit)), 0);
    }
}

/// Where there is no error, a page that was read ahead was read again.
TEST_F(Spoiled, AWrongBitNeverLeadsToAWrongAnswer) {
    for (int64_t wrong = 0; wrong < 300000; wrong += 10007) {
        SCOPED_TRACE(wrong);
        trace([&] { disk->wrong_byte = wrong; }, [] {}, "(is|are) damaged: (its|their) checksum");
    }
    EXPECT_GT(failures, 5u);
}

TEST_F(Stored, OpeningSaysWhichReadFails) {
    const Several several;
    Disk disk(several.soup, saved(in_memory(several.soup, 500, OVC_PRECISION_CERTIFIED)));
    int64_t reads = 0;
    for (;; ++reads) {
        auto scene = disk.scene(device, disk.config(1 << 30));
        disk.reads_left = reads;
        const ovc_result result = api().commit(scene.get());
        disk.reads_left = INT64_MAX;
        if (result == OVC_OK)
            break;
        EXPECT_EQ(result, OVC_ERROR_UNREADABLE);
        EXPECT_THAT(error(), HasSubstr("cannot be read"));
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << error();
    }
    EXPECT_GT(reads, 10); // header, end, tables, and pages for the pool
}

TEST_F(Stored, DamageAndOtherMeshesAreSaidAtCommit) {
    const Several several;
    Disk disk(several.soup, saved(in_memory(several.soup, 500, OVC_PRECISION_CERTIFIED)));
    const auto message = [&](Disk& from) {
        auto scene = from.scene(device, from.config(1 << 30));
        EXPECT_EQ(api().commit(scene.get()), OVC_ERROR_UNREADABLE);
        return error();
    };
    const Soup other = test::closed_grid(61);
    Disk of_other(other, test::ArchiveMemory(disk.saved().bytes()));
    EXPECT_EQ(message(of_other), "what was saved is of other meshes");
    Disk cut(several.soup, test::ArchiveMemory(disk.saved().bytes().first(10000)));
    EXPECT_EQ(message(cut), "what was saved is cut off");
    Disk empty(several.soup, {});
    EXPECT_EQ(message(empty), "what was saved is too short to be whole");
}

TEST_F(Stored, MisuseIsRefused) {
    const Several several;
    Disk disk(several.soup, saved(in_memory(several.soup, 500, OVC_PRECISION_CERTIFIED)));
    const auto refused = [&](auto&& spoil) {
        ovc_scene_config config = disk.config(1 << 30);
        spoil(config);
        ovc_scene scene = nullptr;
        return api().create_scene(device.get(), &config, &scene) == OVC_ERROR_INVALID_ARGUMENT;
    };
    EXPECT_TRUE(refused([](auto& config) { config.host_memory_bytes = 0; }));
    EXPECT_TRUE(refused([](auto& config) { config.read_saved = nullptr; }));
    EXPECT_TRUE(refused([&](auto& config) { config.saved = disk.saved().data(); }));
    auto scene = disk.scene(device, disk.config(1 << 30));
    auto mesh = test::sized<ovc_mesh>();
    mesh.positions = reinterpret_cast<const float*>(several.soup.chunks[0].corners().data());
    mesh.vertex_count = 3;
    EXPECT_EQ(api().add_mesh(scene.get(), &mesh, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    mesh = disk.mesh_of(0);
    mesh.vertex_count = 3;
    EXPECT_EQ(api().add_mesh(scene.get(), &mesh, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    mesh = disk.mesh_of(0);
    const auto plain = in_memory(several.soup, 500, OVC_PRECISION_CERTIFIED);
    EXPECT_EQ(api().add_mesh(plain.get(), &mesh, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error();
    EXPECT_EQ(api().update_instance(scene.get(), 0, nullptr), OVC_ERROR_INVALID_STATE);
    EXPECT_EQ(api().remove_mesh(scene.get(), 0), OVC_ERROR_INVALID_STATE);
    auto plan = test::sized<ovc_plan>();
    EXPECT_EQ(api().plan(scene.get(), &plan), OVC_ERROR_INVALID_ARGUMENT); // it is committed
    test::answers(scene, several.rays);                                    // nothing has changed
}

} // namespace
} // namespace ovc
