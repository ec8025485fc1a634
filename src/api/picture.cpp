#include "api/picture.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "api/plot_options.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"
#include "lua/worker_state.hpp"
#include "plots/gnuplot.hpp"
#include "plots/svg_words.hpp"
#include "terminal/display.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

plots::Interval asked_range(const lua::Options& options, std::string_view name, const std::vector<double>& ends,
                            bool logarithmic) {
    if (ends.size() != 2 || !(ends[0] < ends[1])) {
        options.fail(name, fmt::format("{} must be two increasing numbers such as {{ 0, 10 }}", name));
    }
    if (logarithmic && ends[0] <= 0) {
        options.fail(name, fmt::format("{} = {{ {:.6g}, {:.6g} }} must be positive on a logarithmic axis", name,
                                       ends[0], ends[1]));
    }
    // So far apart, or so close together, that fractions of the axis could not be told.
    if (!(ends[1] - ends[0] <= 1e300) || ends[1] - ends[0] < plots::shortest_axis ||
        ends[1] - ends[0] < 1e-13 * std::max(std::fabs(ends[0]), std::fabs(ends[1]))) {
        options.fail(name, fmt::format("{} = {{ {}, {} }} cannot be drawn: its ends must differ by more than 1e-13 of "
                                       "their size, by more than 1e-305 and by less than 1e300",
                                       name, ends[0], ends[1]));
    }
    return {ends[0], ends[1]};
}

/// xticks = 0.5: a tick at each multiple of it; xticks = { 0, 1, 4 }: these.
void set_ticks(lua_State* L, const lua::Options& options, std::string_view name, plots::Axis& axis) {
    if (!options.has(name)) {
        return;
    }
    options.push(name);
    const bool is_number = lua_type(L, -1) == LUA_TNUMBER;
    lua_pop(L, 1);
    if (!is_number) {
        axis.ticks = options.numbers(name);
        return;
    }
    axis.division = options.number(name);
    if (axis.logarithmic) {
        options.fail(name,
                     fmt::format("{} must be a list of numbers such as {{ 0.1, 1, 10 }} on a logarithmic axis", name));
    }
}

/// As wide as the screen, but no wider than one can overlook, and so high that what was typed still stands above it.
plots::TextFormat asked_format(const TargetOptions& asked, bool phase) {
    const terminal::Display seen = terminal::display_of(STDOUT_FILENO);
    constexpr int widest = 120;
    plots::TextFormat format;
    format.columns = asked.width.value_or(std::clamp(seen.columns - 1, 20, widest));
    format.rows = asked.height.value_or(std::clamp(seen.rows - 2, 10, phase ? 40 : 24));
    format.charset = asked.ascii.value_or(!seen.draws) ? plots::Charset::ascii : plots::Charset::braille;
    format.colours = seen.colour;
    return format;
}

plots::PaperSize asked_size(const lua::Options& options, const TargetOptions& asked) {
    if (!asked.size) {
        return {};
    }
    const std::vector<double>& size = *asked.size;
    if (size.size() != 2 || *std::min_element(size.begin(), size.end()) < 2 ||
        *std::max_element(size.begin(), size.end()) > 100) {
        options.fail("size", "size must be width and height in cm, each from 2 to 100, such as { 8.5, 6 }");
    }
    return {size[0], size[1]};
}

enum class FileKind { svg, png, pdf, gp, txt };

FileKind kind_of(const lua::Options& options, std::string_view file) {
    constexpr std::array<std::string_view, 5> endings{".svg", ".png", ".pdf", ".gp", ".txt"};
    const auto* const known = std::find(endings.begin(), endings.end(), text::ending_of(file));
    if (known == endings.end()) {
        options.fail({.sentence = fmt::format(
                          "the name '{}' must end in .svg, .png, .pdf, .gp (gnuplot commands and data) or .txt", file),
                      .option = "file",
                      .culprit = std::string(file)});
    }
    return static_cast<FileKind>(known - endings.begin());
}

text::Expected<std::string> content(const std::vector<plots::Figure>& figures, FileKind kind, plots::PaperSize size,
                                    plots::TextFormat format) {
    if (kind == FileKind::txt) {
        format.colours = false;
        return plots::text_plot(figures, format);
    }
    if (kind == FileKind::gp) {
        return plots::gnuplot_file(figures, size);
    }
    const plots::Terminal terminal = kind == FileKind::svg   ? plots::Terminal::svg
                                     : kind == FileKind::png ? plots::Terminal::png
                                                             : plots::Terminal::pdf;
    auto picture = drawn_by_gnuplot(plots::gnuplot_input(figures, terminal, size));
    return picture && kind == FileKind::svg ? plots::with_words(std::move(picture).value(), figures) : picture;
}

void write_picture(lua_State* L, const lua::Options& options, const TargetOptions& asked,
                   const std::vector<plots::Figure>& figures, const plots::TextFormat& format) {
    const FileKind kind = kind_of(options, *asked.file);
    const plots::PaperSize size = asked_size(options, asked);
    files::OutputFile file =
        options.value_or_fail(files::OutputFile::create(*asked.file));  // before the work that may be in vain
    const auto bytes = content(figures, kind, size, format);
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    file.write(options.value_or_fail(bytes));
    options.value_or_fail(file.commit());
}

