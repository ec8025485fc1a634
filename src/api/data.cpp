#include "api/data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "files/csv.hpp"
#include "lua/memory_limit.hpp"
#include "motion/columns.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

constexpr std::size_t most_rows = 15;
constexpr std::size_t widest_word = 24;

std::string short_word(std::string word) {
    if (text::columns(word) <= widest_word) return word;
    return std::string(text::cut_to_columns(word, widest_word - 3)) + "...";
}

/// The lines of a table with the columns that fit; the first column is the row number.
class TableText {
public:
    TableText(const Data& data, std::size_t rows) : rows_(rows) {
        cells_.emplace_back(1, "i");
        for (std::size_t row = 0; row < rows; ++row) cells_.front().push_back(std::to_string(row + 1));
        right_.push_back(true);
        for (const DataColumn& column : data.columns) {
            std::vector<std::string>& cells = cells_.emplace_back(1, text::displayable(column.label()));
            for (std::size_t row = 0; row < rows; ++row) {
                cells.push_back(short_word(text::displayable(column.text(row))));
            }
            right_.push_back(column.numbers() != nullptr);
        }
    }
    std::string lines(std::size_t width) const {
        std::vector<std::string> lines(rows_ + 1);
        std::size_t used = 0, left_out = 0;
        for (std::size_t column = 0; column < cells_.size(); ++column) {
            const std::size_t wide = width_of(cells_[column]) + 2;
            if (left_out > 0 || (used + wide >= width && column > 1)) {
                ++left_out;
                continue;
            }
            used += wide;
            for (std::size_t row = 0; row <= rows_; ++row) {
                const std::string& cell = cells_[column][row];
                const std::string blanks(wide - 2 - text::columns(cell), ' ');
                lines[row] += "  " + (right_[column] ? blanks + cell : cell + blanks);
            }
        }
        std::string all;
        for (std::string& line : lines) {
            line.erase(line.find_last_not_of(' ') + 1);
            all += "\n" + line;
        }
        return left_out == 0 ? all : all + fmt::format("\n  ... {}", text::counted(left_out, "more column"));
    }

private:
    static std::size_t width_of(const std::vector<std::string>& cells) {
        std::size_t width = 0;
        for (const std::string& cell : cells) width = std::max(width, text::columns(cell));
        return width;
    }

    std::size_t rows_;
    std::vector<std::vector<std::string>> cells_;
    std::vector<bool> right_;
};

std::size_t bytes_of(const Data& data) {
    return data.columns.size() * data.size() * sizeof(double);
}

/// "41 events: 39 turns, 1 stick, 1 slip"
std::string heading_of(std::span<const model::Event> events) {
    std::map<model::EventKind, std::size_t> kinds;
    for (const model::Event& event : events) ++kinds[event.kind];
    std::string text = text::counted(events.size(), "event");
    const char* separator = ": ";
    for (const auto& [kind, count] : kinds) {
        text += separator + text::counted(count, model::name(kind));
        separator = ", ";
    }
    return text;
}

}  // namespace

std::string first_word(const std::vector<std::string>& words) {
    const auto found = std::ranges::find_if(words, [](const auto& word) { return !files::parse_field(word, false); });
    if (found != words.end()) return files::quoted_for_message(*found);
    const auto number = std::ranges::find_if(words, [](const auto& word) { return !word.empty(); });
    return number == words.end() ? "''" : "the number " + *number + " in double quotes";
}

std::size_t DataColumn::size() const {
    const lua::Vector* vector = numbers();
    return vector != nullptr ? vector->size() : words().size();
}

DataColumn DataColumn::rows(const std::vector<std::size_t>& rows) const {
    const auto picked = [&rows](const auto& from, auto into) {
        into.reserve(rows.size());
        for (const std::size_t row : rows) into.push_back(from[row]);
        return into;
    };
    const lua::Vector* vector = numbers();
    return vector != nullptr ? column_of(name, picked(vector->values(), std::vector<double>()), unit)
                             : column_of(name, picked(words(), std::vector<std::string>()));
}

void DataColumn::push(lua_State* L, std::size_t row) const {
    const lua::Vector* vector = numbers();
    vector != nullptr ? lua_pushnumber(L, vector->begin()[row]) : static_cast<void>(lua::push_text(L, words()[row]));
}

files::NamedColumn DataColumn::named() const {
    const lua::Vector* vector = numbers();
    return vector != nullptr ? files::NamedColumn{.name = name, .values = vector->values()}
                             : files::NamedColumn{.name = name, .words = words()};
}

std::string DataColumn::text(std::size_t row) const {
    if (const lua::Vector* vector = numbers()) {
        const double x = vector->begin()[row];
        return std::isnan(x) ? "nan" : fmt::format("{:.6g}", x);
    }
    return words()[row];
}

const DataColumn* Data::find(std::string_view name) const {
    const auto found = std::ranges::find(columns, name, &DataColumn::name);
    return found != columns.end() ? &*found : nullptr;
}

