// SPDX-License-Identifier: Apache-2.0
// The list of all functions of the table: how each is used, and how misused. A new one gets its row
// here; a test fails until it has.
#pragma once

#include "tests/misuse/field.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ovc::test {

/// What the functions are called with.
struct Subject {
    explicit Subject(ovc_device of) : device(of), field(make_field(of)) {
        api().create_scene(of, nullptr, &empty);
    }
    ~Subject() {
        api().destroy_scene(empty);
        api().destroy_scene(field);
    }
    Subject(const Subject&) = delete;

    ovc_device device;
    ovc_scene field;           // committed
    ovc_scene empty = nullptr; // not committed
};

/// A call that is wrong, what it should have returned, and what it did.
struct Misuse {
    const char* what;
    ovc_result expected;
    ovc_result got;
    std::string said; // by last_error, of the device or of the thread
};
using Misuses = std::vector<Misuse>;

struct Entry {
    const char* name;
    size_t offset; // in ovc_api
    /// Uses it as it should be; checks its answer, and returns its result.
    ovc_result (*use)(Subject&);
    /// Null, wrong sizes, numbers out of range, the wrong order. Empty where nothing can be wrong.
    Misuses (*misuse)(Subject&);
};

std::span<const Entry> device_entries();
std::span<const Entry> scene_entries();
std::span<const Entry> ray_entries();
std::span<const Entry> ticket_entries();

/// All of them.
inline std::vector<Entry> entries() {
    std::vector<Entry> all;
    for (const auto part : {device_entries(), scene_entries(), ray_entries(), ticket_entries()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// A row for the function of that name.
#define OVC_ENTRY(function, use, misuse)                                                           \
    { #function, offsetof(ovc_api, function), use, misuse }

/// Collects misuses and what was said of each.
class Wrong {
public:
    explicit Wrong(const Subject& subject) : device_(subject.device) {}

    /// Of a call on a handle that is in order: its device has the sentence.
    void on_device(const char* what, ovc_result expected, ovc_result got) {
        found_.push_back({what, expected, got, api().last_error(device_)});
    }
    void argument(const char* what, ovc_result got) {
        on_device(what, OVC_ERROR_INVALID_ARGUMENT, got);
    }
    void state(const char* what, ovc_result got) { on_device(what, OVC_ERROR_INVALID_STATE, got); }
    /// Of a call on no handle, or on none that is in order: the thread has the sentence.
    void without_device(const char* what, ovc_result got) {
        found_.push_back({what, OVC_ERROR_INVALID_ARGUMENT, got, api().last_error(nullptr)});
    }

    Misuses found() const { return found_; }

private:
    ovc_device device_;
    Misuses found_;
};

} // namespace ovc::test
