// SPDX-License-Identifier: Apache-2.0
// PageCache: whoever needs a page first reads it, and others wait for that. The page that was used
// least lately goes.
#include "plugin/leaf_store/page_cache.h"

#include "core/system/blocked_signals.h"
#include "core/system/caught_error.h"

#include <sys/mman.h>

#include <algorithm>
#include <cassert>
#include <exception>

namespace ovc {

/// A page's memory goes back to the system at once, so that none is lost between pages of many
/// sizes. Returns null where the system has none.
static std::byte* take_memory(uint64_t bytes) {
    void* const mapped =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return mapped == MAP_FAILED ? nullptr : static_cast<std::byte*>(mapped);
}

PageCache::PageCache(std::vector<uint64_t> page_bytes, uint64_t capacity_bytes, Fill fill)
    : capacity_(capacity_bytes), fill_(std::move(fill)), entries_(page_bytes.size()) {
    for (size_t i = 0; i < page_bytes.size(); ++i) {
        assert(page_bytes[i] > 0 && page_bytes[i] <= capacity_bytes);
        entries_[i].bytes = page_bytes[i];
    }
}

PageCache::~PageCache() {
    readers_.clear();
    for (Entry& entry : entries_) {
        assert(entry.pins == 0 && entry.state != State::Reading);
        evict(entry);
    }
}

std::span<const uvec4> PageCache::Pin::texels() const {
    if (!cache_)
        return {};
    const Entry& entry = cache_->entries_[page_]; // which does not change while it is pinned
    return {reinterpret_cast<const uvec4*>(entry.memory), entry.bytes / sizeof(uvec4)};
}

void PageCache::Pin::release() {
    if (!cache_)
        return;
    {
        const std::lock_guard lock(cache_->mutex_);
        --cache_->entries_[page_].pins;
    }
    std::exchange(cache_, nullptr)->changed_.notify_all();
}

void PageCache::evict(Entry& entry) {
    if (entry.state == State::Away)
        return;
    munmap(std::exchange(entry.memory, nullptr), entry.bytes);
    bytes_ -= entry.bytes;
    entry.state = State::Away;
}

/// Returns false where too much is pinned or read ahead.
bool PageCache::make_room(uint64_t bytes) {
    while (bytes_ + bytes > capacity_) {
        Entry* oldest = nullptr;
        for (Entry& entry : entries_)
            if (entry.state == State::Here && entry.pins == 0 && !entry.is_ahead &&
                (!oldest || entry.last_use < oldest->last_use))
                oldest = &entry;
        if (!oldest)
            return false;
        evict(*oldest);
    }
    return true;
}

Result<Done> PageCache::call_fill(uint32_t page, std::span<std::byte> to) const {
    try {
        return fill_(page, to);
    } catch (...) {
        return caught_error();
    }
}

/// Reads a page for which there is room, without the lock.
Result<Done> PageCache::fill(Lock& lock, uint32_t page) {
    Entry& entry = entries_[page];
    assert(entry.state == State::Away && entry.pins == 0);
    entry.memory = take_memory(entry.bytes);
    if (!entry.memory)
        return out_of_memory();
    entry.state = State::Reading;
    bytes_ += entry.bytes;
    counts_.peak_bytes = std::max(counts_.peak_bytes, bytes_);
    lock.unlock();
    Result<Done> filled = call_fill(page, {entry.memory, entry.bytes});
    lock.lock();
    entry.state = State::Here;
    entry.last_use = ++clock_;
    if (!filled)
        evict(entry);
    changed_.notify_all();
    return filled;
}

Result<PageCache::Pin> PageCache::pin(uint32_t page) {
    Lock lock(mutex_);
    Entry& entry = entries_[page];
    bool waited = false;
    while (entry.state != State::Here) {
        if (entry.state == State::Away && !make_room(entry.bytes)) {
            // A page that was read ahead can be read again.
            for (Entry& other : entries_)
                if (std::exchange(other.is_ahead, false))
                    ahead_bytes_ -= other.bytes;
            if (make_room(entry.bytes))
                continue;
        } else if (entry.state == State::Away) {
            ++counts_.misses;
            waited = true;
            if (const Result<Done> filled = fill(lock, page); !filled)
                return filled.error();
            continue;
        }
        waited = true;
        changed_.wait(lock);
    }
    counts_.hits += !waited;
    if (std::exchange(entry.is_ahead, false))
        ahead_bytes_ -= entry.bytes;
    entry.last_use = ++clock_;
    ++entry.pins;
    return Pin(*this, page);
}

void PageCache::read_ahead(std::vector<uint32_t> pages) {
    constexpr size_t kReaders = 4; // several reads keep a disk busy
    const std::lock_guard lock(mutex_);
    if (pages.empty() && wanted_.empty())
        return;
    wanted_ = std::move(pages);
    std::ranges::reverse(wanted_);
    try {
        const BlockedSignals blocked;
        while (readers_.size() < kReaders)
            readers_.emplace_back([this](const std::stop_token& stop) { run_reader(stop); });
    } catch (const std::exception&) { // those that have started do, and pin() needs none
    }
    asked_.notify_all();
}

void PageCache::run_reader(const std::stop_token& stop) {
    Lock lock(mutex_);
    while (asked_.wait(lock, stop, [&] { return !wanted_.empty(); }) && !stop.stop_requested())
        while (!stop.stop_requested() && read_next_ahead(lock)) {
        }
}

/// Returns false where there is nothing more to read ahead now.
bool PageCache::read_next_ahead(Lock& lock) {
    while (!wanted_.empty() && entries_[wanted_.back()].state != State::Away)
        wanted_.pop_back();
    if (wanted_.empty())
        return false;
    const uint32_t page = wanted_.back();
    Entry& entry = entries_[page];
    if (ahead_bytes_ + entry.bytes > capacity_ / 2 || !make_room(entry.bytes)) {
        wanted_.clear();
        return false;
    }
    wanted_.pop_back();
    entry.is_ahead = true;
    ahead_bytes_ += entry.bytes;
    if (fill(lock, page)) {
        ++counts_.ahead;
    } else if (std::exchange(entry.is_ahead, false)) {
        ahead_bytes_ -= entry.bytes;
    }
    return true;
}

bool PageCache::is_here(uint32_t page) const {
    const std::lock_guard lock(mutex_);
    return entries_[page].state != State::Away;
}

PageCache::Counts PageCache::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

} // namespace ovc
