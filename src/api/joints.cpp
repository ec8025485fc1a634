// Bodies and links: from the options of system{...} to joints, and back to options for :with{...}.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "api/bind_excitation.hpp"
#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "api/drive_options.hpp"
#include "api/lua_run.hpp"
#include "api/system_options.hpp"
#include "lua/user_function.hpp"
#include "model/controller.hpp"
#include "model/functions.hpp"
#include "model/laws/coulomb.hpp"
#include "source/describe.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

namespace engine = motion::engine;

}  // namespace

std::vector<std::string> body_names(const model::System& system) {
    std::vector<std::string> names;
    for (const model::Body& body : system.bodies) names.push_back(body.name);
    return names;
}

std::size_t joint_named(lua_State* L, std::string_view name, const model::System& system, const char* what,
                        const lua::Class& of) {
    if (const auto known = system.joint_named(name)) return *known;
    if (!system.named) lua::raise(L, "{} has no '{}': it has one body without a name", what, name);
    std::vector<std::string> own;
    for (const model::Joint& joint : system.joints) own.push_back(joint.name);
    raise_unknown_name(L, fmt::format("{} has no '{}'; its bodies and links are {}", what, name, fmt::join(own, ", ")),
                       name, own, of);
}

void for_each_named(lua_State* L, const lua::Options& options, const char* option, const model::System& system,
                    Names which, const std::function<void(std::size_t)>& f) {
    if (!options.has(option)) return;
    options.push(option);
    if (!system.named) {
        f(0);
        lua_pop(L, 1);
        return;
    }
    if (lua_type(L, -1) != LUA_TTABLE) options.wrong(option, by_body_wanted);
    std::vector<std::string> known;
    const std::size_t first = which == Names::links ? system.bodies.size() : 0;
    const std::size_t end = which == Names::bodies ? system.bodies.size() : system.joints.size();
    for (std::size_t j = first; j < end; ++j) known.push_back(system.joints[j].name);
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const std::string name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : lua::written(L, -2);
        const auto found = std::ranges::find(known, name);
        if (found == known.end()) {
            const char* kind = which == Names::bodies ? "body" : which == Names::links ? "link" : "body or link";
            options.fail({.sentence = fmt::format("{}: there is no {} '{}'; there is {}", option, kind, name,
                                                  known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))),
                          .option = option,
                          .culprit = name,
                          .cure = text::did_you_mean(name, known)});
        }
        f(first + static_cast<std::size_t>(found - known.begin()));
    }
    lua_pop(L, 1);
}

namespace {

/// Fields of runs that names of bodies and links must not hide.
constexpr std::string_view names_in_runs[] = {"at",     "continue", "data",  "energy",  "events",    "explain",
                                              "plot",   "animate",  "save",  "states",  "status",    "outcome",
                                              "system", "t",        "t_end", "t_start", "integrator"};

/// The names of the tables in the option, which stays on the top.
std::vector<std::string> tables_by_name(lua_State* L, const lua::Options& options, const char* option) {
    options.push(option);
    std::vector<std::string> names = names_in_table(L, options, option);
    for (const std::string& name : names) {
        if (text::contains(names_in_runs, name)) {
            options.fail(
                {.sentence = fmt::format("{}: '{}' is a name that a run has already; take another", option, name),
                 .option = option,
                 .culprit = name});
        }
        check_name(options, option, name, system_class);
        if (lua_getfield(L, -1, name.c_str()) != LUA_TTABLE) {
            options.fail(
                {.sentence = fmt::format("{}.{} must be a table such as {}, got {}", option, name,
                                         *option == 'l' ? "{ \"motor\", \"load\", k = 90 }" : "{ I = 1, Rd = 0.4 }",
                                         lua::describe(L, -1)),
                 .option = option,
                 .culprit = lua::written(L, -1)});
        }
        lua_pop(L, 1);
    }
    return names;
}

/// Reads a joint except its bodies.
model::Joint asked_joint(lua_State* L, const lua::Options& options, double& inertia) {
    model::OscillatorParameters numbers;
    options.fill(numbers);
    inertia = numbers.inertia;
    model::Joint joint;
    joint.stiffness = numbers.stiffness, joint.damping = numbers.damping;
    joint.friction = asked_friction(L, options, options.call());
    joint.spring = asked_spring(L, options).value_or(model::Spring());
    joint.walls = asked_walls(L, options);
    if (const auto wrong = joint.walls ? joint.walls->complaint() : std::nullopt) options.fail(*wrong);
    if (joint.walls && joint.walls->is_elastic()) std::swap(joint.walls, joint.stops);
    return joint;
}

/// Reads a body, and its joint with the ground, from the table on the top.
model::Joint read_body(lua_State* L, const std::string& call, model::Body& body) {
    text::Call own = body_call;
    own.name = call.c_str();
    const lua::Options options(L, lua_gettop(L), own);
    for (const char* motion : {"theta", "velocity"}) {
        if (!options.has(motion)) continue;
        if (body.moved) options.fail(motion, "theta and velocity exclude each other; give one of them");
        body.moved = model::Moved{.by_angle = *motion == 't', .motion = read_motion(L, options, motion)};
    }
    model::Joint joint = asked_joint(L, options, body.inertia);
    if (!options.has("I") && !body.moved) options.missing("I");
    if (body.moved && !options.has("I")) body.inertia = 0, body.moved->without_inertia = true;
    if (body.moved && joint.walls) {
        options.fail("walls", "rigid walls cannot stop a body that is moved; leave them out, or give them a stiffness");
    }
    return joint;
}

}  // namespace

