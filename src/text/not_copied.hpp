// The base of classes that are neither copied nor moved.
#pragma once

namespace dinal::text {

class NotCopied {
public:
    NotCopied(const NotCopied&) = delete;
    NotCopied& operator=(const NotCopied&) = delete;

protected:
    NotCopied() = default;
    ~NotCopied() = default;
};

}  // namespace dinal::text
