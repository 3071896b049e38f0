// SPDX-License-Identifier: Apache-2.0
// One thread a transport does all that MPI is needed for: it sends, receives, and listens for
// heartbeats. Ranks watch each other in a ring, so that a thousand of them send no more than two.
#include "plugin/ranks/transport/mpi_transport.h"

#include "core/system/blocked_signals.h"
#include "core/system/caught_error.h"
#include "core/text/format_text.h"

#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <stdexcept>
#include <thread>

namespace ovc {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kDefaultTimeout = 60;
constexpr int kMessageTag = 1, kHeartbeatTag = 2, kLostTag = 3, kEndTag = 4;

/// The ranks of MPI_COMM_WORLD, for what is done while there is no transport.
struct World {
    bool may_end_process = false;
    double timeout_seconds = kDefaultTimeout;
    std::vector<std::string> names;
};

World& world() {
    static World* const all = new World; // there at exit
    return *all;
}

[[noreturn]] void end_process(const std::string& sentence) {
    std::fputs(("overcast: error: " + sentence + "\n").c_str(), stderr);
    std::_Exit(1); // mpirun then ends the others
}

std::string name_of_this_process() {
    char host[256] = {};
    gethostname(host, sizeof(host) - 1);
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    return format_text("rank {} on {}", rank ? rank : "?", host);
}

std::runtime_error mpi_failure(int code, const std::string& doing) {
    char reason[MPI_MAX_ERROR_STRING] = {};
    int length = 0;
    MPI_Error_string(code, reason, &length);
    return std::runtime_error(format_text("MPI cannot {}: {}", doing, reason));
}

/// Throws where a call of MPI has failed. What was to be sent or received is then gone.
void check_mpi(int code, const char* doing) {
    if (code != MPI_SUCCESS)
        throw mpi_failure(code, doing);
}

/// Tells that this rank has waited too long.
std::string waited_in_vain(double seconds, const char* what) {
    return format_text("{} has waited {} s for another rank while {}", name_of_this_process(),
                       seconds, what);
}

/// While it lives, a call of MPI waits for all ranks, and would wait for ever for one that hangs.
/// Then this ends the process, if it may.
class LimitedWait {
public:
    explicit LimitedWait(const char* what) {
        if (!world().may_end_process)
            return;
        const BlockedSignals blocked;
        thread_ = std::jthread([what](const std::stop_token& stop) {
            std::mutex mutex;
            std::condition_variable_any changed;
            std::unique_lock lock(mutex);
            const auto timeout = std::chrono::duration<double>(world().timeout_seconds);
            changed.wait_for(lock, stop, timeout, [] { return false; });
            if (!stop.stop_requested())
                end_process(waited_in_vain(timeout.count(), what));
        });
    }

private:
    std::jthread thread_;
};

/// Waits for the rank before this one to come here too, and names it where it does not: while MPI
/// ends nobody could.
void wait_for_rank_before() {
    int rank = 0, ranks = 1, here = 1, there = 0, came = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const int before = (rank + ranks - 1) % ranks;
    MPI_Request requests[2];
    MPI_Isend(&here, 1, MPI_INT, (rank + 1) % ranks, kEndTag, MPI_COMM_WORLD, &requests[0]);
    MPI_Irecv(&there, 1, MPI_INT, before, kEndTag, MPI_COMM_WORLD, &requests[1]);
    const auto timeout = std::chrono::duration<double>(world().timeout_seconds);
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
    while (MPI_Testall(2, requests, &came, MPI_STATUSES_IGNORE) == MPI_SUCCESS && !came &&
           Clock::now() < until)
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    if (!came)
        end_process(format_text("{} has given no word for {} s while the job was ending",
                                size_t(before) < world().names.size()
                                    ? world().names[size_t(before)]
                                    : format_text("rank {}", before),
                                timeout.count()));
}

void end_mpi() {
    if (world().may_end_process)
        wait_for_rank_before();
    const LimitedWait limit("MPI ends");
    MPI_Finalize();
}

/// Starts MPI where the host has not, and then ends it with the process.
Result<Done> start_mpi() {
    int started = 0, ended = 0;
    MPI_Initialized(&started);
    MPI_Finalized(&ended);
    if (ended)
        return Error{"MPI has ended in this process"};
    int threads = MPI_THREAD_SINGLE;
    if (started) {
        MPI_Query_thread(&threads);
    } else {
        if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &threads) != MPI_SUCCESS)
            return Error{"MPI cannot be started"};
        std::atexit([] {
            int over = 0;
            MPI_Finalized(&over);
            if (!over)
                end_mpi();
        });
    }
    if (threads < MPI_THREAD_MULTIPLE)
        return Error{"MPI was started for fewer threads than are needed: call MPI_Init_thread with "
                     "MPI_THREAD_MULTIPLE",
                     ErrorKind::InvalidArgument};
    return Done{};
}