text::Expected<model::Oscillator> oscillator_of(const model::System& system) {
    if (system.named) {
        return text::error("needs one body, and this system has names: take one of them, such as sys.{}",
                           system.joints.front().name);
    }
    if (!system.is_plain()) {
        const model::Joint& body = system.joints.front();
        return text::Error{
            body.stops ? "needs rigid walls, and those of this system are elastic"
            : body.friction.is_constant()
                ? "needs friction of a law alone, and that of this system acts one way or through springs"
                : "needs constant friction, and that of this system varies"};
    }
    return model::oscillator_at(system, 0);
}

int push_alone(lua_State* L, std::string_view call, const model::System& system, std::size_t j) {
    if (!system.is_link(j) && system.bodies[j].moved) {
        lua::fail(L, call, "{} is moved, and so no system by itself", system.joints[j].name);
    }
    const auto oscillator = lua::value_or_raise(L, call, model::oscillator_at(system, j));
    model::System one{
        .bodies = {{"", oscillator.inertia()}}, .joints = {system.joints[j]}, .named = false, .units = system.units};
    one.joints[0].name.clear(), one.joints[0].of = {model::Weight{}};
    lua::push<SystemHandle>(L, std::make_shared<const model::System>(std::move(one)));
    return 1;
}

namespace {

std::size_t body_index(const lua::Options& options, const model::System& system, const std::string& link,
                       lua_State* L) {
    const std::string name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        if (system.bodies[i].name == name) return i;
    }
    const std::vector<std::string> names = body_names(system);
    options.fail({.sentence = name.empty() ? fmt::format("links.{0} must begin with the names of two bodies, such as "
                                                         "{{ \"{1}\", \"{2}\", k = 90 }}, or give each of its bodies a "
                                                         "weight, such as {{ {1} = 1, {2} = -2, k = 90 }}",
                                                         link, names.front(), names.back())
                                           : fmt::format("links.{}: there is no body '{}'; there is {}", link, name,
                                                         fmt::join(names, ", ")),
                  .option = "links",
                  .culprit = name,
                  .cure = name.empty() ? "" : text::did_you_mean(name, names)});
}

/// Removes the bodies and weights of a link from the table on the top and returns them.
std::vector<model::Weight> take_weights(lua_State* L, const lua::Options& options, const model::System& system,
                                        const std::string& link) {
    std::vector<model::Weight> weights;
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        const std::string& body = system.bodies[i].name;
        const bool is_option = text::contains(link_options, body, &text::Option::name);
        if (lua_getfield(L, -1, body.c_str()) != LUA_TNIL && !is_option) {
            const double by = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : 0;
            if (!std::isfinite(by) || by == 0) {
                options.fail("links", "links.{}: the weight of {} must be a number other than 0, got {}", link, body,
                             lua::describe(L, -1));
            }
            weights.push_back({i, by});
            lua_pushnil(L);
            lua_setfield(L, -3, body.c_str());
        }
        lua_pop(L, 1);
    }
    return weights;
}

