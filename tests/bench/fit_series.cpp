// Makes four noisy series of 600 s at 10 Hz (1.0, 1.3, 4.2 and 10 periods of Table I's cruise, harmonics four
// times as large, noise of 1.5 W), writes them as CSV for others to fit, fits them, and prints what it took.
// usage: fit_series FOLDER

#include "base/atomic_file.h"
#include "base/units.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <vector>

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

/// The least seconds of nine fits, and the periods that they found.
std::pair<double, double> timed_fit(const mechanical::PhaseSamples& series) {
    double best_s = 1e9;
    double periods = 0.0;
    for (int round = 0; round < 9; ++round) {
        const auto start = std::chrono::steady_clock::now();
        const auto fit = fit_phase(flight::Phase::cruise, std::span(&series, 1));
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        best_s = std::min(best_s, taken.count());
        periods = fit.theta_rad / units::rad_per_turn;
    }
    return {best_s, periods};
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
        const auto [seconds, found] = timed_fit(series);
        fmt::print("{} {} {}\n", periods, seconds, found);
    }
    return 0;
}
