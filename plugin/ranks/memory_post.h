// SPDX-License-Identifier: Apache-2.0
// MemoryPost: the post between ranks that are objects of one process, for tests. Parcels arrive
// late, and in another order than MPI would have them, except between the same two ranks.
#pragma once

#include "plugin/ranks/post.h"

#include <atomic>
#include <memory>
#include <random>
#include <thread>
#include <vector>

namespace ovc::test {

class MemoryPost final : public Post {
public:
    /// What all ranks share.
    struct Office {
        std::vector<MemoryPost*> posts;
        std::atomic<size_t> closed{0};
        std::atomic<uint32_t> lost{kNone};
    };

    static std::vector<std::unique_ptr<MemoryPost>> make(uint32_t ranks) {
        const auto office = std::make_shared<Office>();
        std::vector<std::unique_ptr<MemoryPost>> posts;
        for (uint32_t rank = 0; rank < ranks; ++rank) {
            posts.push_back(std::unique_ptr<MemoryPost>(new MemoryPost(office, rank, ranks)));
            office->posts.push_back(posts.back().get());
        }
        return posts;
    }
    ~MemoryPost() override { close(); }

    uint32_t rank() const override { return rank_; }
    uint32_t ranks() const override { return ranks_; }
    std::string name_of(uint32_t rank) const override {
        return "rank " + std::to_string(rank) + " on here";
    }
    std::optional<Error> lost() const override {
        if (office_->lost == kNone)
            return std::nullopt;
        return Error{name_of(office_->lost) + " is lost"};
    }
    void close() override {
        if (!thread_.joinable())
            return;
        ++office_->closed;
        while (office_->closed < ranks_ && !lost())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        thread_.request_stop();
        thread_.join();
    }
    PostCounts counts() const override { return {sent_, 0}; }

    void lose(uint32_t rank) { office_->lost = rank; }

protected:
    void send_away(uint32_t to, Parcel parcel) override {
        sent_ += parcel.bytes().size();
        office_->posts[to]->waiting_.put(rank_, std::move(parcel));
    }

private:
    MemoryPost(std::shared_ptr<Office> office, uint32_t rank, uint32_t ranks)
        : office_(std::move(office)), rank_(rank), ranks_(ranks) {
        thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    }

    void run(const std::stop_token& stop) {
        std::mt19937 random(rank_);
        while (!stop.stop_requested())
            for (Inbox::Letter& letter : waiting_.take(std::chrono::milliseconds(2))) {
                std::this_thread::sleep_for(std::chrono::microseconds(random() % 300));
                deliver(letter.from, std::move(letter.parcel));
            }
    }

    const std::shared_ptr<Office> office_;
    const uint32_t rank_, ranks_;
    Inbox waiting_; // that have arrived, but nobody knows yet
    std::atomic<uint64_t> sent_{0};
    std::jthread thread_;
};

} // namespace ovc::test
