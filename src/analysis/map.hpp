// The map whose fixed points are steady motions: from one return of a motion to the next, after a period of the drive,
// half a period of a symmetric motion, or from passage to passage of a section. docs/theory.md, section 10.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "model/event.hpp"
#include "motion/engine/run.hpp"

namespace dinal::analysis {

/// The discrete part of a state, which cannot change continuously.
struct HeldMode {
    motion::engine::Mode mode;
    std::vector<std::vector<motion::engine::Signal::Memory>> controllers;

    friend bool operator==(const HeldMode& a, const HeldMode& b);
};

/// Maps a place to the place one return later. A place is a vector of coordinates of order 1.
class Map {
public:
    struct Return {
        Eigen::VectorXd to;
        double time = 0;
        bool finished = false;
        model::Outcome outcome = model::Outcome::reached_end;
        std::optional<HeldMode> mode = {};                          ///< none if it follows from the place
        std::vector<std::pair<model::EventKind, int>> events = {};  ///< kind and joint of each event on the way
        /// with respect to the place; none: use differences
        std::optional<Eigen::MatrixXd> derivative = {};
    };
    struct Derivative {
        Eigen::MatrixXd by_place;
        double bend = 0;  ///< greatest deviation of one-sided slopes from their mean
    };

    Map() = default;
    Map(const Map&) = default;
    Map& operator=(const Map&) = delete;
    virtual ~Map() = default;

    /// Makes several returns.
    virtual Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns) = 0;
    /// The derivative of the map of several returns by differences of this order, 2 or 4, within the mode.
    virtual std::optional<Derivative> derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode,
                                                 int returns, int order) = 0;
    /// The rounding of a place; may exceed the digits of a tiny motion.
    virtual double rounding() const { return 0; }
};

/// A motion that closes after some returns.
struct Closed {
    Eigen::VectorXd x;
    std::optional<HeldMode> mode;
    int returns = 1;
    double period = 0, residual = 0;
};

/// The greatest magnitude of a component.
double size_of_step(const Eigen::VectorXd& step);

}  // namespace dinal::analysis
