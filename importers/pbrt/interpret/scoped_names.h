// SPDX-License-Identifier: Apache-2.0
// ScopedNames keeps what the names of textures and materials mean.
#pragma once

#include <cassert>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ovc::pbrt {

/// A name that is defined anew within a scope means what it did before once that ends, as in v1 to
/// v3. One that is new there stays, as in v4, which defines no name twice.
template <class T>
class ScopedNames {
public:
    /// Returns null for a name that means nothing.
    T* find(const std::string& name) {
        const auto at = now_.find(name);
        return at == now_.end() ? nullptr : &at->second;
    }
    const T* find(const std::string& name) const {
        const auto at = now_.find(name);
        return at == now_.end() ? nullptr : &at->second;
    }

    T& define(const std::string& name, T meaning) {
        const auto [at, is_new] = now_.try_emplace(name);
        if (!is_new)
            before_.emplace_back(name, std::move(at->second));
        return at->second = std::move(meaning);
    }

    /// Returns what end() takes for a scope that begins now.
    size_t begin() const { return before_.size(); }
    /// leave: is called with each name, and with what it meant within the scope.
    template <class Leave>
    void end(size_t begin, const Leave& leave) {
        assert(begin <= before_.size());
        for (; before_.size() > begin; before_.pop_back()) {
            auto& [name, meaning] = before_.back();
            leave(name, now_[name]);
            now_[name] = std::move(meaning);
        }
    }
    void end(size_t begin) {
        end(begin, [](const std::string&, const T&) {});
    }

    /// Calls f with every name and meaning, those too that others took the place of.
    template <class F>
    void for_each(const F& f) const {
        for (const auto& [name, meaning] : now_)
            f(name, meaning);
        for (const auto& [name, meaning] : before_)
            f(name, meaning);
    }

private:
    std::unordered_map<std::string, T> now_;
    std::vector<std::pair<std::string, T>> before_; // what later meanings took the place of
};

} // namespace ovc::pbrt
