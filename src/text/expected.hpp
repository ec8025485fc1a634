// A value, or the error that tells the user why there is none.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace dinal::text {

/// What is wrong, where the limit is and what to do about it, in one sentence without a final stop; and the facts in
/// it, so that nobody who marks the culprit or looks for a cure has to find them in the words.
struct Error {
    std::string sentence;
    std::string call = {};    ///< what was called, as it is written: "vector", "run:at(t)", "sys:simulate{ t_end = 1 }"
    std::string option = {};  ///< the option that is wrong or missing: "t_end"
    std::string culprit = {};  ///< what the user wrote: a name that does not exist, a value; "nil" where nothing is
    std::string cure = {};     ///< what goes on after the sentence: "; did you mean 'theta0'?"
    std::string instead = {};  ///< the same where nobody who reads the script knows better: "; it has t, theta"

    [[nodiscard]] std::string message() const { return sentence + cure; }
};

/// The same error, told by the call in which it came up: "system: I = -1 must be positive".
inline Error in_call(std::string_view call, Error error) {
    error.sentence.insert(0, std::string(call) + ": ");
    error.call = call;
    return error;
}

template <class T>
class [[nodiscard]] Expected {
public:
    // Implicit on purpose: `return value;` and `return Error{...};` both read as they should.
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
