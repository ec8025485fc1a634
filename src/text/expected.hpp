// A value, or the one sentence that tells the user why there is none.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace dinal::text {

/// What is wrong, where the limit is and what to do about it, in one sentence without a final stop.
struct Error {
    std::string sentence;
};

template <class T>
class [[nodiscard]] Expected {
public:
    // Implicit on purpose: `return value;` and `return Error{...};` both read as they should.
    Expected(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
    Expected(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    explicit operator bool() const { return std::holds_alternative<T>(content_); }

    const T& value() const& { return std::get<T>(content_); }
    T&& value() && { return std::get<T>(std::move(content_)); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::get<T>(std::move(content_)); }
    const T* operator->() const { return &std::get<T>(content_); }

    const Error& error() const { return std::get<Error>(content_); }

private:
    std::variant<T, Error> content_;
};

}  // namespace dinal::text
