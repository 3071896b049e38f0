// SPDX-License-Identifier: Apache-2.0
// BuildSteps: each step of a build is taken from what an earlier build kept, or done and kept.
#pragma once

#include "core/file/value_bytes.h"
#include "plugin/structure/failure.h"
#include "plugin/structure/triangle_source.h"

namespace ovc {

/// The build throws this where the checksum of scratch space is wrong.
inline Failure damaged_scratch() {
    return {OVC_ERROR_UNREADABLE, "the scratch space gives back other bytes than it was given"};
}

class BuildSteps {
public:
    /// keeper: null keeps nothing. It goes on with the scratch space behind what was kept.
    BuildSteps(StepKeeper* keeper, ScratchSpace& scratch) : keeper_(keeper), scratch_(scratch) {
        if (!keeper || keeper->kept().empty())
            return;
        uint64_t end = 0;
        ByteReader reader(checked(keeper->kept().back()));
        reader(end);
        scratch_.go_on_at(end);
    }

    /// Takes the values of the next step. Returns false where no earlier build came so far. Throws
    /// a Failure where the step is damaged or has other values.
    template <class... T>
    bool take(T&... values) {
        if (!keeper_ || next_ == keeper_->kept().size())
            return false;
        uint64_t end = 0;
        ByteReader reader(checked(keeper_->kept()[next_++]));
        reader(end, values...);
        if (!reader.done())
            fail();
        return true;
    }

    /// Keeps the values of the step that has been done.
    template <class... T>
    void keep(const T&... values) {
        if (!keeper_)
            return;
        ByteWriter writer;
        writer(scratch_.bytes(), values...);
        writer(checksum_of(writer.bytes()));
        keeper_->keep(writer.bytes());
    }

    /// Reads what an earlier build wrote, which has such a checksum; otherwise throws a Failure.
    void read_written(uint64_t offset, std::span<std::byte> to, uint64_t checksum) {
        keeper_->read_written(offset, to);
        if (checksum_of(to) != checksum)
            fail();
    }

    [[noreturn]] static void fail() {
        throw Failure{OVC_ERROR_UNREADABLE, "what an earlier call kept is damaged, or of "
                                            "another scene, config or number of threads"};
    }

private:
    /// Returns a step without the checksum at its end. Throws a Failure where that is not the one
    /// of the other bytes: readers believe planes, boxes and counts, which make a wrong scene file.
    static Bytes checked(Bytes step) {
        uint64_t checksum = 0;
        if (step.size() < sizeof(checksum))
            fail();
        const Bytes values = step.first(step.size() - sizeof(checksum));
        ByteReader reader(step.last(sizeof(checksum)));
        reader(checksum);
        if (checksum_of(values) != checksum)
            fail();
        return values;
    }

    StepKeeper* const keeper_;
    ScratchSpace& scratch_;
    size_t next_ = 0;
};

} // namespace ovc
