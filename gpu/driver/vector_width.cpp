// SPDX-License-Identifier: Apache-2.0
// Chooses and sets the environment variables that Mesa reads.
#include "gpu/driver/vector_width.h"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace ovc {
namespace fs = std::filesystem;

static constexpr const char* kWidth = "LP_NATIVE_VECTOR_WIDTH";
static constexpr const char* kMesaCache = "MESA_SHADER_CACHE_DIR";

static fs::path path_in(const GetVariable& variable, const char* name) {
    const char* value = variable(name);
    return value ? value : "";
}

/// Returns a folder below the one that the user named, or below the user's folder for caches; empty
/// where neither is known.
static fs::path cache_folder(const GetVariable& variable) {
    if (const fs::path named = path_in(variable, kMesaCache); !named.empty())
        return named / "overcast-512";
    if (const fs::path caches = path_in(variable, "XDG_CACHE_HOME"); caches.is_absolute())
        return caches / "overcast/mesa-512";
    if (const fs::path home = path_in(variable, "HOME"); home.is_absolute())
        return home / ".cache/overcast/mesa-512";
    return {};
}

std::map<std::string, std::string> wide_vectors(const GetVariable& variable, bool has_avx512,
                                                bool fragment_kernels) {
    if (!has_avx512 || fragment_kernels || variable(kWidth))
        return {};
    const fs::path folder = cache_folder(variable);
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

/// The argument of use_wide_vectors().
static std::atomic<bool> narrow_for_fragments{false};

void use_wide_vectors(bool fragment_kernels) {
    narrow_for_fragments = fragment_kernels;
    for (const auto& [name, value] :
         wide_vectors(std::getenv, cpu_has_avx512(), fragment_kernels)) {
        std::error_code error; // ignored: without the folder Mesa compiles each time
        if (name == kMesaCache)
            fs::create_directories(value, error); // Mesa would create only the last folder
        setenv(name.c_str(), value.c_str(), /* overwrite= */ 1);
    }
}

std::optional<std::string> advice_on_vectors(const std::string& renderer,
                                             const GetVariable& variable, bool has_avx512,
                                             bool fragment_kernels) {
    const bool is_narrow = renderer.find("llvmpipe") != std::string::npos &&
                           renderer.find("256 bits") != std::string::npos;
    if (!is_narrow || !has_avx512 || variable(kWidth))
        return std::nullopt;
    const std::string gain = "this CPU has 512, at which calls are up to 1.3 times as fast on some "
                             "CPUs";
    if (fragment_kernels)
        return "llvmpipe compiles all kernels for vectors of 256 bits, because fragment shaders "
               "are among them; for compute kernels alone " +
               gain;
    return "llvmpipe compiles kernels for vectors of 256 bits, and " + gain +
           ": call prepare_process() before the first device, or set LP_NATIVE_VECTOR_WIDTH=512";
}

std::optional<std::string> advice_on_vectors(const std::string& renderer) {
    return advice_on_vectors(renderer, std::getenv, cpu_has_avx512(), narrow_for_fragments);
}

} // namespace ovc
