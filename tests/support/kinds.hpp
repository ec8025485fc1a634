// Event kinds of the independent references, which detect stops but not whether they last for ever.
#pragma once

#include "model/event.hpp"

namespace dinal::truth {

/// Maps a rest to the stick that it is as well.
constexpr model::EventKind as_stop(model::EventKind kind) {
    return kind == model::EventKind::rest ? model::EventKind::stick : kind;
}

}  // namespace dinal::truth
