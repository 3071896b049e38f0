// SPDX-License-Identifier: Apache-2.0
#include "gpu/gl/requirements.h"

#include "core/text/format_text.h"

#include <string>

namespace ovc {

Result<Done> check_requirements(std::string_view renderer, const AskDriver& ask) {
    const int major = ask(GL_MAJOR_VERSION);
    const int minor = ask(GL_MINOR_VERSION);
    std::string unmet;
    if (major < kGlMajor || (major == kGlMajor && minor < kGlMinor))
        unmet = format_text("OpenGL {}.{}, not {}.{}", major, minor, kGlMajor, kGlMinor);
    for (const LimitRequirement& required : kLimits)
        if (const int offered = ask(required.limit); offered < required.needed)
            unmet += format_text("{}{} {}, not {}", unmet.empty() ? "" : ", ", required.name,
                                 offered, required.needed);
    if (unmet.empty())
        return Done{};
    return Error{format_text(
        "'{}' offers less than Overcast needs: {}; a newer driver may offer it", renderer, unmet)};
}

} // namespace ovc
