// SPDX-License-Identifier: Apache-2.0
// Result: a value, or one sentence that says what was wrong with the input.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace ovc {

/// The kinds of error that a caller may want to tell apart; most errors are for people alone.
enum class ErrorKind {
    Other,
    InvalidArgument,
    OutOfMemory,
    OutOfGpuMemory, // the driver's or the system's, not the budget
    OverBudget,
    DeviceLost,
    Cancelled,
    Unreadable,  // what was saved is damaged, or cannot be read
    InvalidState // the call comes too early or too late
};

/// One sentence: the file, line or argument, the value found and the value expected.
struct Error {
    std::string message;
    ErrorKind kind = ErrorKind::Other;
};

inline Error over_budget(std::string message) {
    return {std::move(message), ErrorKind::OverBudget};
}

template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const { return state_.index() == 0; }

    T& operator*() {
        assert(*this);
        return std::get<0>(state_);
    }
    const T& operator*() const {
        assert(*this);
        return std::get<0>(state_);
    }
    T* operator->() { return &**this; }
    const T* operator->() const { return &**this; }

    const Error& error() const {
        assert(!*this);
        return std::get<1>(state_);
    }

private:
    std::variant<T, Error> state_;
};

/// Stands for the value of a Result that has none: Result<Done> is Done{} or an Error.
struct Done {};

} // namespace ovc
