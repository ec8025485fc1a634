// Kinds of events as the independent truths tell them: these know where a mass stops, and not whether it stays for
// good.
#pragma once

#include "model/event.hpp"

namespace dinal::truth {

/// A rest is the stick that it also is.
constexpr model::EventKind as_stop(model::EventKind kind) {
    return kind == model::EventKind::rest ? model::EventKind::stick : kind;
}

}  // namespace dinal::truth
