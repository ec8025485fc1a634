// Copies values from one Lua state to another, for threads that run users' functions.
//
// Functions are copied with their upvalues (shared ones stay shared), the globals they name, tables with metatables,
// vectors, systems, excitations, friction laws, springs and integrators. Values of libraries are found by name. Others
// are refused, with the path to them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "lua/lua_headers.hpp"
#include "model/controller.hpp"
#include "model/excitation.hpp"
#include "text/expected.hpp"

namespace dinal::source {

/// Pushes the counterpart of the userdata at the index to `to`, and returns whether its class is known; for classes
/// that this room does not know.
using CarryObject = bool (*)(lua_State* from, int index, lua_State* to);

class Carrier {
public:
    /// To a new state without user data.
    Carrier(lua_State* from, lua_State* to, CarryObject other_objects);

    /// Pushes the counterpart of the value at the index to `to`; `name` is its name in errors. Raises a Lua error only
    /// if memory is insufficient, so call it in a protected call of `to`.
    std::optional<text::Error> carry(int index, const std::string& name);

private:
    struct Place {
        std::string module;  ///< "string"; empty for a global
        std::string name;    ///< "format"; empty for the module itself
    };
    struct Variable {
        const void* function;  // identity in `from`
        int number;
    };

    void note_standard(const std::string& library, const std::string& name);
    void note_library(const std::string& library);
    void push_place(const Place& place);
    void carry_additions();

    bool value(int index);
    bool push_counterpart(int index);
    bool table(int index);
    bool function(int index);
    bool variables(int index, int copy);
    bool c_function(int index);
    bool global(const std::string& name);
    bool object(int index);
    bool fail(int index, std::string_view cure = "");
    void remember(const void* identity);
    std::string path() const;

    using Function = std::shared_ptr<model::terms::UserFunction>;
    Function user_function(const Function& function);
    Function controller(const model::Controller& own);
    model::Excitation excitation(const model::Excitation& own);

    lua_State* from_;
    lua_State* to_;
    CarryObject other_objects_;
    int memory_ = 0;  // index in `to` of the table that maps identities in `from` to values
    std::unordered_map<const void*, Place> standard_;
    std::vector<Place> additions_;  // functions that a user added to libraries
    std::unordered_map<const void*, Variable> variables_;
    std::unordered_set<std::string> globals_;
    std::vector<std::string> path_;
    int depth_ = 0;
    std::optional<text::Error> error_;
};

}  // namespace dinal::source
