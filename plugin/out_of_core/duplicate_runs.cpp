// SPDX-License-Identifier: Apache-2.0
// DuplicateRuns: runs are merged, a kilobyte of each in memory.
#include "plugin/out_of_core/duplicate_runs.h"

#include "core/file/checksum.h"
#include "plugin/out_of_core/build_steps.h"

#include <algorithm>

namespace ovc {
namespace {

constexpr size_t kPairsAtOnce = 64;

/// Reads a run from its beginning to its end.
class RunReader {
public:
    RunReader(ScratchSpace& scratch, const DuplicateRuns::Run& run) : scratch_(scratch), run_(run) {
        next();
    }

    bool done() const { return at_ == block_.size(); }
    const Duplicates::Pair& pair() const { return block_[at_]; }
    void next() {
        if (at_ + 1 < block_.size()) {
            ++at_;
            return;
        }
        block_.resize(std::min<uint64_t>(kPairsAtOnce, run_.pairs - read_));
        at_ = 0;
        if (block_.empty()) {
            if (sum_.value() != run_.checksum)
                throw damaged_scratch();
            return;
        }
        scratch_.read(run_.offset + read_ * sizeof(Duplicates::Pair),
                      std::as_writable_bytes(std::span(block_)));
        sum_.add(std::as_bytes(std::span(block_)));
        read_ += block_.size();
    }

private:
    ScratchSpace& scratch_;
    DuplicateRuns::Run run_;
    uint64_t read_ = 0; // pairs
    std::vector<Duplicates::Pair> block_;
    size_t at_ = 0;
    Checksum sum_;
};

} // namespace

DuplicateRuns::Run DuplicateRuns::put(std::span<const Duplicates::Pair> pairs) {
    if (pairs.empty())
        return {};
    Checksum sum;
    sum.add(std::as_bytes(pairs));
    const Run run{scratch_.allocate(pairs.size_bytes()), pairs.size(), sum.value()};
    scratch_.write(run.offset, std::as_bytes(pairs));
    return run;
}

void DuplicateRuns::add(const Run& run) {
    if (run.pairs > 0)
        runs_.push_back(run);
}

void DuplicateRuns::for_each(FunctionRef<void(std::span<const Duplicates::Pair>)> visit) const {
    std::vector<RunReader> readers;
    readers.reserve(runs_.size());
    for (const Run& run : runs_)
        readers.emplace_back(scratch_, run);
    const auto later = [](const RunReader* a, const RunReader* b) { return b->pair() < a->pair(); };
    std::vector<RunReader*> heap; // the one with the first pair in front
    for (RunReader& reader : readers)
        heap.push_back(&reader);
    std::ranges::make_heap(heap, later);
    std::vector<Duplicates::Pair> block;
    while (!heap.empty()) {
        std::ranges::pop_heap(heap, later);
        RunReader& first = *heap.back();
        // The last one is still there, to be told from that of another cell.
        if (block.empty() || block.back() != first.pair()) {
            if (block.size() == kPairsAtOnce) {
                visit(block);
                block.clear();
            }
            block.push_back(first.pair());
        }
        first.next();
        if (first.done())
            heap.pop_back();
        else
            std::ranges::push_heap(heap, later);
    }
    if (!block.empty())
        visit(block);
}

} // namespace ovc