/// What MPI writes to where ranks come together. It stays in memory where one does not come, for
/// MPI writes to it whenever that does.
struct Meeting {
    MPI_Comm comm = MPI_COMM_NULL; // of these ranks, for one transport alone
    char name[MPI_MAX_PROCESSOR_NAME] = {};
    std::vector<char> names; // of all of them
};

/// Waits for a call that all ranks make. Throws where one of them does not make it in time: a call
/// of MPI that waits by itself would do so for ever.
void await_all_ranks(MPI_Request request, double timeout_seconds) {
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(timeout_seconds));
    std::chrono::microseconds nap(50);
    int came = 0;
    while (true) {
        check_mpi(MPI_Test(&request, &came, MPI_STATUS_IGNORE), "bring ranks together");
        if (came)
            return;
        if (Clock::now() >= until)
            break;
        std::this_thread::sleep_for(nap);
        nap = std::min(nap * 2, std::chrono::microseconds(5000));
    }
    const std::string sentence = waited_in_vain(timeout_seconds, "ranks come together");
    if (world().may_end_process)
        end_process(sentence);
    throw std::runtime_error(sentence);
}

/// All ranks of the communicator call this. Nothing: MPI makes no communicator like it.
std::unique_ptr<Meeting> meet(MPI_Comm given, double timeout_seconds) {
    auto meeting = std::make_unique<Meeting>();
    // By default MPI ends the process on an error, as for a handle that is none.
    MPI_Errhandler before;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Comm_get_errhandler(MPI_COMM_WORLD, &before);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    const int made = MPI_Comm_idup(given, &meeting->comm, &request);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, before);
    MPI_Errhandler_free(&before);
    if (made != MPI_SUCCESS)
        return nullptr;
    Meeting* const kept = meeting.release();
    await_all_ranks(request, timeout_seconds);
    MPI_Comm_set_errhandler(kept->comm, MPI_ERRORS_RETURN);
    int length = 0, ranks = 0;
    MPI_Get_processor_name(kept->name, &length);
    MPI_Comm_size(given, &ranks);
    kept->names.resize(size_t(ranks) * MPI_MAX_PROCESSOR_NAME);
    // By the given communicator: Open MPI 4.1 crashes where a message of the new one arrives before
    // its rank has it.
    check_mpi(MPI_Iallgather(kept->name, MPI_MAX_PROCESSOR_NAME, MPI_CHAR, kept->names.data(),
                             MPI_MAX_PROCESSOR_NAME, MPI_CHAR, given, &request),
              "bring ranks together");
    await_all_ranks(request, timeout_seconds);
    return std::unique_ptr<Meeting>(kept);
}

class MpiTransport final : public Transport {
public:
    MpiTransport(const Meeting& meeting, double timeout_seconds)
        : comm_(meeting.comm),
          timeout_(std::chrono::duration_cast<Clock::duration>(
              std::chrono::duration<double>(timeout_seconds))) {
        int rank = 0, ranks = 0;
        MPI_Comm_rank(comm_, &rank);
        MPI_Comm_size(comm_, &ranks);
        rank_ = uint32_t(rank);
        ranks_ = uint32_t(ranks);
        for (uint32_t i = 0; i < ranks_; ++i)
            hosts_.push_back(&meeting.names[size_t(i) * MPI_MAX_PROCESSOR_NAME]);
        int likeness = MPI_UNEQUAL;
        MPI_Comm_compare(comm_, MPI_COMM_WORLD, &likeness);
        if (likeness == MPI_CONGRUENT && world().names.empty())
            for (uint32_t i = 0; i < ranks_; ++i)
                world().names.push_back(name_of(i));
        const BlockedSignals blocked;
        thread_ = std::thread([this] { run(); });
    }
    ~MpiTransport() override {
        // An exception takes this rank out of what all of them do: the others must not wait for it.
        if (std::uncaught_exceptions() > exceptions_)
            give_up(out_of_memory());
        close();
        // With a rank gone, a call that all ranks make would not return.
        if (!lost_is_told())
            MPI_Comm_free(&comm_);
    }

