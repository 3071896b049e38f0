// SPDX-License-Identifier: Apache-2.0
// import_cost FILE [--assimp] [--times N] measures the cost of reading a file. It prints a line of
// JSON, for importers/measure.py. Each file gets a process of its own, so that peaks do not mix.
#include "host/terminal/process_cost.h"
#include "importers/readers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace ovc {
namespace {

int measure(const std::string& path, bool assimp, int times) {
    nlohmann::json found;
    std::vector<double> seconds;
    const uint64_t before = resident_bytes("VmRSS");
    for (int i = 0; i < times; ++i) {
        const double start = process_cpu_seconds();
        const Result<Scene> scene = assimp ? read_assimp(path, {}) : load(path);
        seconds.push_back(process_cpu_seconds() - start);
        if (i == 0)
            found["peak_bytes"] = resident_bytes("VmHWM") - before;
        if (!scene) {
            found["error"] = scene.error().message;
            break;
        }
        found["triangles"] = scene->soup.triangle_count();
        uint64_t bytes = 0;
        for (size_t m = 0; m < scene->meshes.size(); ++m)
            bytes += scene->soup.chunks[m].corners().size_bytes() +
                     scene->meshes[m].normals.size() * sizeof(vec3);
        found["soup_bytes"] = bytes;
    }
    std::sort(seconds.begin(), seconds.end());
    found["cpu_seconds"] = seconds[seconds.size() / 2];
    // A message quotes the file, which need not be UTF-8.
    fmt::print("{}\n", found.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
    return found.contains("error") ? 1 : 0;
}

} // namespace
} // namespace ovc

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    bool assimp = false;
    int times = 1;
    for (size_t i = 1; i < words.size(); ++i) {
        assimp = assimp || words[i] == "--assimp";
        if (words[i] == "--times" && i + 1 < words.size())
            times = std::max(1, std::atoi(words[i + 1].c_str()));
    }
    if (words.empty()) {
        fmt::print(stderr, "usage: import_cost FILE [--assimp] [--times N]\n");
        return 2;
    }
    return ovc::measure(words[0], assimp, times);
}
