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
    if (strict_ && gravity == Gravity::Missing)
        fail(error_at(place, sentence));
    else if (said_.size() < kMaxWarnings && said_.insert(kind).second)
        say(log_, LogLevel::Warning, error_at(place, sentence).message);
}

bool Diagnostics::fail(Error error) {
    if (!error_)
        error_ = std::move(error);
    return false;
}

} // namespace ovc::pbrt