    uint32_t rank() const override { return rank_; }
    uint32_t ranks() const override { return ranks_; }
    std::string name_of(uint32_t rank) const override {
        return format_text("rank {} on {}", rank, hosts_[rank]);
    }

    std::optional<Error> lost() const override {
        const std::lock_guard lock(mutex_);
        return lost_;
    }
    void give_up(Error why) noexcept override {
        lose(std::move(why));
        given_up_ = true;
    }
    void close() override {
        if (!thread_.joinable())
            return;
        closing_ = true;
        wake();
        thread_.join();
    }
    TransportCounts counts() const override { return {sent_, received_}; }

protected:
    void send_away(uint32_t to, Message message) override {
        {
            const std::lock_guard lock(mutex_);
            outgoing_.push_back({to, std::move(message)});
        }
        wake();
    }

private:
    struct Sending {
        MPI_Request request = MPI_REQUEST_NULL;
        Message message;   // or
        uint32_t word = 0; // about a rank
    };

    void wake() {
        const std::lock_guard lock(mutex_);
        woken_ = true;
        changed_.notify_one();
    }

    /// Where the work fails, heartbeats end with it: others learn thereby that this rank is lost.
    void run() noexcept {
        try {
            work();
        } catch (...) {
            give_up(caught_error());
        }
    }

