// SPDX-License-Identifier: Apache-2.0
// Threads by /proc, their clocks by the formula of pthread_getcpuclockid().
#include "gpu/driver_threads.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#ifdef __linux__
#include <ctime>
#include <pthread.h>
#include <unistd.h>
#endif

namespace ovc {

#ifdef __linux__

static double cpu_seconds(int thread) {
    constexpr clockid_t kPerThread = 4, kScheduled = 2; // linux/posix-timers.h
    timespec time{};
    if (clock_gettime(clockid_t(~unsigned(thread) << 3) | kPerThread | kScheduled, &time) != 0)
        return 0;
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

void name_device_thread() {
    pthread_setname_np(pthread_self(), kDeviceThreadName);
}

DriverThreads DriverThreads::find() {
    DriverThreads found;
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", error)) {
        std::string name;
        std::getline(std::ifstream(task.path() / "comm"), name);
        const int thread = std::atoi(task.path().filename().c_str());
        const bool unnamed = name == kDeviceThreadName && thread != gettid();
        if (unnamed || name.starts_with("llvmpipe-"))
            found.threads_.push_back(thread);
    }
    return found;
}

#else

void name_device_thread() {}
static double cpu_seconds(int) {
    return 0;
}
DriverThreads DriverThreads::find() {
    return {};
}

#endif

void DriverThreads::start() {
    started_.clear();
    for (const int thread : threads_)
        started_.push_back(cpu_seconds(thread));
}

std::optional<double> DriverThreads::busiest() const {
    std::optional<double> most;
    for (size_t i = 0; i < started_.size(); ++i)
        most = std::max(most.value_or(0), cpu_seconds(threads_[i]) - started_[i]);
    return most;
}

} // namespace ovc
