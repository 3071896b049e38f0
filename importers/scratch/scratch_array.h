// SPDX-License-Identifier: Apache-2.0
// ScratchArray is an array that may be larger than memory.
#pragma once

#include "core/system/system_pages.h"
#include "importers/scratch/scratch_file.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace ovc {

/// Append items, and read them in any order. Items lie in pages, of which as many as fit are in
/// memory; the others, those used longest ago (by the clock algorithm), lie in a scratch file that
/// is made once it is needed.
template <class T>
class ScratchArray {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    static constexpr size_t kItems = 1024; // of a page

    /// Takes at most `bytes` of memory for items, but three pages at least.
    ScratchArray(std::filesystem::path folder, uint64_t bytes)
        : folder_(std::move(folder)),
          max_frames_(size_t(std::clamp<uint64_t>(bytes / (kItems * sizeof(T)), 3, kNone))) {}

    size_t size() const { return size_; }
    /// Returns how the disk failed first, which makes items arbitrary; null where it did not.
    const Error* error() const { return error_ ? &*error_ : nullptr; }

    /// Gives all memory back.
    void clear() {
        size_ = 0;
        frame_of_.clear();
        frames_.clear();
        slabs_.clear();
        file_.reset();
    }

    void push_back(const T& value) {
        if (size_ % kItems == 0)
            begin_page();
        items_of(frame_of_.back())[size_++ % kItems] = value;
    }

    T operator[](size_t i) {
        assert(i < size_);
        const size_t page = i / kItems;
        if (frame_of_[page] == kNone)
            read_back(page);
        frames_[frame_of_[page]].used = true;
        return items_of(frame_of_[page])[i % kItems];
    }

private:
    static constexpr uint32_t kNone = 0xffffffffu;
    static constexpr size_t kSlab = 64; // frames that the system is asked for at once

    /// A place in memory for a page.
    struct Frame {
        size_t page;
        bool used = false;     // since the hand of the clock passed
        bool is_saved = false; // the page is in the file as well
    };

    T* items_of(size_t frame) {
        return static_cast<T*>(slabs_[frame / kSlab].get()) + frame % kSlab * kItems;
    }
    static std::span<std::byte> bytes_at(T* items) {
        return std::as_writable_bytes(std::span(items, kItems));
    }

    void begin_page() {
        const uint32_t frame = free_frame();
        frames_[frame] = {frame_of_.size()};
        frame_of_.push_back(frame);
    }

    void read_back(size_t page) {
        const uint32_t frame = free_frame();
        frames_[frame] = {page, false, true};
        frame_of_[page] = frame;
        if (!error_ && !file_->read(page * kItems * sizeof(T), bytes_at(items_of(frame))))
            error_ = file_->error();
    }

    uint32_t free_frame() {
        if (frames_.size() == max_frames_)
            return evict();
        if (frames_.size() % kSlab == 0)
            slabs_.push_back(map_pages(kSlab * kItems * sizeof(T)));
        frames_.push_back({});
        return uint32_t(frames_.size() - 1);
    }

    /// The last page stays, because it is being filled.
    uint32_t evict() {
        for (;; hand_ = (hand_ + 1) % frames_.size()) {
            Frame& frame = frames_[hand_];
            if (!frame.used && frame.page + 1 != frame_of_.size())
                break;
            frame.used = false;
        }
        Frame& frame = frames_[hand_];
        if (!frame.is_saved)
            save(frame.page, items_of(hand_));
        frame_of_[frame.page] = kNone;
        return uint32_t(hand_);
    }

    void save(size_t page, T* items) {
        if (!file_ && !error_) {
            if (Result<ScratchFile> made = ScratchFile::create(folder_); made)
                file_.emplace(std::move(*made));
            else
                error_ = made.error();
        }
        if (!error_ && !file_->write(page * kItems * sizeof(T), bytes_at(items)))
            error_ = file_->error();
    }

    const std::filesystem::path folder_;
    const size_t max_frames_;
    size_t size_ = 0;
    std::vector<uint32_t> frame_of_; // for each page; kNone: it is in the file alone
    std::vector<Frame> frames_;
    std::vector<SystemPages> slabs_; // of kSlab frames each
    size_t hand_ = 0;                // the frame that is looked at next
    std::optional<ScratchFile> file_;
    std::optional<Error> error_; // the first
};

} // namespace ovc
