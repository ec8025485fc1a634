// A value, or an error for the user.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace dinal::text {

/// An error: its sentence says what is wrong, the limit and what to do, without a final stop. The facts are stored
/// separately, so that error markers and hints need not parse the sentence.
struct Error {
    std::string sentence;
    std::string call = {};     ///< the call as written: "vector", "run:at(t)", "sys:simulate{ t_end = 1 }"
    std::string option = {};   ///< the option that is wrong or missing: "t_end"
    std::string culprit = {};  ///< the user's text at fault: an unknown name, a value; "nil" for a missing value
    std::string cure = {};     ///< appended to the sentence: "; did you mean 'theta0'?"
    std::string instead = {};  ///< appended if the script offers no better hint: "; it has t, theta"

    std::string message() const { return sentence + cure; }
};

/// Returns an error whose sentence is formatted.
template <class... Values>
Error error(fmt::format_string<Values...> sentence, Values&&... values) {
    return {fmt::format(sentence, std::forward<Values>(values)...)};
}

/// Returns the error with the call in front: "system: I = -1 must be positive".
inline Error in_call(std::string_view call, Error error) {
    error.sentence.insert(0, std::string(call) + ": ");
    error.call = call;
    return error;
}

template <class T>
class [[nodiscard]] Expected {
public:
    // Implicit on purpose, for `return value;` and `return Error{...};`.
    Expected(const T& value) : content_(value) {}          // NOLINT(google-explicit-constructor)
    Expected(T&& value) : content_(std::move(value)) {}    // NOLINT(google-explicit-constructor)
    Expected(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    explicit operator bool() const { return std::holds_alternative<T>(content_); }

    T& value() & { return std::get<T>(content_); }
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
