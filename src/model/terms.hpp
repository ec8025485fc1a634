// The list of terms of an excitation: each is a struct in model/terms and a row here.
#pragma once

#include <variant>

#include "model/terms/levels.hpp"
#include "model/terms/polyline.hpp"
#include "model/terms/scripted.hpp"
#include "model/terms/smooth.hpp"

namespace dinal::model {

// Times in time units, frequencies in cycles per time unit, omega in rad per time unit, levels in torque.
using terms::Chirp;
using terms::Constant;
using terms::Exponential;
using terms::Gaussian;
using terms::HalfSine;
using terms::Harmonic;
using terms::Interpolation;
using terms::Polyline;
using terms::Polynomial;
using terms::Pulse;
using terms::Ramp;
using terms::Samples;
using terms::Sawtooth;
using terms::Scripted;
using terms::Square;
using terms::Step;
using terms::Triangle;
using terms::UserFunction;

template <class... T>
struct TermList {
    using Variant = std::variant<T...>;
    static_assert(((terms::NativeTerm<T> || std::is_same_v<T, Scripted>)&&...));
};

/// In the order of the manual.
using Terms = TermList<Constant, Harmonic, Step, Pulse, HalfSine, Gaussian, Ramp, Square, Sawtooth, Triangle, Chirp,
                       Exponential, Polynomial, Polyline, Scripted>;
using Term = Terms::Variant;

}  // namespace dinal::model
