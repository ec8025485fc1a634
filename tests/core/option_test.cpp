#include "text/option.hpp"

#include <limits>

#include "support/catch.hpp"

namespace dinal::option_test {

namespace {

struct Pump {
    enum class Mode { slow, fast };
    double flow = 1;
    double period = 0;
    double most = std::numeric_limits<double>::infinity();
    Mode mode = Mode::slow;
    bool primed = false;
    int stages = 1;
    std::optional<double> limit;
    std::vector<double> breaks;
};

void set_frequency(Pump& pump, double frequency) {
    pump.period = 1 / frequency;
}

constexpr const char* modes[] = {"slow", "fast"};

constexpr text::Option options[] = {
    {.name = "flow", .filled = text::fills<&Pump::flow>},
    {.name = "period", .otherwise = text::needed, .range = text::positive, .filled = text::fills<&Pump::period>},
    {.name = "frequency",
     .otherwise = text::needed,
     .range = text::positive,
     .filled = text::sets<set_frequency>,
     .instead_of_previous = true},
    {.name = "most", .range = text::positive_or_infinite, .filled = text::fills<&Pump::most>},
    {.name = "mode", .filled = text::fills<&Pump::mode>, .choices = modes},
    {.name = "primed", .filled = text::fills<&Pump::primed>},
    {.name = "stages", .filled = text::fills<&Pump::stages>},
    {.name = "limit", .otherwise = "flow", .range = text::not_negative, .filled = text::fills<&Pump::limit>},
    {.name = "breaks", .filled = text::fills<&Pump::breaks>},
};

std::string complaint(const Pump& pump) {
    const auto wrong = text::complaint(options, pump);
    return wrong ? wrong->sentence : "";
}

}  // namespace

TEST_CASE("a row of an option fills its member and reads it back", "[option]") {
    Pump pump;
    options[4].filled.set(&pump, std::size_t{1});
    options[2].filled.set(&pump, 4.0);
    options[7].filled.set(&pump, 2.5);
    CHECK(pump.mode == Pump::Mode::fast);
    CHECK(pump.period == 0.25);
    CHECK(pump.limit == 2.5);
    CHECK(text::lua_text("pump", options, pump, text::Defaults::left_out) ==
          "pump{ period = 0.25, mode = \"fast\", limit = 2.5 }");
    CHECK(text::lua_text("pump", options, pump, text::Defaults::written) ==
          "pump{ flow = 1, period = 0.25, mode = \"fast\", primed = false, stages = 1, limit = 2.5, breaks = {} }");
    pump.limit.reset();
    CHECK(text::lua_text("pump", options, pump, text::Defaults::told) ==
          "pump{ flow = 1, period = 0.25, mode = \"fast\", primed = false, stages = 1, limit = flow, breaks = {} }");
}

TEST_CASE("the default of an option is that of a new object unless the row says otherwise", "[option]") {
    CHECK(text::default_text(options[0]) == "1");
    CHECK(text::default_text(options[1]).empty());  // needed
    CHECK(text::default_text(options[3]).empty());  // without limit
    CHECK(text::default_text(options[4]) == "\"slow\"");
    CHECK(text::default_text(options[5]) == "false");
    CHECK(text::default_text(options[7]) == "flow");
    CHECK(text::default_text(options[8]) == "{}");
}

TEST_CASE("a number out of its range is told by the name, the value and the limit", "[option]") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Pump pump;
    CHECK(complaint(pump) == "period = 0 must be positive");
    pump.period = infinity;
    CHECK(complaint(pump) == "period = inf must be finite");
    pump.period = std::numeric_limits<double>::quiet_NaN();
    CHECK(complaint(pump) == "period = nan must be finite");
    pump.period = 1;
    CHECK(complaint(pump).empty());  // most = inf is no limit
    pump.most = -infinity;
    CHECK(complaint(pump) == "most = -inf must be positive");
    pump.most = 3;
    pump.limit = -2;
    CHECK(complaint(pump) == "limit = -2 must not be negative");
    pump.limit = 2;
    pump.breaks = {1, infinity};
    CHECK(complaint(pump) == "breaks[2] = inf must be finite");
}

}  // namespace dinal::option_test