/// Reads a link from the table on the top: between its first two entries, or any bodies with weights.
model::Joint read_link(lua_State* L, const lua::Options& options, const model::System& system,
                       const std::string& name) {
    const int given = lua_gettop(L);
    const lua_Unsigned listed = lua_rawlen(L, given);
    lua::push_copy(L, given, static_cast<lua_Integer>(listed));
    std::vector<model::Weight> weights = take_weights(L, options, system, name);
    if (!weights.empty() && listed > 0) {
        options.fail("links", "links.{}: name two bodies, or give each body its weight, not both", name);
    }
    if (weights.size() == 1) {
        options.fail("links", "links.{} gives {} a weight, but no other body", name,
                     system.bodies[weights.front().body].name);
    }
    for (lua_Integer end = 1; end <= 2 && weights.size() < 2; ++end) {
        lua_rawgeti(L, given, end);
        weights.push_back({body_index(options, system, name, L), end == 1 ? 1.0 : -1.0});
        lua_pop(L, 1);
    }
    if (weights[0].body == weights[1].body) {
        options.fail("links", "links.{} must be between two different bodies", name);
    }
    if (listed > 2) {
        options.fail("links",
                     "links.{} is between two bodies, and names {}; give each body its weight for "
                     "more: {{ sun = 1, ring = 1.5, carrier = -2.5 }}",
                     name, listed);
    }
    const std::string call = fmt::format("{}: links.{}", options.call(), name);
    text::Call own_call = link_call;
    own_call.name = call.c_str();
    const lua::Options own(L, lua_gettop(L), own_call);
    double none = 0;
    model::Joint joint = asked_joint(L, own, none);
    if (own.has("ratio")) {
        if (listed == 0) own.fail("ratio", "ratio is for a link that names two bodies; here each has its weight");
        weights[1].by = -own.number("ratio");
    }
    joint.of = std::move(weights);
    own.push("rigid");
    if (!lua_isnil(L, -1) && !lua_isboolean(L, -1)) own.wrong("rigid");
    joint.rigid = lua_toboolean(L, -1) != 0;
    for (const char* idle : {"k", "C", "spring", "Rd", "Re", "friction", "normal", "walls"}) {
        if (joint.rigid && own.has(idle)) {
            own.fail(idle, "a rigid link keeps its angle, so {} can do nothing there; leave one of them out", idle);
        }
    }
    lua_pop(L, 2);
    return joint;
}

/// Raises an error if a named system is given options of a single body.
void refuse_of_one(const lua::Options& options) {
    for (const char* alone : {"I", "k", "C", "Rd", "Re", "friction", "normal", "spring", "walls"}) {
        if (!options.has(alone)) continue;
        options.fail(alone, "{} is an option of a body: bodies = {{ load = {{ {}{} = ... }} }}", alone,
                     std::string_view(alone) == "I" ? "" : "I = 1, ", alone);
    }
}

}  // namespace

