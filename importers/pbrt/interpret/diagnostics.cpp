// SPDX-License-Identifier: Apache-2.0
// Diagnostics warns once per kind; under strict, the first missing thing becomes the error.
#include "importers/pbrt/interpret/diagnostics.h"

#include <fmt/format.h>

namespace ovc::pbrt {

/// The max number of warnings. A kind may contain a name, such as a missing file's, and more would
/// only be noise.
static constexpr size_t kMaxWarnings = 1000;

Error error_at(const Place& place, std::string_view sentence) {
    return {fmt::format("{}:{}: {}", place.file ? *place.file : "", place.line, sentence)};
}

void Diagnostics::warn(Gravity gravity, const std::string& kind, const Place& place,
                       std::string_view sentence) {
    if (strict_ && gravity == Gravity::Missing) {
        fail(error_at(place, sentence));
        return;
    }
    auto known = said_.find(kind);
    if (known == said_.end()) {
        if (said_.size() >= kMaxWarnings)
            return;
        known = said_.emplace(kind, Omission{std::string(sentence)}).first;
        say(log_, LogLevel::Warning, error_at(place, sentence).message);
    }
    ++known->second.count;
}

std::vector<Omission> Diagnostics::omissions() const {
    std::vector<Omission> all;
    for (const auto& [kind, omission] : said_)
        all.push_back(omission);
    return all;
}

bool Diagnostics::fail(Error error) {
    if (!error_)
        error_ = std::move(error);
    return false;
}

} // namespace ovc::pbrt
