// SPDX-License-Identifier: Apache-2.0
// FunctionRef: a callable as a parameter, so that the function that takes it need be no template.
#pragma once

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

namespace ovc {

template <class Signature>
class FunctionRef;

/// Refers to a callable, which the caller keeps alive as long as the reference is used. It
/// allocates nothing.
template <class Result, class... Args>
class FunctionRef<Result(Args...)> {
public:
    template <class Callable>
    requires(!std::same_as<std::remove_cvref_t<Callable>, FunctionRef> &&
             std::is_invocable_r_v<Result, Callable&, Args...>) FunctionRef(Callable&& callable)
        : callable_((void*)std::addressof(callable)), call_([](void* it, Args... args) -> Result {
              return (*(std::remove_reference_t<Callable>*)it)(std::forward<Args>(args)...);
          }) {}

    Result operator()(Args... args) const { return call_(callable_, std::forward<Args>(args)...); }

private:
    void* callable_; // a C-style cast makes it of an object and of a function alike
    Result (*call_)(void*, Args...);
};

} // namespace ovc
