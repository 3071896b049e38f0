// SPDX-License-Identifier: Apache-2.0
// The list of all functions of the table, with a use and misuses of each. A test fails until a new
// function has its row here.
#pragma once

#include "tests/misuse/field.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ovc::test {

/// The handles that the functions are called with.
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
    ovc_scene field;           // This scene is committed.
    ovc_scene empty = nullptr; // This scene is not committed.
};

/// A wrong call, the result that it should have returned, and the result that it returned.
struct Misuse {
    const char* what;
    ovc_result expected;
    ovc_result got;
    std::string said; // the text of last_error, of the device or of the thread
};
using Misuses = std::vector<Misuse>;

struct Entry {
    const char* name;
    size_t offset; // the offset in ovc_api
    /// Uses the function as it should be used, checks its answer, and returns its result.
    ovc_result (*use)(Subject&);
    /// Misuses the function with null, wrong sizes, numbers out of range or a wrong order. Returns
    /// nothing if nothing can be wrong.
    Misuses (*misuse)(Subject&);
};

std::span<const Entry> device_entries();
std::span<const Entry> scene_entries();
std::span<const Entry> ray_entries();
std::span<const Entry> ticket_entries();

/// Returns all entries.
inline std::vector<Entry> entries() {
    std::vector<Entry> all;
    for (const auto part : {device_entries(), scene_entries(), ray_entries(), ticket_entries()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Makes a row for the function of that name.
#define OVC_ENTRY(function, use, misuse)                                                           \
    { #function, offsetof(ovc_api, function), use, misuse }

/// Collects misuses and the messages about them.
class Wrong {
public:
    explicit Wrong(const Subject& subject) : device_(subject.device) {}

    /// Adds a call on a valid handle. Its device has the sentence.
    void on_device(const char* what, ovc_result expected, ovc_result got) {
        found_.push_back({what, expected, got, api().last_error(device_)});
    }
    void argument(const char* what, ovc_result got) {
        on_device(what, OVC_ERROR_INVALID_ARGUMENT, got);
    }
    void state(const char* what, ovc_result got) { on_device(what, OVC_ERROR_INVALID_STATE, got); }
    /// Adds a call on no handle, or on one that is not valid. The thread has the sentence.
    void without_device(const char* what, ovc_result got) {
        found_.push_back({what, OVC_ERROR_INVALID_ARGUMENT, got, api().last_error(nullptr)});
    }

    Misuses found() const { return found_; }

private:
    ovc_device device_;
    Misuses found_;
};

} // namespace ovc::test
