// Steps of rk4 on which nothing happens, of one body on its spring under a torque of the time: blocks of affine maps.
#pragma once

#include "motion/engine/affine_block.hpp"
#include "motion/engine/breaks.hpp"
#include "motion/engine/conditions.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/recorder.hpp"
#include "motion/engine/walls.hpp"

namespace dinal::motion::engine {

/// Goes on from step to step until something may happen in the next one: that is left to the loop, with all decisions.
class PlainSteps {
public:
    PlainSteps(const Request& problem, const Mechanics& mechanics, const Conditions& conditions);

    struct Of {
        Now& now;
        Contacts& contacts;
        Walls& walls;
        Recorder& recorder;
    };
    /// Takes steps that end before the time `until`. Returns whether it took any.
    bool take(const Of& of, double until);
    /// Returns the longest time between two looks at M.
    [[nodiscard]] double gap() const { return steps_.h / 2; }

private:
    [[nodiscard]] bool may_begin(const Now& now) const;
    std::size_t move(const Of& of, std::size_t begin, model::Motion way);
    bool turn(const Of& of, std::size_t n, std::size_t i);
    std::size_t rest(const Of& of, std::size_t begin);
    [[nodiscard]] bool clear_of_walls(std::size_t i, double reach) const;
    std::size_t rows(const Of& of, std::size_t n, std::size_t first, std::size_t last, bool stands);
    void keep(const Of& of, std::size_t first, std::size_t last, bool stands) const;

    const Request& problem_;
    const Mechanics& mechanics_;
    const model::Joint& joint_;
    const model::Excitation& M_;
    bool possible_;
    StepTimes steps_;
    AffineBlock block_;
    struct {
        std::size_t from = 0, to = 0;
    } sampled_;            ///< the steps of the block
    double friction_ = 0;  ///< torque of the present motion
    struct {
        double t = -model::never, M = 0;
    } end_;  ///< of the last step
};

}  // namespace dinal::motion::engine
