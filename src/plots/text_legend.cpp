#include "plots/text_legend.hpp"

#include "plots/shades.hpp"
#include "plots/text_drawing.hpp"
#include "text/characters.hpp"

namespace dinal::plots {

std::string shown_in(Charset charset, std::string_view words) {
    const std::string clean = text::displayable(words);
    return charset == Charset::braille ? clean : text::in_ascii(clean);
}

std::vector<TextEntry> text_legend(const Figure& figure, Charset charset) {
    std::vector<TextEntry> list;
    if (figure.shades != nullptr) {
        if (!figure.shades->label.empty()) list.push_back({shown_in(charset, figure.shades->label + ":"), 0});
        const std::vector<ShadeBand> bands = bands_of(*figure.shades, most_text_bands);
        for (std::size_t i = 0; i < bands.size(); ++i) {
            const std::string_view sign = shade_letter(bands, i, charset == Charset::ascii);
            list.push_back({sign == bands[i].text ? bands[i].text : std::string(sign) + " " + bands[i].text, 0});
        }
    }
    for (std::size_t i = 0; i < figure.curves.size(); ++i) {
        if (!figure.curves[i].label.empty()) {
            const std::string mark = uses_letters(figure) ? std::string{letter(ink_of(i)), ' '} : "";
            list.push_back({mark + shown_in(charset, figure.curves[i].label), ink_of(i)});
        }
    }
    const Signs sign = signs(charset);
    for (const MarkKind kind : kinds_of(figure.marks)) {
        const auto place = static_cast<std::size_t>(kind);
        list.push_back({std::string(sign.marks[place]) + " " + mark_names[place], 0});
    }
    if (figure.dead_zone) {
        list.push_back({std::string(sign.dead_zone) + " dead zone", 0});
    }
    return list;
}

}  // namespace dinal::plots
