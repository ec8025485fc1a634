#include "model/walls.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dinal::model {

std::optional<text::Error> Walls::complaint() const {
    if (std::isinf(lower) && std::isinf(upper)) {
        return text::Error{.sentence =
                               "walls needs lower, upper or both, for example walls = { lower = -0.8, upper = "
                               "0.8, restitution = 0.7 }",
                           .option = "walls"};
    }
    if (!(lower < upper)) {
        return text::Error{
            .sentence = fmt::format("walls: lower = {:.6g} must be less than upper = {:.6g}", lower, upper),
            .option = "lower"};
    }
    if (is_elastic() ? restitution != 1 : damping != 0) {
        return text::Error{
            .sentence = is_elastic() ? "walls: restitution is of rigid walls, stiffness and damping of elastic ones"
                                     : "walls: damping needs stiffness, which makes walls elastic",
            .option = is_elastic() ? "restitution" : "damping"};
    }
    if (!from_0_to_1.holds(restitution)) {
        return text::Error{
            .sentence = fmt::format("walls: restitution = {:.6g} must {}", restitution, from_0_to_1.must),
            .option = "restitution"};
    }
    return std::nullopt;
}

std::optional<text::Error> Walls::crossed_by(double theta, double size) const {
    const double rounded = 4 * std::numeric_limits<double>::epsilon() * std::max(size, std::fabs(theta));
    if (theta >= lower - rounded && theta <= upper + rounded) return std::nullopt;
    return text::Error{.sentence = fmt::format("theta0 = {} is beyond the wall at {} = {}", theta,
                                               theta < lower ? "lower" : "upper", theta < lower ? lower : upper),
                       .option = "theta0"};
}

std::string Walls::lua_text() const {
    std::string text;
    if (std::isfinite(lower)) text += fmt::format("lower = {}, ", text::number_literal(lower));
    if (std::isfinite(upper)) text += fmt::format("upper = {}, ", text::number_literal(upper));
    if (is_elastic()) {
        text += "stiffness = " + text::number_literal(stiffness);
        return "{ " + text + (damping != 0 ? ", damping = " + text::number_literal(damping) : "") + " }";
    }
    return "{ " + text + "restitution = " + text::number_literal(restitution) + " }";
}

}  // namespace dinal::model