/// What they may keep alive outside of Lua.
std::size_t bytes_of(const std::vector<plots::Figure>& figures) {
    std::size_t numbers = 0;
    for (const plots::Figure& figure : figures) {
        for (const plots::Curve& curve : figure.curves) {
            numbers += curve.x.values.size() + curve.y.values.size();
        }
    }
    return numbers * sizeof(double);
}

/// A user's ticks must be few enough to be told apart.
void check_ticks(const lua::Options& options, std::string_view name, const plots::Axis& axis,
                 const plots::Scale& scale) {
    constexpr double most = 200;
    const double count =
        axis.division ? scale.range().length() / *axis.division : static_cast<double>(axis.ticks.size());
    if (count > most) {
        options.fail(
            name, fmt::format("{} makes {:.3g} ticks from {:.6g} to {:.6g}, more than {:.0f}: give a larger distance",
                              name, count, scale.range().low, scale.range().high, most));
    }
}

PictureViewer picture_viewer = nullptr;

}  // namespace

void show_pictures_by(PictureViewer viewer) {
    picture_viewer = viewer;
}

text::Expected<std::string> drawn_by_gnuplot(const std::string& commands) {
    return plots::run_gnuplot(commands,
                              {.go_on = [] { return !lua::interrupt_requested(); },
                               .memory = lua::memory_limit() == 0 ? 0 : std::max<std::size_t>(lua::memory_left(), 1)});
}

text::Expected<std::string> svg_of(const Picture& picture) {
    auto svg = content(picture.figures, FileKind::svg, {}, picture.format);
    if (!svg) return svg;
    return plots::element_of(std::move(svg).value());
}

void apply_options(lua_State* L, const lua::Options& options, plots::Figure& figure) {
    FigureOptions asked;
    options.fill(asked);
    figure.title = asked.title.value_or(figure.title);
    figure.x.label = asked.xlabel.value_or(figure.x.label);
    figure.y.label = asked.ylabel.value_or(figure.y.label);
    figure.x.logarithmic = asked.xlog.value_or(figure.x.logarithmic);
    figure.y.logarithmic = asked.ylog.value_or(figure.y.logarithmic);
    if (asked.xlim) {
        figure.x.limits = asked_range(options, "xlim", *asked.xlim, figure.x.logarithmic);
    }
    if (asked.ylim) {
        figure.y.limits = asked_range(options, "ylim", *asked.ylim, figure.y.logarithmic);
    }
    set_ticks(L, options, "xticks", figure.x);
    set_ticks(L, options, "yticks", figure.y);
    figure.equal = asked.equal.value_or(figure.equal);
    figure.axes = asked.axes.value_or(figure.axes);
    if (options.has("xticks") || options.has("yticks")) {
        const plots::View view = plots::view_of(figure);
        check_ticks(options, "xticks", figure.x, view.x);
        check_ticks(options, "yticks", figure.y, view.y);
    }
    if (figure.equal && (figure.x.logarithmic || figure.y.logarithmic)) {
        options.fail("equal", "equal = true needs linear axes: leave out xlog and ylog");
    }
}

void apply_options(lua_State* L, const lua::Options& options, std::vector<plots::Figure>& figures) {
    for (plots::Figure& figure : figures) {
        apply_options(L, options, figure);
        if (&figure != &figures.front()) figure.title.clear();
        if (&figure != &figures.back()) figure.x.label.clear();
    }
    if (figures.size() > 1) {
        for (const char* of_one : {"ylim", "yticks", "ylog", "equal"}) {
            if (options.has(of_one)) {
                options.fail(
                    of_one,
                    fmt::format(
                        "{} is for one unit, and these columns have {}: give ylabel to draw them on one axis, or "
                        "draw them one by one",
                        of_one, figures.size()));
            }
        }
    }
}

int deliver(lua_State* L, const lua::Options& options, std::vector<plots::Figure> figures) {
    const bool phase =
        std::any_of(figures.begin(), figures.end(), [](const plots::Figure& figure) { return figure.equal; });
    TargetOptions asked;
    options.fill(asked);
    if (asked.show || asked.file) lua::refuse_in_worker(L, "a plot");
    const plots::TextFormat format = asked_format(asked, phase);
    if (asked.file) {
        if (!asked.show) {
            options.fail("show", "file and show = false exclude each other");
        }
        write_picture(L, options, asked, figures, format);
        if (picture_viewer != nullptr) picture_viewer({std::move(figures), format}, Shown::in_file);
        return 0;
    }
    if (asked.size) {
        options.fail("size", "size is for files; give width and height for a picture in the terminal");
    }
    if (!asked.show) {
        const std::size_t bytes = bytes_of(figures);
        lua::push(L, Picture{std::move(figures), format});
        lua::note_external_memory(L, bytes);
        return 1;
    }
    if (picture_viewer != nullptr) {
        picture_viewer({std::move(figures), format}, Shown::here);
        return 0;
    }
    const std::string text = plots::text_plot(figures, format);
    lua_writestring(text.data(), text.size());  // as print() does
    return 0;
}

std::string text_of_picture(const Picture& picture) {
    plots::TextFormat format = picture.format;
    format.colours = false;
    std::string text = plots::text_plot(picture.figures, format);
    if (text.ends_with('\n')) {
        text.pop_back();
    }
    return text;
}

}  // namespace dinal::api
