#include "analysis/explain.hpp"

#include "analysis/story.hpp"
#include "text/characters.hpp"

namespace dinal::analysis {

std::string explain(const motion::Trajectory& trajectory, const model::Oscillator& system,
                    const model::Excitation& excitation, motion::MethodView method, const model::Extras& extras) {
    return Story(trajectory, system, excitation, method, extras).told();
}

std::string explain_rows(const motion::Trajectory& trajectory, const model::Units& units) {
    const auto t = trajectory.find("t"), theta = trajectory.find("theta"), velocity = trajectory.find("velocity");
    std::string text = fmt::format("This run was read from a file: {}", motion::summary(trajectory)) + ".";
    if (!units.usual()) text += fmt::format(" It has {}.", units.in_words());
    if (theta && trajectory.size() > 0) {
        Eigen::Index low = 0, high = 0;
        const auto column = trajectory.rows.col(*theta);
        const double least = column.minCoeff(&low), most = column.maxCoeff(&high);
        const auto when = [&](Eigen::Index row) {
            return t ? fmt::format(" (t = {:.6g})", trajectory.rows(row, *t)) : "";
        };
        text += fmt::format(" theta goes from {:.5g}{} to {:.5g}{}.", least, when(low), most, when(high));
    }
    if (velocity && trajectory.size() > 0) {
        const auto v = trajectory.rows.col(*velocity);
        std::size_t changes = 0, still = 0;
        double before = 0;
        for (const double now : v) {
            if (before * now < 0) ++changes;
            if (now != 0) before = now;
            if (now == 0) ++still;
        }
        text += fmt::format(" The velocity changes sign {} and is exactly 0 in {}.", text::counted(changes, "time"),
                            text::counted(still, "row"));
    }
    text += " The rows do not contain events and their reasons: simulate again to see them.";
    return text::wrapped(text);
}

}  // namespace dinal::analysis
