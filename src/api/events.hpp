// The list run.events as Lua sees it: plain tables that know how to write themselves.
#pragma once

#include <span>

#include "lua/lua_headers.hpp"
#include "model/event.hpp"

namespace dinal::api {

/// Pushes { { t, kind, theta, M }, ... }.
void push_events(lua_State* L, std::span<const model::Event> events);

}  // namespace dinal::api
