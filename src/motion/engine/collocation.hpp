// Collocation at Chebyshev points: at every node of a stretch the accelerations agree with those that the motion
// causes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "motion/engine/flow.hpp"

namespace dinal::motion::engine {

class Collocation final : public Flow {
public:
    Collocation(const Mechanics& mechanics, double tolerance, double longest) : Flow(mechanics, tolerance, longest) {}

private:
    Attempt find(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& departing) override;
    Attempt accept(Segment& segment, const Mode& mode, const Frame& frame) override;
    bool follows_rates() const override { return true; }

    void place(Segment& segment, const Frame& frame);
    void guess(Segment& segment, const Frame& frame);
    bool extrapolate(const Segment& segment, const Frame& frame);
    void remember_end(const Segment& segment, const Frame& frame);
    enum class Slopes { known, here, none };
    Attempt iterate(Segment& segment, const Mode& mode, const Frame& frame, Slopes slopes);
    Attempt find_at_once(Segment& segment, const Mode& mode, const Frame& frame);
    bool follow_native(Segment& segment, const Mode& mode, const Frame& frame);
    void begin_at_first_node(Segment& segment, const Frame& frame);
    struct Residual {
        double left = 0;    ///< greatest relative residual of the equations
        bool small = true;  ///< whether the residual of each group and state is negligible or noise
    };
    Residual find_residual(const Segment& segment, const Frame& frame);
    struct Change {
        double most = 0;       ///< the greatest change, relative to the range of motion
        bool is_noise = true;  ///< whether the change of each group and state is noise
    };
    Change take_step(double h);

    /// The end of the last stretch, with the value and three derivatives of each unknown there.
    struct {
        double t = -model::never, h = 0;
        std::vector<Frame::Shape> groups{};
        std::vector<std::array<double, 4>> unknowns{};
    } end_;
    std::vector<double> scales_;    ///< range of motion of each group and state
    std::vector<double> stalls_;    ///< relative changes of each group and state below this are noise
    std::vector<Nodes> of_groups_;  ///< changes of the groups' velocities
    std::vector<char> placed_;
    Eigen::VectorXd residual_, step_;
};

}  // namespace dinal::motion::engine
