// SPDX-License-Identifier: Apache-2.0
// MemoryTransport: the transport between ranks that are objects of one process, for tests. Messages
// arrive late, and in another order than MPI would have them, except between the same two ranks.
#pragma once

#include "plugin/ranks/transport/transport.h"

#include <atomic>
#include <memory>
#include <new>
#include <random>
#include <thread>
#include <vector>

namespace ovc::test {

class MemoryTransport final : public Transport {
public:
    /// All ranks share it: a rank may still be sending when the one it sends to is gone already.
    struct Network {
        explicit Network(uint32_t ranks) : waiting(ranks) {}
        std::vector<MessageQueue> waiting; // for each rank
        std::atomic<size_t> closed{0};
        std::atomic<uint32_t> lost{kNone};
    };

    static std::vector<std::unique_ptr<MemoryTransport>> make(uint32_t ranks) {
        const auto network = std::make_shared<Network>(ranks);
        std::vector<std::unique_ptr<MemoryTransport>> transports;
        for (uint32_t rank = 0; rank < ranks; ++rank)
            transports.push_back(
                std::unique_ptr<MemoryTransport>(new MemoryTransport(network, rank, ranks)));
        return transports;
    }
    ~MemoryTransport() override { close(); }

    uint32_t rank() const override { return rank_; }
    uint32_t ranks() const override { return ranks_; }
    std::string name_of(uint32_t rank) const override {
        return "rank " + std::to_string(rank) + " on here";
    }
    std::optional<Error> lost() const override {
        if (given_up_)
            return why_;
        if (network_->lost == kNone)
            return std::nullopt;
        return Error{name_of(network_->lost) + " is lost"};
    }
    void give_up(Error why) noexcept override {
        why_ = std::move(why);
        given_up_ = true;
        lose(rank_);
    }
    void close() override {
        if (!thread_.joinable())
            return;
        ++network_->closed;
        while (network_->closed < ranks_ && !lost())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        thread_.request_stop();
        thread_.join();
    }
    TransportCounts counts() const override { return {sent_, 0}; }

    void lose(uint32_t rank) { network_->lost = rank; }
    /// There is no memory from now on for what is sent to other ranks.
    void refuse_memory() { has_memory_ = false; }

protected:
    void send_away(uint32_t to, Message message) override {
        if (!has_memory_)
            throw std::bad_alloc();
        sent_ += message.bytes().size();
        network_->waiting[to].put(rank_, std::move(message));
    }

private:
    MemoryTransport(std::shared_ptr<Network> network, uint32_t rank, uint32_t ranks)
        : network_(std::move(network)), rank_(rank), ranks_(ranks) {
        thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    }

    void run(const std::stop_token& stop) {
        std::mt19937 random(rank_);
        while (!stop.stop_requested())
            for (Received& received : network_->waiting[rank_].take(std::chrono::milliseconds(2))) {
                std::this_thread::sleep_for(std::chrono::microseconds(random() % 300));
                deliver(received.from, std::move(received.message));
            }
    }

    const std::shared_ptr<Network> network_;
    const uint32_t rank_, ranks_;
    std::atomic<uint64_t> sent_{0};
    std::atomic<bool> has_memory_{true}, given_up_{false};
    Error why_; // before given_up_ is set
    std::jthread thread_;
};

} // namespace ovc::test
