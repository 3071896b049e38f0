// SPDX-License-Identifier: Apache-2.0
// Finds threads in /proc and reads their clocks by the formula of pthread_getcpuclockid().
#include "gpu/driver/driver_threads.h"

#include "core/system/folder.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#ifdef __linux__
#include <ctime>
#include <pthread.h>
#include <sched.h>
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

/// Returns the cores that this thread may run on; none if the system does not tell.
static std::vector<int> own_cores() {
    std::vector<int> cores;
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof(set), &set) == 0)
        for (int core = 0; core < CPU_SETSIZE; ++core)
            if (CPU_ISSET(core, &set))
                cores.push_back(core);
    return cores;
}

void keep_to_cores(uint32_t count) {
    const std::vector<int> cores = own_cores();
    // From the core that it runs on: otherwise all processes would keep to the first ones.
    const size_t first = size_t(std::ranges::find(cores, sched_getcpu()) - cores.begin());
    cpu_set_t set;
    CPU_ZERO(&set);
    for (size_t i = 0; i < std::min<size_t>(count, cores.size()); ++i)
        CPU_SET(cores[(first + i) % cores.size()], &set);
    if (!cores.empty())
        sched_setaffinity(0, sizeof(set), &set);
}

DriverThreads DriverThreads::find() {
    DriverThreads found;
    const std::string tasks = "/proc/self/task";
    for (const std::string& task : names_in(tasks)) {
        std::string name;
        std::getline(std::ifstream(tasks + "/" + task + "/comm"), name);
        const int thread = std::atoi(task.c_str());
        const bool unnamed = name == kDeviceThreadName && thread != gettid();
        if (unnamed || name.starts_with("llvmpipe-"))
            found.threads_.push_back(thread);
    }
    found.cores_ = unsigned(std::max<size_t>(own_cores().size(), 1));
    return found;
}

#else

void name_device_thread() {}
void keep_to_cores(uint32_t) {}
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

std::optional<double> DriverThreads::seconds_each() const {
    constexpr double kIdle = 1e-3; // more than it costs a thread to start
    double all = 0;
    unsigned workers = 0;
    for (size_t i = 0; i < started_.size(); ++i) {
        const double now = cpu_seconds(threads_[i]);
        all += now - started_[i];
        workers += now > kIdle;
    }
    // A driver that has threads for each kind of kernel runs one kind at a time.
    workers = std::min(workers, cores_);
    if (all <= 0) // the driver works on threads that it started after find()
        return {};
    return all / std::max(workers, 1u);
}

} // namespace ovc
