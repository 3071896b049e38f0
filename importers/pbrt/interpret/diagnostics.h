// SPDX-License-Identifier: Apache-2.0
// Diagnostics warns once per kind of thing that a PBRT file asks for and does not get, with its
// place.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"

#include <cassert>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ovc::pbrt {

/// A line of a file. Tokens owns the name.
struct Place {
    const std::string* file = nullptr;
    uint64_t line = 0;
};

/// Returns "FILE:7: sentence".
Error error_at(const Place& place, std::string_view sentence);

/// The weight of a warning under --strict.
enum class Gravity {
    Missing,    // unknown words, missing files, unusable data: an error if strict
    Approximate // understood, and shown as nearly as we can: never an error
};

class Diagnostics {
public:
    Diagnostics(const LogSink& log, bool strict) : log_(log), strict_(strict) {}

    /// Says the sentence at the first call with this kind only.
    void warn(Gravity gravity, const std::string& kind, const Place& place,
              std::string_view sentence);
    void missing(const std::string& kind, const Place& place, std::string_view sentence) {
        warn(Gravity::Missing, kind, place, sentence);
    }
    void approximate(const std::string& kind, const Place& place, std::string_view sentence) {
        warn(Gravity::Approximate, kind, place, sentence);
    }

    /// Keeps the first error. Returns false, for `return fail(…)`.
    bool fail(Error error);
    bool fail(const Place& place, std::string_view sentence) {
        return fail(error_at(place, sentence));
    }

    bool failed() const { return error_.has_value(); }
    const Error& error() const {
        assert(failed());
        return *error_;
    }
    /// Returns what warn() was told, by kind.
    std::vector<Omission> omissions() const;
    const LogSink& log() const { return log_; }
    bool strict() const { return strict_; }

private:
    const LogSink& log_;
    const bool strict_;
    std::map<std::string, Omission> said_; // by kind
    std::optional<Error> error_;
};

} // namespace ovc::pbrt