const DataCompanion* Data::companion(std::string_view name) const {
    const auto found = std::ranges::find(companions, name, &DataCompanion::name);
    return found != companions.end() ? &*found : nullptr;
}

DataColumn column_of(std::string name, std::vector<double> numbers, std::string unit) {
    return {std::move(name), lua::Vector(std::move(numbers)), std::move(unit)};
}

DataColumn column_of(std::string name, std::vector<std::string> words) {
    return {std::move(name), std::make_shared<const std::vector<std::string>>(std::move(words))};
}

DataColumn column_of(files::ReadColumn column) {
    return column.of_words ? column_of(std::move(column.name), std::move(column.words))
                           : column_of(std::move(column.name), std::move(column.numbers), std::move(column.unit));
}

ColumnUnits::ColumnUnits(const model::Units& units) {
    if (units.usual()) return;
    named = units;
    t = units.t;
    theta = units.theta;
    M = units.M;
    speed = units.speed();
    frequency = units.frequency();
}

std::string ColumnUnits::of(std::string_view column) const {
    column.remove_prefix(column.find('.') + 1);  // of "load.theta"
    const motion::ColumnKind* kind = motion::find_column_kind(column);
    return kind != nullptr && named ? named->of(kind->quantity) : "";
}

int push_data(lua_State* L, Data data) {
    const std::size_t bytes = bytes_of(data);
    lua::push<DataHandle>(L, std::make_shared<const Data>(std::move(data)));
    lua::note_external_memory(L, bytes);
    return 1;
}

void push_events(lua_State* L, std::span<const model::Event> events, std::span<const std::string> user_names,
                 const model::Units& units, const model::System* several) {
    const ColumnUnits in(units);
    using model::Event;
    Data data = table_of(events, ListColumn{"t", &Event::t, in.t},
                         ListColumn{"kind", [](const Event& e) { return model::name(e.kind); }},
                         ListColumn{"theta", &Event::theta, in.theta}, ListColumn{"M", &Event::M, in.M},
                         ListColumn{"velocity", &Event::velocity, in.speed});
    const ListColumn names{
        "name", [&](const Event& e) { return e.user < 0 ? "" : user_names[static_cast<std::size_t>(e.user)]; }};
    if (!user_names.empty()) data.columns.push_back(names.column_from(events));
    const ListColumn where{"where", [&](const Event& e) {
                               return e.user >= 0 ? "" : several->joints[static_cast<std::size_t>(e.where)].name;
                           }};
    if (several != nullptr) data.columns.insert(data.columns.begin() + 2, where.column_from(events));
    data.heading = heading_of(events);
    push_data(L, std::move(data));
}

std::string text_of(const Data& data, std::size_t width) {
    const std::size_t n = data.size();
    std::string text = data.heading;
    if (text.empty()) {
        text = fmt::format("data: {} of ", text::counted(n, "row"));
        for (std::size_t i = 0; i < data.columns.size(); ++i) {
            text += (i == 0 ? "" : ", ") + text::displayable(data.columns[i].name);
        }
        text = text::wrapped(text, width);
    }
    if (n > 0) text += TableText(data, std::min(n, most_rows)).lines(width);
    if (n <= most_rows) return text;
    const std::string more = "  ... " + text::counted(n - most_rows, "more row"),
                      cure = ":markdown() after its name shows all";
    const bool fits = text::columns(more) + text::columns(cure) + 2 < width;
    return text + "\n" + more + (fits ? "; " : "\n  ") + cure;
}

std::string html_of(const Data& data, std::size_t rows) {
    std::string all = "<div class=\"table\" style=\"overflow-x: auto\"><table>\n<thead><tr>";
    for (const DataColumn& column : data.columns) all += "<th>" + text::html(column.label()) + "</th>";
    all += "</tr></thead>\n<tbody>\n";
    for (std::size_t row = 0; row < std::min(rows, data.size()); ++row) {
        all += "<tr>";
        for (const DataColumn& column : data.columns) all += "<td>" + text::html(column.text(row)) + "</td>";
        all += "</tr>\n";
    }
    all += "</tbody>\n</table></div>\n";
    return data.size() <= rows ? all : all + fmt::format("<p>{} of {}</p>\n", rows, text::counted(data.size(), "row"));
}

PointGrid::PointGrid(std::vector<DataColumn> parameters)
    : parameters_(std::move(parameters)), strides_(parameters_.size()) {
    for (std::size_t i = parameters_.size(); i-- > 0;) {
        strides_[i] = size_;
        size_ *= parameters_[i].size();
    }
}

void PointGrid::set_fields(lua_State* L, std::size_t point) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        lua::push_text(L, parameters_[i].name);
        parameters_[i].push(L, place(i, point));
        lua_rawset(L, -3);
    }
}

std::vector<DataColumn> PointGrid::columns(const std::vector<std::size_t>& points) const {
    std::vector<DataColumn> columns;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        std::vector<std::size_t> places;
        places.reserve(points.size());
        for (const std::size_t point : points) places.push_back(place(i, point));
        columns.push_back(parameters_[i].rows(places));
    }
    return columns;
}

}  // namespace dinal::api
