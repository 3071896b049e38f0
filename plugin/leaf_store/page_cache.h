// SPDX-License-Identifier: Apache-2.0
// PageCache: pages that were read lately, within a fixed number of bytes, and threads that read
// further ones ahead of need.
#pragma once

#include "core/result.h"
#include "core/vec.h"
#include "shaders/layout.h"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace ovc {

class PageCache {
public:
    /// Fills `to` with the page of that number. Several threads may call it. An exception is an
    /// error too: others may wait for the page.
    using Fill = std::function<Result<Done>(uint32_t page, std::span<std::byte> to)>;

    /// page_bytes: of each page, whole texels. capacity_bytes: room for all, or for any two of
    /// them: one for the thread that moves pages to the GPU, which may wait for other threads to
    /// end their loops, and one for those.
    PageCache(std::vector<uint64_t> page_bytes, uint64_t capacity_bytes, Fill fill);
    ~PageCache();
    PageCache(const PageCache&) = delete;

    /// Holds a page, whose memory stays while this lives. A thread holds one at a time, for others
    /// may wait until it lets go.
    class Pin {
    public:
        Pin() = default;
        Pin(Pin&& other) noexcept { *this = std::move(other); }
        Pin& operator=(Pin&& other) noexcept {
            release();
            cache_ = std::exchange(other.cache_, nullptr);
            page_ = other.page_;
            return *this;
        }
        ~Pin() { release(); }

        std::span<const uvec4> texels() const;
        void release();

    private:
        friend class PageCache;
        Pin(PageCache& cache, uint32_t page) : cache_(&cache), page_(page) {}

        PageCache* cache_ = nullptr;
        uint32_t page_ = 0;
    };

    /// Returns the page, which is read where it is not here. Error: it cannot be.
    Result<Pin> pin(uint32_t page);

    /// Replaces what is to be read ahead: these pages, in this order, as far as half of the
    /// capacity goes. Where the system refuses the threads for it, pages are read when they are
    /// needed.
    void read_ahead(std::vector<uint32_t> pages);

    bool is_here(uint32_t page) const;

    struct Counts {
        uint64_t hits = 0;
        uint64_t misses = 0; // pages that somebody had to wait for
        uint64_t ahead = 0;  // pages read ahead
        uint64_t peak_bytes = 0;
    };
    Counts counts() const;

private:
    enum class State : uint8_t { Away, Reading, Here };
    struct Entry {
        std::byte* memory = nullptr;
        uint64_t bytes = 0;
        uint64_t last_use = 0;
        uint32_t pins = 0;
        State state = State::Away;
        bool is_ahead = false; // read ahead, and not pinned since
    };
    using Lock = std::unique_lock<std::mutex>;

    bool make_room(uint64_t bytes);
    void evict(Entry& entry);
    Result<Done> fill(Lock& lock, uint32_t page);
    Result<Done> call_fill(uint32_t page, std::span<std::byte> to) const;
    void run_reader(const std::stop_token& stop);
    bool read_next_ahead(Lock& lock);

    const uint64_t capacity_;
    const Fill fill_;
    mutable std::mutex mutex_; // guards the rest
    std::condition_variable changed_;
    std::condition_variable_any asked_;
    std::vector<Entry> entries_;
    std::vector<uint32_t> wanted_; // to be read ahead, the first one last
    uint64_t bytes_ = 0;
    uint64_t ahead_bytes_ = 0;
    uint64_t clock_ = 0;
    Counts counts_;
    std::vector<std::jthread> readers_; // ends first
};

} // namespace ovc
