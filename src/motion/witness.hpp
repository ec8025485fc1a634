// Users' functions under oath: each is asked again, now and then, what it has been asked before.
//
// An integrator asks M out of order, again and ahead of time, and takes for granted that M depends on its arguments
// only. One with a memory, or with random numbers, would make a motion that nobody asked for, without a word. So what
// a run asks goes through a Witness, which remembers some of the answers, of all ages, asks for them again after
// others, and compares. No integrator knows of it: a function that is found out gives no number any more, which ends
// the run.
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

#include "model/contradiction.hpp"
#include "model/drive.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"

namespace dinal::motion {

/// What the witnesses of a run have in common.
struct Testimony {
    std::optional<model::Contradiction> found = {};
    bool over = false;  ///< the run is: nothing is remembered or asked again
};

class Witness final : public model::UserFunction {
public:
    /// `states` is how many the function is given, `argument` what users call its first argument.
    Witness(std::shared_ptr<model::UserFunction> function, std::shared_ptr<Testimony> testimony, std::string who,
            const char* argument, std::size_t states);

    double value(double t, const model::State& state) override { return value_with(t, state, {}); }
    double value_with(double t, const model::State& state, std::span<const double> states) override;
    std::size_t fill(std::span<const double> times, std::span<double> out) override;
    // What is read is nothing but a function.
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

    /// Once more at the end of a run, after all the others.
    void conclude();

private:
    /// What it was asked, and said.
    struct Answer {
        double t = 0;
        model::State state;
        double value = 0;
    };
    static constexpr std::size_t ages = 18;       ///< answers are kept from 4, 8, 16 ... questions ago
    static constexpr std::size_t milestones = 8;  ///< and at times all over the run
    // The places of answers: two of each age; the very first one; milestones; the last one, and the one before a jump,
    // which take turns.
    static constexpr std::size_t first_place = 2 * ages, first_milestone = first_place + 1,
                                 asked_in_turn = first_milestone + milestones, places = asked_in_turn + 2;

    void keep(std::size_t place, const Answer& answer, std::span<const double> states);
    void keep_for_later(const Answer& answer, std::span<const double> states);
    void keep_milestone(const Answer& answer, std::span<const double> states);
    bool stands_by(std::size_t place);
    bool ask_again();
    bool heard(const Answer& answer, std::span<const double> states);

    std::shared_ptr<model::UserFunction> function_;
    std::shared_ptr<Testimony> testimony_;
    std::string who_;
    const char* argument_;

    std::uint64_t asked_ = 0, next_ = 0;  ///< questions, and when one of them comes again
    std::uint64_t jumps_asked_ = 0;       ///< jumps because of which two were put again
    std::size_t turn_ = 0, last_ = asked_in_turn, before_jump_ = asked_in_turn + 1;
    double latest_ = -model::never;      ///< time of a question
    std::uint64_t ahead_ = 0, way_ = 1;  ///< questions later than all before; how many lie between two milestones
    double usual_ = 0;                   ///< change from one question to the next
    std::uint64_t known_ = 0;            ///< a bit for each place
    std::array<Answer, places> answers_;
    std::vector<double> states_;  ///< of each place
};

/// A witness beside every function that is given to it.
class Witnesses {
public:
    /// `states` is how many numbers the functions are given besides t, theta and velocity.
    explicit Witnesses(std::size_t states) : states_(states) {}

    std::shared_ptr<model::UserFunction> heard(const std::shared_ptr<model::UserFunction>& function, std::string who,
                                               const char* argument = "t", std::size_t more_states = 0);
    model::Excitation heard(const model::Excitation& excitation, const std::string& who);
    /// `called` names what acts on a part of the system: "M" of its first body may be "M.motor".
    using Called = std::function<std::string(const char* what, std::size_t part)>;
    model::Drive heard(model::Drive drive, const Called& called);
    /// The run is over; `whole`: nothing had failed in it. What was found.
    [[nodiscard]] std::optional<model::Contradiction> verdict(bool whole);

private:
    std::shared_ptr<Testimony> testimony_ = std::make_shared<Testimony>();
    std::vector<std::shared_ptr<Witness>> witnesses_ = {};
    std::size_t states_;
};

/// What a run asks, with a witness beside every function of the user.
class UnderOath {
public:
    UnderOath(const model::Oscillator& system, const model::Drive& drive);

    [[nodiscard]] const model::Oscillator& system() const { return system_; }
    [[nodiscard]] const model::Drive& drive() const { return drive_; }

    [[nodiscard]] std::optional<model::Contradiction> verdict(bool whole) { return witnesses_.verdict(whole); }

private:
    Witnesses witnesses_;
    model::Oscillator system_;
    model::Drive drive_;
};

/// Something in the run is a function that a user has written.
[[nodiscard]] bool has_functions(const model::Oscillator& system, const model::Drive& drive);
[[nodiscard]] bool has_functions(const model::System& system, const model::Drive& drive);

}  // namespace dinal::motion