    /// Works until all ranks have closed their transports, or one is lost.
    void work() {
        heard_ = Clock::now();
        MPI_Request all_closed = MPI_REQUEST_NULL;
        bool is_closing = false;
        constexpr std::chrono::microseconds kMinNap(100); // a batch takes some thousands
        std::chrono::microseconds nap = kMinNap;
        Clock::time_point busy = heard_;
        while (!given_up_) {
            const bool was_busy = send_what_waits() | receive_all() | forget_sent();
            send_heartbeat();
            watch_neighbour();
            // No message of this rank is under way any more, for all answers have come home.
            if (closing_ && !is_closing && sending_.empty()) {
                check_mpi(MPI_Ibarrier(comm_, &all_closed), "end");
                is_closing = true;
            }
            if (is_closing || closing_) {
                int over = 0;
                if (is_closing)
                    check_mpi(MPI_Test(&all_closed, &over, MPI_STATUS_IGNORE), "end");
                if (over || lost_is_told())
                    return;
            }
            // Where nothing has come for a while nobody waits: heartbeats are not in a hurry.
            const auto now = Clock::now();
            busy = was_busy ? now : busy;
            const std::chrono::microseconds max_nap(
                now - busy < std::chrono::milliseconds(100) ? 800 : 5000);
            nap = was_busy ? kMinNap : std::min(nap * 2, max_nap);
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, nap, [&] { return woken_; });
            woken_ = false;
        }
    }

    bool send_what_waits() {
        std::vector<std::pair<uint32_t, Message>> messages;
        {
            const std::lock_guard lock(mutex_);
            messages.swap(outgoing_);
        }
        for (auto& [to, message] : messages) {
            Sending& sending = sending_.emplace_back();
            sending.message = std::move(message);
            begin(sending, to, kMessageTag, sending.message.bytes());
        }
        return !messages.empty();
    }

    bool forget_sent() {
        return sending_.remove_if([](Sending& sending) {
            int over = 0;
            check_mpi(MPI_Test(&sending.request, &over, MPI_STATUS_IGNORE), "send");
            return over != 0;
        }) > 0;
    }

    bool receive_all() {
        bool any = false;
        while (true) {
            int is_there = 0;
            MPI_Message message;
            MPI_Status status;
            check_mpi(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &is_there, &message, &status),
                      "receive");
            if (!is_there)
                return any;
            int size = 0;
            MPI_Get_count(&status, MPI_BYTE, &size);
            MessageBytes bytes{size_t(size)};
            check_mpi(MPI_Mrecv(bytes.data(), size, MPI_BYTE, &message, MPI_STATUS_IGNORE),
                      "receive");
            received_ += size_t(size);
            const auto from = uint32_t(status.MPI_SOURCE);
            if (from == before())
                heard_ = Clock::now();
            if (status.MPI_TAG == kMessageTag) {
                deliver(from, Message(std::move(bytes)));
                any = true;
            } else if (status.MPI_TAG == kLostTag) {
                lose(silent(*reinterpret_cast<const uint32_t*>(bytes.data())));
            }
        }
    }

    uint32_t before() const { return (rank_ + ranks_ - 1) % ranks_; }
    uint32_t behind() const { return (rank_ + 1) % ranks_; }

    void send_heartbeat() {
        const auto now = Clock::now();
        if (ranks_ == 1 || now < next_heartbeat_)
            return;
        next_heartbeat_ = now + std::min<Clock::duration>(timeout_ / 4, std::chrono::seconds(1));
        send_word(behind(), kHeartbeatTag, rank_);
    }

    void watch_neighbour() {
        const auto now = Clock::now();
        // A process that was stopped itself has heard nothing of anybody.
        const bool was_away = now - looked_ > timeout_ / 2;
        looked_ = now;
        if (was_away)
            heard_ = now;
        if (ranks_ == 1 || now - heard_ <= timeout_ || lost_is_told())
            return;
        for (uint32_t rank = 0; rank < ranks_; ++rank)
            if (rank != rank_ && rank != before())
                send_word(rank, kLostTag, before());
        lose(silent(before()));
    }

    void send_word(uint32_t to, int tag, uint32_t word) {
        Sending& sending = sending_.emplace_back();
        sending.word = word;
        begin(sending, to, tag, std::as_bytes(std::span(&sending.word, 1)));
    }

    void begin(Sending& sending, uint32_t to, int tag, std::span<const std::byte> bytes) {
        const int code = MPI_Isend(bytes.data(), int(bytes.size()), MPI_BYTE, int(to), tag, comm_,
                                   &sending.request);
        if (code != MPI_SUCCESS)
            throw mpi_failure(code, "send to " + name_of(to));
        sent_ += bytes.size();
    }

    Error silent(uint32_t rank) const {
        return {format_text("{} has given no word for {} s; the job cannot go on without it",
                            name_of(rank), std::chrono::duration<double>(timeout_).count())};
    }
    void lose(Error why) noexcept {
        const std::lock_guard lock(mutex_);
        if (!lost_)
            lost_ = std::move(why);
    }
    bool lost_is_told() const {
        const std::lock_guard lock(mutex_);
        return lost_.has_value();
    }

    MPI_Comm comm_;
    const Clock::duration timeout_;
    const int exceptions_ = std::uncaught_exceptions();
    uint32_t rank_ = 0, ranks_ = 1;
    std::vector<std::string> hosts_;
    std::atomic<bool> closing_{false}, given_up_{false};
    std::atomic<uint64_t> sent_{0}, received_{0};
    mutable std::mutex mutex_; // guards the next four
    std::condition_variable changed_;
    std::vector<std::pair<uint32_t, Message>> outgoing_;
    std::optional<Error> lost_;
    bool woken_ = false;
    // of the thread
    std::list<Sending> sending_;
    Clock::time_point heard_, looked_ = Clock::now(), next_heartbeat_{};
    std::thread thread_;
};

} // namespace

Result<std::unique_ptr<Transport>> make_mpi_transport(const MpiTransportOptions& options) {
    const double timeout = options.timeout_seconds > 0 ? options.timeout_seconds : kDefaultTimeout;
    if (options.may_end_process)
        world() = {true, timeout, {}};
    {
        const LimitedWait limit("MPI starts");
        if (const Result<Done> started = start_mpi(); !started)
            return started.error();
    }
    const MPI_Comm given =
        options.communicator ? MPI_Comm_f2c(options.communicator) : MPI_COMM_WORLD;
    if (given == MPI_COMM_NULL)
        return Error{format_text("ovc_scene_config.communicator is {}, which is no communicator",
                                 options.communicator),
                     ErrorKind::InvalidArgument};
    try {
        const std::unique_ptr<Meeting> meeting = meet(given, timeout);
        if (meeting)
            return std::unique_ptr<Transport>(std::make_unique<MpiTransport>(*meeting, timeout));
    } catch (const std::runtime_error& error) {
        return Error{error.what()};
    }
    return Error{format_text("MPI cannot make a communicator like ovc_scene_config.communicator, "
                             "which is {}",
                             options.communicator),
                 ErrorKind::InvalidArgument};
}

void abort_all_ranks(int code) {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort(); // MPI_Abort() does not return
}

} // namespace ovc
