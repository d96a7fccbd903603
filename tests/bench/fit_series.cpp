// Makes four noisy series of 600 s at 10 Hz (1.0, 1.3, 4.2 and 10 periods of Table I's cruise, harmonics four
// times as large, noise of 1.5 W), writes them as CSV for others to fit, fits them, and prints a line each: periods,
// seconds of the fit, periods found, seconds of one linear solve at the right frequency, and what its residuals are
// [W RMS]. usage: fit_series FOLDER

#include "base/atomic_file.h"
#include "base/units.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr double duration_s = 600.0;
constexpr std::size_t samples = 6000;

mechanical::PhaseSamples make_series(double periods, std::mt19937_64& random) {
    const mechanical::FourierModel model{units::rad_from_turns(periods) / duration_s,
                                         27.22,
                                         {4 * 0.3737, 4 * 0.6513, 4 * 0.5039},
                                         {4 * 1.194, 4 * 0.2954, 4 * -0.2864}};
    std::normal_distribution<double> noise(0.0, 1.5);
    mechanical::PhaseSamples series{"series", duration_s, {}, {}};
    for (std::size_t i = 0; i < samples; ++i) {
        const double time_s = duration_s * (static_cast<double>(i) + 0.5) / static_cast<double>(samples);
        series.tau.push_back(time_s / duration_s);
        series.power_w.push_back(power_w(model, time_s) + noise(random));
    }
    return series;
}

struct Timed {
    double seconds = 1e9;
    double found = 0.0;
};

/// The least seconds of the processor of nine runs of `compute`, and what it returned.
template <typename Compute>
Timed timed(Compute compute) {
    Timed least;
    for (int round = 0; round < 9; ++round) {
        const auto start = std::clock();
        least.found = compute();
        const auto taken = static_cast<double>(std::clock() - start);
        least.seconds = std::min(least.seconds, taken / static_cast<double>(CLOCKS_PER_SEC));
    }
    return least;
}

double fitted_periods(const mechanical::PhaseSamples& series) {
    return fit_phase(flight::Phase::cruise, std::span(&series, 1)).theta_rad / units::rad_per_turn;
}

/// The residuals [W RMS] of a constant and three harmonics at `periods`, by normal equations: the least that a fit has
/// to compute.
double rms_of_linear_solve(const mechanical::PhaseSamples& series, double periods) {
    constexpr Eigen::Index harmonics = 3;
    const auto count = static_cast<Eigen::Index>(series.tau.size());
    const Eigen::ArrayXd angle =
        Eigen::Map<const Eigen::ArrayXd>(series.tau.data(), count) * units::rad_from_turns(periods);
    const Eigen::Map<const Eigen::VectorXd> power(series.power_w.data(), count);
    Eigen::MatrixXd basis(count, 1 + 2 * harmonics);
    basis.col(0).setOnes();
    for (Eigen::Index n = 1; n <= harmonics; ++n) {
        const auto multiple = static_cast<double>(n) * angle;
        basis.col(2 * n - 1) = multiple.cos();
        basis.col(2 * n) = multiple.sin();
    }
    const Eigen::VectorXd coefficients = (basis.transpose() * basis).ldlt().solve(basis.transpose() * power);
    return (power - basis * coefficients).norm() / std::sqrt(static_cast<double>(count));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: fit_series FOLDER\n");
        return 2;
    }
    std::mt19937_64 random(1);
    for (const double periods : {1.0, 1.3, 4.2, 10.0}) {
        const auto series = make_series(periods, random);
        std::string csv = "time_s,power_w\n";
        for (std::size_t i = 0; i < series.tau.size(); ++i) {
            csv += fmt::format("{},{}\n", series.tau[i] * duration_s, series.power_w[i]);
        }
        write_file_atomically(fmt::format("{}/{}.csv", argv[1], periods), csv);
        const auto fit = timed([&] { return fitted_periods(series); });
        const auto solve = timed([&] { return rms_of_linear_solve(series, periods); });
        fmt::print("{} {} {} {} {:.4f}\n", periods, fit.seconds, fit.found, solve.seconds, solve.found);
    }
    return 0;
}
