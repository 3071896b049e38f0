// SPDX-License-Identifier: Apache-2.0
// SharedFunction is a function whose copies share what it captured: the triangles of a mesh, the
// formula that another formula calls.
#pragma once

#include <cassert>
#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

namespace ovc::pov {

template <class Signature>
class SharedFunction;

/// A scene names, copies and forgets its shapes and formulas in any order, and a loop may make and
/// forget a million of them. So copies are cheap, and the last of them frees what was captured: an
/// arena would grow with the loop. Unlike std::function it holds what cannot be copied.
template <class Result, class... Arguments>
class SharedFunction<Result(Arguments...)> {
public:
    SharedFunction() = default;
    template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, SharedFunction>) SharedFunction(F function)
        : captured_(std::make_shared<const F>(std::move(function))),
          call_([](const void* captured, Arguments... arguments) -> Result {
              return (*static_cast<const F*>(captured))(std::forward<Arguments>(arguments)...);
          }) {}

    explicit operator bool() const { return call_ != nullptr; }
    Result operator()(Arguments... arguments) const {
        assert(call_);
        return call_(captured_.get(), std::forward<Arguments>(arguments)...);
    }

private:
    std::shared_ptr<const void> captured_;
    Result (*call_)(const void*, Arguments...) = nullptr;
};

} // namespace ovc::pov
