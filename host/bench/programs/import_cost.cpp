// SPDX-License-Identifier: Apache-2.0
// Forks a child process, which reads the file and reports the cost through a pipe.
#include "host/bench/programs/import_cost.h"

#include "host/bench/ratios/ratios.h"
#include "host/terminal/process_cost.h"
#include "importers/importer.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cassert>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace ovc {

namespace {

uint64_t soup_bytes(const Scene& scene) {
    uint64_t bytes = 0;
    for (const Chunk& chunk : scene.soup.chunks)
        bytes += chunk.corners().size_bytes();
    for (const auto& mesh : scene.meshes)
        bytes += mesh.normals.size() * sizeof(vec3);
    return bytes;
}

/// The message that the child sends: a cost, or the reader's sentence where `error` is not empty.
struct Told {
    ImportCost cost;
    std::array<char, 1000> error{};
};

Told read_and_tell(const std::string& path, uint32_t times) {
    Told told;
    std::vector<double> seconds;
    const uint64_t before = resident_bytes("VmRSS");
    for (uint32_t i = 0; i < times; ++i) {
        const double start = process_cpu_seconds();
        const Result<Scene> scene = load(path);
        seconds.push_back(process_cpu_seconds() - start);
        if (!scene) {
            std::strncpy(told.error.data(), scene.error().message.c_str(), told.error.size() - 1);
            return told;
        }
        if (i == 0) {
            told.cost.peak_bytes = resident_bytes("VmHWM") - before;
            told.cost.soup_bytes = soup_bytes(*scene);
        }
    }
    told.cost.file_bytes = std::filesystem::file_size(path);
    told.cost.cpu_seconds = spread_of(seconds).median;
    return told;
}

} // namespace

Result<ImportCost> measure_import(const std::string& path, uint32_t times) {
    assert(times > 0);
    std::array<int, 2> ends;
    if (pipe(ends.data()) != 0)
        return Error{fmt::format("{} cannot be measured: {}", path, std::strerror(errno))};
    const pid_t child = fork();
    if (child < 0)
        return Error{fmt::format("{} cannot be measured: {}", path, std::strerror(errno))};
    if (child == 0) {
        const Told told = read_and_tell(path, times);
        const ssize_t written = write(ends[1], &told, sizeof(told));
        _exit(written == ssize_t(sizeof(told)) ? 0 : 1);
    }
    close(ends[1]);
    Told told;
    const ssize_t size = read(ends[0], &told, sizeof(told)); // small enough to arrive whole
    close(ends[0]);
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    if (size != ssize_t(sizeof(told)))
        return Error{fmt::format("{} cannot be measured: the process that reads it ended", path)};
    if (told.error[0] != '\0')
        return Error{told.error.data()};
    return told.cost;
}

} // namespace ovc
