// Fast steps of rk4 for one body while no event happens: blocks of affine maps if the spring is linear and the other
// torques depend on time only, otherwise steps that evaluate the functions of the motion.
#pragma once

#include <vector>

#include "motion/engine/affine_block.hpp"
#include "motion/engine/breaks.hpp"
#include "motion/engine/conditions.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/recorder.hpp"
#include "motion/engine/user_events.hpp"
#include "motion/engine/walls.hpp"

namespace dinal::motion::engine {

struct Made;

/// Takes steps until an event is possible in the next one, which is left to the general loop.
class PlainSteps {
public:
    PlainSteps(const Request& problem, const Mechanics& mechanics);

    struct Parts {
        Now& now;
        const std::vector<double>& departing;  ///< state for functions that jump at slip 0
        Contacts& contacts;
        Walls& walls;
        UserEvents& users;
        Conditions& conditions;
        Recorder& recorder;
    };
    /// Returns whether plain steps are possible from here.
    bool may_begin(const Now& now) const;
    /// Takes steps that end before `until`. Returns whether it took any.
    bool take(const Parts& parts, double until);
    /// Returns the longest time between two samples of M.
    double gap() const { return steps_.h / 2; }

private:
    std::size_t move(const Parts& parts, std::size_t begin, std::size_t stop, model::Motion way);
    bool turn(const Parts& parts, std::size_t n, std::size_t i);
    std::size_t rest(const Parts& parts, std::size_t begin, std::size_t stop);
    bool clear_of_walls(std::size_t i, double reach) const;
    [[nodiscard]] bool is_calm(const Parts& parts, std::size_t first, std::size_t last);
    std::size_t calm_until(const Parts& parts, std::size_t first, std::size_t last);
    std::size_t rows(const Parts& parts, std::size_t n, std::size_t first, std::size_t last, bool stands);
    void keep(const Parts& parts, std::size_t first, std::size_t last, bool stands);
    Made made(const Parts& parts, std::size_t first, std::size_t last, bool stands);
    double M_at(std::size_t i, double t, const model::State& y);
    void put_state(std::size_t i, double t, const model::State& y);

    bool take_steps(const Parts& parts, double until);
    bool take_rest_of_step(const Parts& parts, double until);
    // Steps that evaluate functions.
    bool find_rates(const Mode& mode, const Moment& at, double* rates, double& M) const;
    bool begin_functions(const Parts& parts, std::size_t i);
    bool step_functions(const Parts& parts, std::size_t i, double direction);
    void step_states(std::size_t i);
    double time(std::size_t i) const { return steps_.time(sampled_.from + i); }
    double acceleration(std::size_t i, const model::State& y) const {
        return affine_ ? block_.acceleration(i, y) : accelerations_[i];
    }
    [[nodiscard]] double* states(std::size_t i) { return states_.data() + i * m_; }
    [[nodiscard]] double* rates(std::size_t i) { return rates_.data() + i * m_; }

    const Request& problem_;
    const Mechanics& mechanics_;
    const model::Joint& joint_;
    const model::Excitation& M_;
    std::size_t m_;  ///< number of states
    bool possible_, affine_, watches_;
    bool even_friction_;  ///< whether friction is constant in each direction and the spring linear
    StepTimes steps_;
    AffineBlock block_;
    struct {
        std::size_t from = 0, to = 0;
    } sampled_;                ///< range of steps in the block
    double friction_ = 0;      ///< torque of the present motion
    model::SpeedRange range_;  ///< speed range of the friction law that steps must not leave
    struct {
        double t = -model::never, M = 0;
    } end_;  ///< end of the last step
    // Values at the start of each step, for steps that evaluate functions.
    std::vector<double> accelerations_, states_, rates_;
    std::vector<double> constant_rates_;  ///< rates of all states if they are constant
    std::size_t tries_ = 8;               ///< number of steps to try at once if any of them may contain an event
    bool is_rest_of_step_ = false;
    std::vector<double> point_, slopes_;
    Ranges ranges_;
};

}  // namespace dinal::motion::engine
