// identify{ ... } and the class of what it returns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identification.hpp"
#include "api/bind_excitation.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/identify_options.hpp"
#include "api/picture.hpp"
#include "api/plot_options.hpp"
#include "api/run.hpp"
#include "api/steady_answer.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "text/suggest.hpp"

namespace dinal::api {
namespace {

using analysis::Unknown;

struct FitAnswer {
    analysis::IdentifyQuestion question;
    analysis::Identified found;
    std::vector<std::pair<std::string, double>> values, errors;
    std::vector<std::string> silent;
    std::optional<model::Oscillator> system;
    model::AssemblyHandle rig = {};
    std::string remark = {};
    bool from_guess = false;  ///< a system was given
    model::Units units;       ///< of the record; without one for M where only ratios to I are found
};
using FitHandle = std::shared_ptr<const FitAnswer>;

const FitHandle& fit_self(lua_State* L, const char* call) {
    return lua::self<FitHandle>(L, 1, call);
}

void name_values(FitAnswer& fit) {
    const analysis::Identified& found = fit.found;
    const auto add = [&fit](std::string_view name, double value, double error) {
        fit.values.emplace_back(name, value);
        fit.errors.emplace_back(name, error > 0 ? std::max(error, 1e-15 * std::fabs(value)) : 0);  // some ulps
    };
    const auto given = [&fit](Unknown which) {
        return fit.question.given[static_cast<std::size_t>(which)].has_value();
    };
    const bool absolute = fit.question.M || given(Unknown::I) || given(Unknown::k);
    if (!absolute) fit.units.M.clear();
    add("omega0", found.omega0, found.omega0_error);
    add("zeta", found.zeta, found.zeta_error);
    add("Rd_over_k", found.Rd_over_k, found.Rd_over_k_error);
    for (std::size_t i = absolute ? 0 : static_cast<std::size_t>(Unknown::theta0); i < analysis::unknown_names.size();
         ++i) {
        add(analysis::unknown_names[i], found.value[i], found.error[i]);
    }
    if (absolute && found.is_noise) fit.silent = {"omega0", "zeta", "Rd_over_k"};
    for (std::size_t i = 0; i < analysis::unknown_names.size(); ++i) {
        if (!found.silent[i]) continue;
        std::string name(analysis::unknown_names[i]);
        if (!absolute && name == "k") name = "omega0";
        if (!absolute && name == "C") name = "zeta";
        if (!absolute && name == "Rd") name = "Rd_over_k";
        fit.silent.push_back(name);
    }
    const auto value = [&found](Unknown which) { return found.value[static_cast<std::size_t>(which)]; };
    auto system = model::Oscillator::make({.inertia = value(Unknown::I),
                                           .stiffness = value(Unknown::k),
                                           .damping = value(Unknown::C),
                                           .kinetic_friction = value(Unknown::Rd),
                                           .breakaway = std::max(value(Unknown::Re), value(Unknown::Rd)),
                                           .units = fit.units});
    if (system) fit.system = std::move(system).value();
}

int identify_record(lua_State* L) {
    const lua::Options options(L, 1, identify_call);
    IdentifyOptions asked;
    options.fill(asked);
    auto fit = std::make_shared<FitAnswer>();
    if (options.has("system")) {
        FittedParts parts = fit_any(L, options, asked);
        fit->units = units_of_record(L, options);
        fit->question.t = std::move(parts.t), fit->question.theta = std::move(parts.measured);
        fit->found.predicted = std::move(parts.predicted), fit->found.noise = parts.noise;
        fit->values = std::move(parts.values), fit->errors = std::move(parts.errors);
        fit->silent = std::move(parts.silent), fit->remark = std::move(parts.remark);
        fit->system = std::move(parts.system), fit->rig = std::move(parts.rig), fit->from_guess = true;
        lua::push<FitHandle>(L, std::move(fit));
        return 1;
    }
    for (const char* name : {"measured", "belt", "base", "states"}) {
        if (!options.has(name)) continue;
        options.push(name);
        options.fail(
            name, fmt::format("{} ({}) needs a guess: system = system{{ ... }} and free", name, lua::describe(L, -1)));
    }
    take_record(L, options, asked, fit->question);
    fit->units = units_of_record(L, options);
    if (options.has("M")) {
        options.push("M");
        fit->question.M = to_excitation(L, -1, "identify: M", "M");
        lua_pop(L, 1);
    }
    take_given(L, options, asked, fit->question);
    std::optional<text::Error> wrong;
    asking(L, [&](const motion::Monitor& monitor) {
        auto found = analysis::identify(fit->question, monitor);
        if (found) {
            fit->found = std::move(found).value();
        } else {
            wrong = found.error();
        }
    });
    if (wrong) options.fail(*wrong);
    name_values(*fit);
    lua::push<FitHandle>(L, std::move(fit));
    return 1;
}

// ---- the answer

int fit_value(lua_State* L) {
    const FitHandle& fit = fit_self(L, "fit.omega0");
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const std::string_view name = lua_tostring(L, 2);
    for (const auto& [known, value] : fit->values) {
        if (known == name) {
            lua_pushnumber(L, value);
            return 1;
        }
    }
    if (!fit->from_guess && std::find(analysis::unknown_names.begin(), analysis::unknown_names.end(), name) !=
                                analysis::unknown_names.end()) {
        lua::raise(L, {.sentence = fmt::format(
                           "a free decay determines only ratios, so there is no {}: give I or k to identify", name),
                       .culprit = std::string(name)});
    }
    std::vector<std::string_view> names;
    for (const auto& value : fit->values) names.emplace_back(value.first);
    for (const lua::Member& member : fit_class.members) {
        if (member.kind != lua::Kind::metamethod) names.emplace_back(member.name);
    }
    lua::raise(L, {.sentence = fmt::format("a fit has no field '{}'", name),
                   .culprit = std::string(name),
                   .cure = text::did_you_mean(name, names)});
}

std::vector<std::string> names_of_fit(const FitAnswer& fit) {
    std::vector<std::string> names;
    for (const auto& value : fit.values) names.push_back(value.first);
    return names;
}

int fit_system(lua_State* L) {
    const FitHandle& fit = fit_self(L, "fit.system");
    fit->system ? static_cast<void>(lua::push(L, *fit->system)) : lua_pushnil(L);
    if (fit->rig != nullptr) lua::push<model::AssemblyHandle>(L, fit->rig);
    return 1;
}

std::vector<double> residual_of(const FitAnswer& fit) {
    std::vector<double> residual(fit.question.t.size());
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = fit.question.theta[i] - fit.found.predicted[i];
    return residual;
}

int fit_residual(lua_State* L) {
    lua::push_vector(L, residual_of(*fit_self(L, "fit.residual")));
    return 1;
}

constexpr text::Call fit_plot_call{"fit:plot", "fit:plot{ file = \"fit.svg\" }", target_options, true};

int fit_plot(lua_State* L) {
    const FitHandle fit = fit_self(L, "fit:plot()");
    const lua::Options options(L, 2, fit_plot_call);
    const auto curve = [&fit](std::vector<double> y, const char* label, plots::Style style) {
        plots::Curve made;
        made.x = plots::Numbers::own(fit->question.t);
        made.y = plots::Numbers::own(std::move(y));
        made.label = label;
        made.style = style;
        return made;
    };
    std::vector<plots::Figure> figures(2);
    figures[0].curves = {curve(fit->question.theta, "record", plots::Style::points),
                         curve(fit->found.predicted, "fit", plots::Style::line)};
    figures[1].curves = {curve(residual_of(*fit), "", plots::Style::points)};
    figures[1].title = "record - fit";
    const ColumnUnits in(fit->units);
    for (plots::Figure& figure : figures) {
        figure.x.label = model::of_unit("t", in.t);
        if (!in.theta.empty()) figure.y.label = model::of_unit("θ", in.theta);
    }
    return deliver(L, options, std::move(figures));
}

/// What a value of this name is measured in; nothing where nobody has said it.
std::string unit_of_value(const model::Units& units, std::string_view name) {
    if (units.usual()) return "";
    if (name == "omega0") return units.t.empty() ? "" : "rad/" + units.t;
    if (name == "velocity0") return units.speed();
    if (name == "Rd_over_k" || name == "theta0" || name == "offset") return units.theta;
    return name == "I"                    ? units.inertia()
           : name == "k"                  ? units.stiffness()
           : name == "C"                  ? units.damping()
           : name == "Rd" || name == "Re" ? units.M
                                          : "";
}

std::string fit_summary(const FitAnswer& fit) {
    std::string text = fmt::format("fit of {} samples, {:.3g} of noise:", fit.question.t.size(), fit.found.noise);
    std::size_t width = 10;
    for (const auto& value : fit.values) width = std::max(width, value.first.size());
    for (std::size_t i = 0; i < fit.values.size(); ++i) {
        const auto& [name, value] = fit.values[i];
        const double error = fit.errors[i].second;
        text += fmt::format("\n  {:<{}} {:<12.6g}", name, width, value);
        text += error > 0 ? fmt::format(" +- {:.2g}", error) : "";
        text.erase(text.find_last_not_of(' ') + 1);
        text = model::with_unit(std::move(text), unit_of_value(fit.units, name));
    }
    if (!fit.silent.empty()) text += fmt::format("\n  the record says nothing about {}", fmt::join(fit.silent, ", "));
    constexpr auto kinetic = static_cast<std::size_t>(Unknown::Rd), holding = static_cast<std::size_t>(Unknown::Re);
    const double Rd = fit.found.value[kinetic], Re = fit.question.given[holding].value_or(Rd);
    if (Re < Rd * (1 - 1e-9) - 3 * fit.found.error[kinetic]) {  // a record without noise leaves rounding
        text += fmt::format(
            "\n  Re = {:.6g} is given, but the fitted Rd is greater: Re cannot be less than Rd, so the fit has Re = "
            "Rd; leave Re out, or give Rd as well",
            Re);
    }
    if (fit.found.is_noise) {
        text += "\n  it fits the record no better than it would fit noise, so there may be no motion in it";
    } else if (fit.found.is_unexplained) {
        text += fmt::format(
            "\n  neighbouring samples scatter by {:.3g} only, so the residual is not noise: another kind of system "
            "made this record, a given value is wrong, or the best fit was not found",
            fit.found.scatter);
        if (const auto wild = fit.found.wild) {
            text += fmt::format("; sample {} at t = {:.6g} causes more than half of it: is it an outlier?", *wild + 1,
                                fit.question.t[*wild]);
        }
    }
    if (!fit.remark.empty()) text += "\n  " + fit.remark;
    if (fit.found.M_is_noisy) text += "\n  the errors ignore the noise of M: they may be far too small";
    if (fit.question.given.back() == 0.0) text += "\n  offset is held at 0";
    if (const std::size_t cut = fit.found.cut_low + fit.found.cut_high; cut > 0) {
        text += fmt::format("\n  {} samples have the extreme values of the record, as if it were clipped there", cut);
    }
    return text;
}

int fit_text(lua_State* L) {
    const std::string text = fit_summary(*fit_self(L, "tostring(fit)"));
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

#define DINAL_FIT                                               \
    "sys = system{ I = 1, k = 40, C = 0.3, Rd = 0.8 }\n"        \
    "run = sys:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }\n"  \
    "noise = vector.normal{ n = #run, seed = 1, std = 0.01 }\n" \
    "fit = identify{ data = { t = run.t, theta = run.theta + noise }, velocity0 = 0 }\n"

constexpr lua::Member fit_members[] = {
    {lua::a_value<FitHandle, names_of_fit>,
     {"fit.names -> table", "The names of the values that it has.",
      DINAL_FIT "print(fit.names[1], fit[fit.names[1]] == fit.omega0)  --> omega0\ttrue"}},
    {lua::a_value<FitHandle, &FitAnswer::errors>,
     {"fit.std_error -> table",
      "The standard errors by name: the truth lies within two of them in 19 of 20 records. Given values have 0.",
      DINAL_FIT "print(math.abs(fit.omega0 - sys.omega0) < 3 * fit.std_error.omega0)  --> true"}},
    {lua::a_value<FitHandle, &FitAnswer::silent>,
     {"fit.silent -> table",
      "The names of values that the record does not determine: Re of a free decay or of a motion without stops; "
      "Rd_over_k, theta0 and offset of a decay in one direction, which determines only their sums. The values "
      "given are possible ones.",
      DINAL_FIT "print(table.concat(fit.silent, \" \"))  --> Re"}},
    {lua::a_field<fit_system>,
     {"fit.system -> system", "The fitted system; for a free decay without I and k, with I = 1.",
      DINAL_FIT "print(fit.system.I, math.abs(fit.system.k - 40) < 0.2)  --> 1.0\ttrue"}},
    {lua::a_value<FitHandle, [](const FitAnswer& fit) { return fit.found.noise; }>,
     {"fit.noise -> number", "The standard deviation of record minus fit.",
      DINAL_FIT "print(math.abs(fit.noise - 0.01) < 0.001)  --> true"}},
    {lua::a_field<fit_residual>,
     {"fit.residual -> vector", "Record minus fit at each sample. It should look like noise.",
      DINAL_FIT "print(#fit.residual == #run)  --> true"}},
    {lua::a_method<fit_plot>,
     {"fit:plot{ OPTIONS }",
      "Plots the record with the fit, and the residual.",
      DINAL_FIT "print(#tostring(fit:plot{ show = false }) > 500)  --> true",
      {&fit_plot_call}}},
    {lua::a_metamethod<fit_text>("__tostring"),
     {"tostring(fit) -> string",
      "All values with their standard errors, and a sentence where the fit does not explain the record.",
      DINAL_FIT "print(tostring(fit):match(\"^[^,]*\"))  --> fit of 401 samples"}},
};

#undef DINAL_FIT

std::string fit_card(lua_State* L, int index, const terminal::Display&) {
    return fit_summary(**lua::test<FitHandle>(L, index));
}

constexpr lua::Member identify_members[] = {
    {lua::a_function<identify_record>,
     {"identify{ OPTIONS } -> fit",
      "Finds the system that made a record. A free decay (no M) gives omega0, zeta, Rd_over_k and the start; with "
      "I or k also the others. With a known M it gives I, k, C, Rd, Re and the start. Given values are not "
      "fitted.\nWith system, a guess, and free it fits any numbers of any system of one mass, and of tables that M "
      "uses, to measured angles, velocities or accelerations, also on a belt, on a shaking base or with states: "
      "fit[\"friction.speed\"]. Correlated residuals widen the errors, and the fit reports that.",
      "run = system{ I = 1, k = 40, C = 0.3, Rd = 0.8 }:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }\n"
      "fit = identify{ data = run, I = 1 }\n"
      "print(string.format(\"%.4f %.4f %.4f\", fit.k, fit.C, fit.Rd))  --> 40.0000 0.3000 0.8000",
      {&identify_call}}},
};

}  // namespace

const lua::Class identify_functions = {
    "identify",
    {"identify{ ... } -> fit", "Finds the system behind a record.", "print(identify ~= nil)  --> true"},
    identify_members};

const lua::Class fit_class = {
    "fit",
    {"identify{ ... } -> fit",
     "The result of identify: fit.omega0, fit.zeta, fit.Rd_over_k, fit.theta0, fit.velocity0, fit.offset, and "
     "fit.I, fit.k, fit.C, fit.Rd, fit.Re where the record tells them.",
     "run = nondimensional{ friction_ratio = 0.05 }:simulate{ theta0 = 1, t_end = 6, dt = 0.05 }\n"
     "print(string.format(\"%.4f\", identify{ data = run }.Rd_over_k))  --> 0.0500"},
    fit_members,
    lua::guarded<fit_value>,
    fit_card};

void register_identify(lua_State* L) {
    lua::add_class<FitHandle>(L, fit_class);
    lua::add_functions(L, identify_functions);
}

}  // namespace dinal::api
