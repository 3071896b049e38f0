// SPDX-License-Identifier: Apache-2.0
// Tests a host that forks: in the child, the parent's handles are errors and nothing waits for
// threads that stayed behind. The parent goes on as before.
#include "tests/misuse/entries.h"

#include <atomic>
#include <csignal>
#include <cstring>
#include <functional>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace ovc {
namespace {

using test::api;

/// Returns the exit status of a child that runs the body, or minus the signal that ended it.
/// SIGALRM ends a child that hangs.
int in_child(const std::function<int()>& body) {
    const pid_t child = fork();
    if (child == 0) {
        alarm(60);
        _exit(body());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

class Fork : public test::DeviceTest {};

TEST_F(Fork, EveryFunctionReturnsInTheChild) {
    test::Subject subject(device.get());
    for (const test::Entry& entry : test::entries()) {
        const int ended = in_child([&] {
            for (int round = 0; round < 2; ++round) {
                entry.use(subject);
                entry.misuse(subject);
            }
            return 0;
        });
        EXPECT_EQ(ended, 0) << entry.name;
    }
    EXPECT_TRUE(test::field_answers(subject.field));
}

TEST_F(Fork, TheParentsHandlesAreErrorsInTheChild) {
    test::Subject subject(device.get());
    EXPECT_EQ(in_child([&] {
                  const ovc_ray ray = test::into_cell(0, 1);
                  ovc_hit hit;
                  ovc_device other = nullptr;
                  if (api().intersect(subject.field, &ray, 1, &hit, nullptr) == OVC_OK)
                      return 1;
                  if (!std::strstr(api().last_error(nullptr), "forked"))
                      return 2;
                  if (!std::strstr(api().last_error(device.get()), "forked"))
                      return 3;
                  api().destroy_scene(subject.field);
                  api().destroy_device(device.get());
                  if (api().create_device(nullptr, &other) != OVC_ERROR_NO_DEVICE)
                      return 4;
                  return std::strstr(api().last_error(nullptr), "forked") ? 0 : 5;
              }),
              0);
    EXPECT_TRUE(test::field_answers(subject.field));
}

TEST_F(Fork, InTheMiddleOfOtherThreadsCallsLeavesThemAlone) {
    test::Subject subject(device.get());
    std::atomic<bool> done{false};
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            while (!done)
                wrong += !test::field_answers(subject.field);
        });
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(in_child([&] { return test::field_answers(subject.field) ? 1 : 0; }), 0);
    done = true;
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
}

} // namespace
} // namespace ovc