int push_bodies(lua_State* L, const lua::Options& options) {
    const std::vector<std::string> names = tables_by_name(L, options, "bodies");
    if (names.empty()) options.wrong("bodies");
    refuse_of_one(options);
    model::System system;
    system.units = asked_units(L, options).value_or(model::Units());
    for (std::size_t i = 0; i < names.size(); ++i) {
        lua_getfield(L, -1, names[i].c_str());
        model::Body body{.name = names[i]};
        model::Joint joint = read_body(L, fmt::format("{}: bodies.{}", options.call(), names[i]), body);
        joint.name = names[i], joint.of = {{i, 1}};
        system.bodies.push_back(std::move(body));
        system.joints.push_back(std::move(joint));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (options.has("links")) {
        for (const std::string& name : tables_by_name(L, options, "links")) {
            if (text::contains(names, name)) {
                options.fail("links", "links: '{}' is the name of a body already; take another", name);
            }
            lua_getfield(L, -1, name.c_str());
            model::Joint joint = read_link(L, options, system, name);
            joint.name = name;
            system.joints.push_back(std::move(joint));
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
    }
    lua::push<SystemHandle>(L, std::make_shared<const model::System>(std::move(system)));
    return 1;
}

int push_body(lua_State* L, const lua::Options& options) {
    double inertia = 0;
    model::System system{.bodies = {}, .joints = {asked_joint(L, options, inertia)}, .named = false};
    system.bodies.push_back({"", inertia});
    system.units = asked_units(L, options).value_or(model::Units());
    return push_alone(L, options.call(), system, 0);
}

namespace {

/// Reads a list of laws on the top: returns their sum; sliders go into `friction`.
model::Friction read_list(lua_State* L, const lua::Options& options, model::ContactFriction& friction) {
    using enum model::Motion;
    model::Friction main;
    std::array<double, 2> sliding{}, holding{};
    for (lua_Integer i = 1, n = static_cast<lua_Integer>(lua_rawlen(L, -1)); i <= n; ++i) {
        lua_rawgeti(L, -1, i);
        const auto* law = lua::test<model::Friction>(L, -1);
        if (law == nullptr) {
            options.fail("friction",
                         "friction[{}] must be a law such as friction.jenkins{{ stiffness = 100, "
                         "Rd = 1 }}, got {}",
                         i, lua::describe(L, -1));
        }
        friction.listed.push_back(*law);
        if (law->bending() != nullptr || (law->depends_on_speed() && main.depends_on_speed())) {
            options.fail("friction",
                         "friction[{}]: a list takes one law that depends on the speed, and none of "
                         "bristles",
                         i);
        }
        if (const auto* slider = law->as<model::laws::Jenkins>()) {
            friction.sliders.push_back(*slider);
        } else if (law->depends_on_speed()) {
            main = *law;
        } else {
            for (const auto& [side, way] : {std::pair(0U, backward), std::pair(1U, forward)}) {
                sliding.at(side) += law->sliding(way, 0), holding.at(side) += law->holding(way);
            }
        }
        lua_pop(L, 1);
    }
    if (main.depends_on_speed()) {
        return model::laws::Sum<true>{.main = main, .more_sliding = sliding, .more_holding = holding};
    }
    if (sliding == std::array<double, 2>{} && holding == std::array<double, 2>{}) return {};
    return model::laws::Sum<false>{.main = {}, .more_sliding = sliding, .more_holding = holding};
}

/// Reads the options of the friction in a joint, and of its normal load.
class FrictionOptions {
public:
    FrictionOptions(lua_State* L, const lua::Options& options, const std::string& call)
        : L_(L), options_(options), call_(call) {}

    model::ContactFriction read() {
        friction_.normal = varying("normal");
        normal_ = number("normal");
        options_.push("friction");
        if (lua_istable(L_, -1) && lua_rawlen(L_, -1) > 0) return by_list();
        if (lua::is_callable(L_, -1) && lua::test<model::Friction>(L_, -1) == nullptr) return by_function();
        lua_pop(L_, 1);
        const auto Rd = number("Rd"), Re = number("Re");
        if (const auto law = asked_law(L_, options_, {"Rd", "Re"}, true)) return by_law(*law);
        const bool constant = (!options_.has("Rd") || Rd) && (!options_.has("Re") || Re);
        if (!constant) return by_torques();
        const model::laws::Coulomb law{Rd.value_or(0), Re.value_or(Rd.value_or(0))};
        if (auto wrong = law.complaint()) options_.fail(*wrong);
        return by_law(law.breakaway > 0 ? model::Friction(law) : model::Friction());
    }

private:
    std::optional<model::Excitation> varying(const char* name) {
        if (!options_.has(name)) return {};
        options_.push(name);
        model::Excitation value = to_excitation(L_, -1, fmt::format("{}: {}", call_, name), name);
        lua_pop(L_, 1);
        // Sampling instants are supported for controllers in M only.
        if (model::has_memory(value)) {
            options_.fail(name, "{} must be {}; a controller with a memory acts in M", name, varying_wanted);
        }
        return value;
    }
    std::optional<double> number(const char* name) {
        options_.push(name);
        const bool is = lua_type(L_, -1) == LUA_TNUMBER;
        lua_pop(L_, 1);
        return is ? std::optional(options_.number(name)) : std::nullopt;
    }
    void exclude(const char* other) {
        if (options_.has(other)) options_.fail(other, "friction and Rd exclude each other; give one of them");
    }

    /// Merges a constant load into the law, except for bristles, whose load stays separate.
    model::ContactFriction by_law(const model::Friction& law) {
        friction_.law = law;
        if (const auto* slider = law.as<model::laws::Jenkins>()) friction_.sliders = {*slider}, friction_.law = {};
        if ((!friction_.sliders.empty() || law.is_one_way()) && friction_.normal && !normal_) refuse_load();
        if (!normal_ || friction_.bending() != nullptr) return friction_;
        friction_.law = friction_.law.under(*normal_);
        friction_.normal.reset();
        return friction_;
    }
    void refuse_load() { options_.fail("normal", "the normal load of freewheel and jenkins must be a number"); }

    // The following two functions pop the option `friction`.
    model::ContactFriction by_list() {
        for (const char* other : {"Rd", "Re"}) exclude(other);
        const model::Friction law = read_list(L_, options_, friction_);
        lua_pop(L_, 1);
        const std::vector<model::laws::Jenkins> sliders = std::exchange(friction_.sliders, {});
        by_law(law);
        friction_.sliders = sliders;
        if (!sliders.empty() && friction_.normal) refuse_load();
        return friction_;
    }
    model::ContactFriction by_function() {
        friction_.function =
            std::make_shared<lua::LuaFunction>(L_, -1,
                                               lua::FunctionRole{.name = "friction",
                                                                 .may_be_negative = false,
                                                                 .motion = lua::FunctionRole::Motion::always,
                                                                 .of_speed = true});
        exclude("Rd");
        lua_pop(L_, 1);
        number("Re");  // raises an error if out of range
        if (auto holding = varying("Re")) friction_.holding = {holding, holding};
        return friction_;
    }

    /// Torques that vary with time.
    model::ContactFriction by_torques() {
        auto sliding = varying("Rd"), holding = varying("Re");
        if (!sliding) {  // only breakaway friction is given
            sliding = model::Excitation::make(model::Constant{0}).value();
        }
        friction_.sliding = {sliding, sliding};
        if (holding) friction_.holding = {holding, holding};
        return friction_;
    }

    lua_State* L_;
    const lua::Options& options_;
    const std::string& call_;
    model::ContactFriction friction_;
    std::optional<double> normal_;  ///< a constant load
};

}  // namespace

model::ContactFriction asked_friction(lua_State* L, const lua::Options& options, const std::string& call) {
    return FrictionOptions(L, options, call).read();
}

namespace {

/// Pushes a constant as a number and a lone function as itself, otherwise the excitation.
void push_acting(lua_State* L, const model::Excitation& value) {
    const auto& parts = value.components();
    const auto* constant = parts.size() == 1 ? std::get_if<model::Constant>(&parts.front().term) : nullptr;
    const bool always = constant != nullptr && parts.front().from == -model::never && parts.front().to == model::never;
    if (const lua::LuaFunction* function = source::function_alone(value)) {
        function->push(L);
    } else if (always) {
        lua_pushnumber(L, parts.front().gain * constant->amplitude);
    } else {
        lua::push(L, value);
    }
}

/// Receives options, and sets them in the table on the top.
struct OptionTable {
    lua_State* L;

    void body(const std::string& name) const {
        lua::push_text(L, name);
        lua_rawseti(L, -2, static_cast<lua_Integer>(lua_rawlen(L, -2)) + 1);
    }
    void unless_0(const char* name, double x) const { (*this)(name, x); }
    template <class Value>
    void operator()(const char* name, const Value& value) const {
        lua::set_value(L, name, value);
    }
    void operator()(const char* name, const model::Walls& walls) const { (*this)(name, walls_by_name(walls)); }
    void operator()(const char* name, const model::Excitation& value) const {
        push_acting(L, value);
        lua_setfield(L, -2, name);
    }
    void operator()(const char* name, const model::UserFunction& function) const {
        const auto* own = dynamic_cast<const lua::LuaFunction*>(&function);
        if (own == nullptr) return;
        own->push(L);
        lua_setfield(L, -2, name);
    }
};

}  // namespace

void push_joint(lua_State* L, const model::System& system, std::size_t j) {
    lua_newtable(L);
    OptionTable table{L};
    model::give_options(system, j, table);
}

namespace {

/// Merges the options in the table on the top into the options of a body below it. New Rd and Re replace another law by
/// Coulomb's; Re follows Rd if both were equal.
void overwrite(lua_State* L, const lua::Options& options) {
    const int changes = lua_gettop(L), into = changes - 1;
    const auto has = [L](int table, const char* name) {
        const bool is = lua_getfield(L, table, name) != LUA_TNIL;
        lua_pop(L, 1);
        return is;
    };
    const auto remove = [&](const char* name) {
        lua_pushnil(L);
        lua_setfield(L, into, name);
    };
    const bool Rd = has(changes, "Rd"), Re = has(changes, "Re");
    if (has(changes, "friction")) {
        remove("Rd"), remove("Re");
    } else if (has(into, "friction")) {
        lua_getfield(L, into, "friction");
        const auto* law = lua::test<model::Friction>(L, -1);
        if (Rd != Re && (Rd || law != nullptr)) {
            options.fail(Rd ? "Rd" : "Re", "the friction of this system is {}: give both Rd and Re, or friction",
                         law == nullptr ? "a function" : source::lua_text(L, *law));
        }
        lua_pop(L, 1);
        if (Rd) remove("friction");
    } else if (Rd && !Re) {
        lua_getfield(L, into, "Rd");
        lua_getfield(L, into, "Re");
        const bool one_number = lua_rawequal(L, -1, -2) != 0;
        lua_pop(L, 2);
        if (one_number) remove("Re");
    }
    for (lua_pushnil(L); lua_next(L, changes) != 0; lua_pop(L, 1)) {
        lua_pushvalue(L, -2);
        lua_pushvalue(L, -2);
        lua_rawset(L, into);
    }
}

}  // namespace

int system_with(lua_State* L) {
    const model::System& old = *lua::self<SystemHandle>(L, 1, with_call.example);
    const lua::Options options(L, 2, with_call);
    const int top = lua_gettop(L);
    for (const char* option : {"bodies", "links"}) {
        if (old.named || !options.has(option)) continue;
        options.push(option);
        if (!lua_istable(L, -1)) options.wrong(option);
        options.fail(option, "{} are of a system with names, and this one has one body without one", option);
    }
    if (old.named) {
        refuse_of_one(options);
        lua_newtable(L);
        for (const Names which : {Names::bodies, Names::links}) {
            lua_newtable(L);
            for (std::size_t j = 0; j < old.joints.size(); ++j) {
                if (old.is_link(j) != (which == Names::links)) continue;
                push_joint(L, old, j);
                lua_setfield(L, -2, old.joints[j].name.c_str());
            }
            const char* option = which == Names::links ? "links" : "bodies";
            for_each_named(L, options, option, old, which, [&](std::size_t j) {
                const std::string& name = old.joints[j].name;
                if (!lua_istable(L, -1)) {
                    options.fail(option, "{}.{} must be a table such as {{ k = 3 }}, got {}", option, name,
                                 lua::describe(L, -1));
                }
                lua_getfield(L, top + 2, name.c_str());
                lua_pushvalue(L, -2);
                overwrite(L, options);
                lua_pop(L, 2);
            });
            lua_setfield(L, top + 1, option);
        }
    } else {
        push_joint(L, old, 0);
        lua_pushvalue(L, 2);
        overwrite(L, options);
        lua_pop(L, 1);
    }
    if (options.has("units")) {
        options.push("units");
        lua_setfield(L, top + 1, "units");
    } else {
        lua::set_value(L, "units", units_by_name(old.units));
    }
    lua_replace(L, 2);
    lua_settop(L, 2);
    const lua::Options all(L, 2, {with_call.name, with_call.example, system_options});
    return old.named ? push_bodies(L, all) : push_body(L, all);
}

}  // namespace dinal::api
