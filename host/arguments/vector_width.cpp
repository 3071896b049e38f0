// SPDX-License-Identifier: Apache-2.0
// Chooses and sets the environment variables that Mesa reads.
#include "host/arguments/vector_width.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace ovc {
namespace fs = std::filesystem;

static constexpr const char* kWidth = "LP_NATIVE_VECTOR_WIDTH";
static constexpr const char* kMesaCache = "MESA_SHADER_CACHE_DIR";

static fs::path path_in(const Environment& environment, const char* name) {
    const char* value = environment(name);
    return value ? value : "";
}

/// Returns a folder below the one that the user named, or below the user's folder for caches; empty
/// where neither is known.
static fs::path cache_folder(const Environment& environment) {
    if (const fs::path named = path_in(environment, kMesaCache); !named.empty())
        return named / "overcast-512";
    if (const fs::path caches = path_in(environment, "XDG_CACHE_HOME"); caches.is_absolute())
        return caches / "overcast/mesa-512";
    if (const fs::path home = path_in(environment, "HOME"); home.is_absolute())
        return home / ".cache/overcast/mesa-512";
    return {};
}

std::map<std::string, std::string> wide_vectors(const Environment& environment, bool has_avx512,
                                                bool fragment_kernels) {
    if (!has_avx512 || fragment_kernels || environment(kWidth))
        return {};
    const fs::path folder = cache_folder(environment);
    if (folder.empty())
        return {{kWidth, "512"}, {"MESA_SHADER_CACHE_DISABLE", "true"}};
    return {{kWidth, "512"}, {kMesaCache, folder.string()}};
}

static bool cpu_has_avx512() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

void use_wide_vectors(bool fragment_kernels) {
    for (const auto& [name, value] :
         wide_vectors(std::getenv, cpu_has_avx512(), fragment_kernels)) {
        std::error_code error; // ignored: without the folder Mesa compiles each time
        if (name == kMesaCache)
            fs::create_directories(value, error); // Mesa would create only the last folder
        setenv(name.c_str(), value.c_str(), /* overwrite= */ 1);
    }
}

void use_wide_vectors(const BackendOptions& options) {
    use_wide_vectors(options.kernel == OVC_KERNEL_FRAGMENT ||
                     structure_of(options.kind) != OVC_STRUCTURE_TWO_LEVEL);
}

} // namespace ovc
