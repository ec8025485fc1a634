// Detects user functions that are not functions of their arguments, by repeating some evaluations.
//
// Integrators evaluate M out of order, repeatedly and ahead of time, and rely on M being a function of its arguments.
// An M with a memory or random numbers would silently produce a wrong motion. So each function is wrapped in a Witness,
// which remembers answers of various ages, repeats those evaluations later and compares. Integrators do not know of it:
// a function that contradicts itself returns NaN from then on, which ends the run.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/drive.hpp"
#include "model/event.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"

namespace dinal::motion {

/// Shared by the witnesses of a run.
struct Testimony {
    std::optional<model::Contradiction> found = {};
    bool over = false;  ///< whether the run has ended: nothing is recorded or repeated
};

class Witness final : public model::UserFunction {
public:
    /// `states` is the number of states passed to the function, `argument` the user's name of its first argument.
    Witness(std::shared_ptr<model::UserFunction> function, std::shared_ptr<Testimony> testimony, std::string who,
            const char* argument, std::size_t states);

    double value(double t, const model::State& state) override { return value_with(t, state, {}); }
    double value_with(double t, const model::State& state, std::span<const double> states) override;
    std::size_t fill(std::span<const double> times, std::span<double> out) override;
    // A formula has no memory.
    model::Formula* read() override { return function_->read(); }
    double next_break(double t) override { return function_->next_break(t); }
    bool has_pieces() override { return function_->has_pieces(); }
    void decide(model::terms::Piece& piece, double t, const model::State& state, std::span<const double> states,
                std::uint64_t again) override {
        function_->decide(piece, t, state, states, again);
    }
    double value_on(const model::terms::Piece& piece, double t, const model::State& state,
                    std::span<const double> states, std::vector<double>* margins) override {
        return function_->value_on(piece, t, state, states, margins);
    }
    bool may_go_on() override { return !testimony_->found && function_->may_go_on(); }
    void forget_failure() override { function_->forget_failure(); }

    /// Repeats the kept first evaluation and the milestones at the end of the run.
    void repeat_kept();
    /// Repeats the first kept evaluation, or if `last` the latest one. Returns false if the answer differs.
    bool repeat_end(bool last);

private:
    /// The arguments and result of an evaluation.
    struct Answer {
        double t = 0;
        model::State state;
        double value = 0;
    };
    static constexpr std::size_t ages = 18;       ///< answers from 4, 8, 16 ... evaluations ago are kept
    static constexpr std::size_t milestones = 8;  ///< answers at times spread over the run are kept as well
    // The places: two for each age; the very first answer; milestones; the last one and the one before a jump, which
    // swap.
    static constexpr std::size_t first_place = 2 * ages, first_milestone = first_place + 1,
                                 places_in_turn = first_milestone + milestones, places = places_in_turn + 2;

    void keep(std::size_t place, const Answer& answer, std::span<const double> states);
    void keep_for_later(const Answer& answer, std::span<const double> states);
    void keep_milestone(const Answer& answer, std::span<const double> states);
    bool repeats_answer(std::size_t place);
    bool repeat_one();
    bool record(const Answer& answer, std::span<const double> states);

    std::shared_ptr<model::UserFunction> function_;
    std::shared_ptr<Testimony> testimony_;
    std::string name_;
    const char* argument_;

    std::uint64_t evaluations_ = 0,
                  next_ = 0;            ///< evaluations so far, and the count at which the next repetition is due
    std::uint64_t jumps_repeated_ = 0;  ///< jumps that caused two repetitions
    std::size_t turn_ = 0, last_ = places_in_turn, before_jump_ = places_in_turn + 1;
    double latest_ = -model::never;  ///< latest time of an evaluation
    /// number of evaluations later than all before; their number between two milestones
    std::uint64_t ahead_ = 0, way_ = 1;
    double usual_ = 0;         ///< moving average of the change between evaluations
    std::uint64_t known_ = 0;  ///< bit mask of filled places
    std::array<Answer, places> answers_;
    std::vector<double> states_;  ///< states of each place
};

/// Wraps each function it is given in a witness.
class Witnesses {
public:
    /// `states` is the number of arguments besides t, theta and velocity.
    explicit Witnesses(std::size_t states) : states_(states) {}

    std::shared_ptr<model::UserFunction> with_witness(const std::shared_ptr<model::UserFunction>& function,
                                                      std::string who, const char* argument = "t",
                                                      std::size_t more_states = 0);
    model::Excitation with_witness(const model::Excitation& excitation, const std::string& who);
    /// Returns the name of a load or belt: "M" of the first body may be "M.motor".
    using Called = std::function<std::string(const char* what, std::size_t part)>;
    model::Drive with_witness(model::Drive drive, const Called& called);
    /// Ends the run and returns the contradiction, if any. `whole`: the run did not fail.
    [[nodiscard]] std::optional<model::Contradiction> verdict(bool whole);

private:
    /// A variable that one function writes may have had the same value in all evaluations of another one, such as on a
    /// run of one stretch. So the writer is evaluated early and late, and the others after it. A formula cannot write.
    void repeat_others_after(Witness& writer);

    std::shared_ptr<Testimony> testimony_ = std::make_shared<Testimony>();
    std::vector<std::shared_ptr<Witness>> witnesses_ = {};
    std::size_t states_;
};

/// A system and its drive with a witness around every user function.
class UnderOath {
public:
    UnderOath(const model::Oscillator& system, const model::Drive& drive);

    const model::Oscillator& system() const { return system_; }
    const model::Drive& drive() const { return drive_; }

    [[nodiscard]] std::optional<model::Contradiction> verdict(bool whole) { return witnesses_.verdict(whole); }

private:
    Witnesses witnesses_;
    model::Oscillator system_;
    model::Drive drive_;
};

/// Returns whether the run contains any user function.
[[nodiscard]] bool has_functions(const model::Oscillator& system, const model::Drive& drive);
[[nodiscard]] bool has_functions(const model::System& system, const model::Drive& drive);

}  // namespace dinal::motion
