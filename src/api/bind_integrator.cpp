// integrator.NAME{...} for every row of motion/integrators.hpp, and the objects they make: their options are fields.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "lua/options.hpp"
#include "motion/integrators.hpp"
#include "source/describe.hpp"
#include "text/fixed_text.hpp"

namespace dinal::api {

namespace {

constexpr const char* name_of(const motion::MethodText& about) {
    constexpr std::string_view module = "integrator.";
    return about.call.name + module.size();
}

motion::Integrator& integrator_self(lua_State* L) {
    return lua::self<motion::Integrator>(L, 1, "integrator.h");
}

// ---- integrator.rk4{ h = 0.001 }

template <class M>
int make(lua_State* L) {
    lua::push<motion::Integrator>(L, lua::read<M>(L, 1, M::about.call));
    return 1;
}

template <class M>
constexpr text::FixedText<64> signature{M::about.call.name, "{ OPTIONS } -> integrator"};

template <class... M>
constexpr std::array<lua::Member, sizeof...(M)> functions_of(std::type_identity<std::variant<M...>> /*all*/) {
    return {lua::Member{lua::a_function<make<M>>,
                        {signature<M>.c_str(), M::about.summary, M::about.example, {&M::about.call}}}...};
}

constexpr auto integrator_module_members = functions_of(std::type_identity<motion::Integrator>());

// ---- integrator.h

const text::Option* find_option(const motion::MethodText& about, std::string_view name) {
    const auto found = std::find_if(about.call.options.begin(), about.call.options.end(),
                                    [=](const text::Option& option) { return option.name == name; });
    return found == about.call.options.end() ? nullptr : &*found;
}

/// An option of one method or of several.
struct Field {
    const text::Option* option;
    const motion::MethodText* method;  ///< the first that has it
    std::string lacking;               ///< "exact, rk4 and dinal1989"
};

template <class... M>
std::vector<Field> fields_of(std::type_identity<std::variant<M...>> /*all*/) {
    const std::array<const motion::MethodText*, sizeof...(M)> methods{&M::about...};
    std::vector<Field> fields;
    for (const motion::MethodText* method : methods) {
        for (const text::Option& option : method->call.options) {
            const auto has_it = [&](const auto* other) { return find_option(*other, option.name) != nullptr; };
            if (*std::find_if(methods.begin(), methods.end(), has_it) != method) continue;
            std::vector<std::string_view> lacking;
            for (const motion::MethodText* other : methods) {
                if (!has_it(other)) lacking.emplace_back(name_of(*other));
            }
            std::string names;
            for (std::size_t i = 0; i < lacking.size(); ++i) {
                names.append(i == 0 ? "" : i + 1 < lacking.size() ? ", " : " and ").append(lacking[i]);
            }
            fields.push_back({&option, method, std::move(names)});
        }
    }
    return fields;
}

const std::vector<Field>& fields() {
    static const std::vector<Field> all = fields_of(std::type_identity<motion::Integrator>());
    return all;
}

/// A value that is absent or without limit is nil.
void push_option(lua_State* L, const text::Option& option, const text::OptionValue& value) {
    if (const auto* number = std::get_if<double>(&value); number != nullptr && std::isfinite(*number)) {
        lua_pushnumber(L, *number);
    } else if (const bool* flag = std::get_if<bool>(&value)) {
        lua_pushboolean(L, *flag ? 1 : 0);
    } else if (const auto* choice = std::get_if<std::size_t>(&value)) {
        lua_pushstring(L, option.choices[*choice]);
    } else {
        lua_pushnil(L);
    }
}

template <std::size_t i>
int option_field(lua_State* L) {
    std::visit(
        [L](const auto& method) {
            const text::Option* option = find_option(method.about, fields()[i].option->name);
            option != nullptr ? push_option(L, *option, option->filled.get(&method)) : lua_pushnil(L);
        },
        integrator_self(L));
    return 1;
}

template <class... M, std::size_t... i>
constexpr auto getters_of(std::type_identity<std::variant<M...>> /*all*/, std::index_sequence<i...> /*places*/) {
    return std::array{lua::a_field<option_field<i>>...};
}

template <class... M>
constexpr std::size_t options_of(std::type_identity<std::variant<M...>> /*all*/) {
    return (M::about.call.options.size() + ...);  // at least as many as there are fields
}

constexpr auto getters = getters_of(std::type_identity<motion::Integrator>(),
                                    std::make_index_sequence<options_of(std::type_identity<motion::Integrator>())>());

/// What the example of the method makes of the option, as Lua text.
std::string value_in_example(const Field& field) {
    const std::string_view example = field.method->call.example;
    const std::string given = fmt::format(" {} = ", field.option->name);
    if (const auto at = example.find(given); at != std::string_view::npos) {
        const std::string_view rest = example.substr(at + given.size());
        return std::string(rest.substr(0, rest.find_first_of(", ")));
    }
    text::Option of_new_object = *field.option;
    of_new_object.otherwise = text::its_own;
    const std::string value = text::default_text(of_new_object);
    return value.empty() ? "nil" : value;
}

lua::Member member_of(std::size_t i) {
    static std::deque<std::string> texts;  // as long as the program: a Doc only points to its texts
    const auto kept = [](std::string text) { return texts.emplace_back(std::move(text)).c_str(); };
    const Field& field = fields()[i];
    const text::Option& option = *field.option;
    const char* type = option.filled.kind == text::OptionKind::number ? "number"
                       : option.filled.kind == text::OptionKind::flag ? "boolean"
                                                                      : "string";
    const std::string unit = *option.unit == '\0' ? "" : fmt::format(" ({})", option.unit);
    const std::string lacking = field.lacking.empty() ? "" : fmt::format("; nil for {}", field.lacking);
    return {getters[i],
            {kept(fmt::format("integrator.{} -> {}", option.name, type)),
             kept(fmt::format("Its option {}: {}{}{}.", option.name, option.meaning, unit, lacking)),
             kept(fmt::format("print({}.{} == {})  --> true", field.method->call.example, option.name,
                              value_in_example(field)))}};
}

int name(lua_State* L) {
    return lua::push_text(L, name_of(motion::MethodView(integrator_self(L)).about()));
}

int integrator_text(lua_State* L) {
    return lua::push_text(L, source::lua_text(integrator_self(L)));
}

std::vector<lua::Member> all_members() {
    std::vector<lua::Member> members = {
        {lua::a_field<name>,
         {"integrator.name -> string", "The name of the method.", "print(integrator.rk4{ h = 0.001 }.name)  --> rk4"}},
        {lua::a_metamethod<integrator_text>("__tostring"),
         {"tostring(integrator) -> string", "The Lua text that recreates it.",
          "print(integrator.dinal1989{ h = 0.01 })  --> integrator.dinal1989{ h = 0.01 }"}},
    };
    for (std::size_t i = 0; i < fields().size(); ++i) members.insert(members.end() - 1, member_of(i));
    return members;
}

const std::vector<lua::Member> integrator_members = all_members();

constexpr text::FixedText<160> module_summary{"The methods a run can use. The default is ",
                                              motion::default_integrator.c_str(), "."};

}  // namespace

const lua::Class integrator_module = {
    "integrator",
    {"integrator.NAME{ ... } -> integrator", module_summary.c_str(),
     "sys = nondimensional{ zeta = 0.1 }\n"
     "run = sys:simulate{ theta0 = 1, t_end = 2, dt = 0.5, integrator = integrator.rk4{ h = 0.01 } }\n"
     "print(run.integrator)  --> integrator.rk4{ h = 0.01 }"},
    integrator_module_members};

const lua::Class integrator_class = {
    "integrator",
    {"integrator.rk4{ h = 0.001 } -> integrator", "A method with its options, for `integrator =` in sys:simulate{...}.",
     "print(integrator.rk4{ h = 0.001 }.h)  --> 0.001"},
    integrator_members,
    nullptr,
    integrator_card};

void register_integrator(lua_State* L) {
    lua::add_class<motion::Integrator>(L, integrator_class);
    lua::add_module(L, integrator_module);
}

}  // namespace dinal::api
