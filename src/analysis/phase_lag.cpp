#include "analysis/phase_lag.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace dinal::analysis {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int samples = 4096;         // samples of a period, for its Fourier integral
constexpr int least_rows = 100;       // rows in a period, if only rows are available
constexpr double least_share = 1e-6;  // a relatively smaller fundamental counts as rounding

/// M between rows, by linear interpolation.
double M_between_rows(const motion::Run& run, double t) {
    const auto times = run.column(motion::Column::t), M = run.column(motion::Column::M);
    const double* begin = times.data();
    const Eigen::Index n = times.size();
    const Eigen::Index i = std::clamp<Eigen::Index>(std::upper_bound(begin, begin + n, t) - begin, 1, n - 1);
    const double s = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return M[i - 1] + s * (M[i] - M[i - 1]);
}

bool rows_cover(const motion::Run& run, double from, double until) {
    const auto t = run.column(motion::Column::t);
    const Eigen::Index n = t.size();
    if (n < 2 || t[0] > from || t[n - 1] < until) return false;
    const double* begin = t.data();
    return std::upper_bound(begin, begin + n, until) - std::lower_bound(begin, begin + n, from) >= least_rows;
}

}  // namespace

std::optional<double> phase_lag(const motion::Run& run, const model::Excitation& excitation, double period,
                                double until) {
    if (excitation.has_feedback()) return {};
    const double from = std::max(until - period, run.t_start);
    const bool kept = run.course && run.course->whole_until() == model::never;
    if ((!kept || excitation.has_script()) && !rows_cover(run, from, until)) return {};
    std::complex<double> theta_sum, M_sum;
    double theta_size = 0, M_size = 0;
    for (int i = 0; i < samples; ++i) {
        const double phase = (i + 0.5) / samples;
        const double t = std::min(from + phase * period, until);
        const double theta = (kept ? run.course->at(t) : motion::between_rows(run, t))->theta;
        const double M = excitation.has_script() ? M_between_rows(run, t) : excitation.value(t);
        const auto wave = std::polar(1.0, -2 * pi * phase);
        theta_sum += theta * wave, M_sum += M * wave;
        theta_size += std::fabs(theta), M_size += std::fabs(M);
    }
    if (!(std::abs(theta_sum) > least_share * theta_size) || !(std::abs(M_sum) > least_share * M_size)) return {};
    const double lag = std::arg(M_sum) - std::arg(theta_sum), turn = 2 * pi;
    return lag - turn * std::floor((lag + pi / 2) / turn);
}

}  // namespace dinal::analysis
