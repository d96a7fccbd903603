#include "synthetic/flight_spread.h"

#include "base/error.h"
#include "mechanical/model_fit.h"

#include <random>
#include <utility>

namespace flightwatt::synthetic {
namespace {

/// Deviation of a flight in a phase.
struct Deviation {
    double level = 0.0;  ///< of the band
    double tilt = 0.0;   ///< of the band, opposite at the two ends of the phase
    double duration = 0.0;
};

/// Fits a Fourier series of the phase's frequency to level and tilt.
mechanical::FourierModel deviation_series(flight::Phase phase, const mechanical::PhaseModel& model,
                                          const Deviation& deviation) {
    constexpr std::size_t points = 200;
    std::vector<double> tau(points);
    std::vector<double> power_w(points);
    for (std::size_t i = 0; i < points; ++i) {
        tau[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
        power_w[i] = band_w(phase, tau[i]) * (deviation.level + deviation.tilt * (2.0 * tau[i] - 1.0));
    }
    auto series = mechanical::fit_series(model, tau, power_w);
    if (!series) throw NoResultError("the frequency of the model is too low to draw flights");
    return *std::move(series);
}

mechanical::PhaseModel deviated(flight::Phase phase, const mechanical::PhaseModel& model, const Deviation& deviation,
                                double sign) {
    mechanical::PhaseModel flown = model;
    const auto difference = deviation_series(phase, model, deviation);
    flown.fourier.a0_w += sign * difference.a0_w;
    for (std::size_t n = 0; n < difference.cos_w.size(); ++n) {
        flown.fourier.cos_w[n] += sign * difference.cos_w[n];
        flown.fourier.sin_w[n] += sign * difference.sin_w[n];
    }
    flown.duration_s *= 1.0 + sign * deviation.duration;
    flown.fourier.omega_rad_per_s *= model.duration_s / flown.duration_s;  // the curve is scaled in time
    return flown;
}

}  // namespace

double band_w(flight::Phase phase, double tau) {
    switch (phase) {
        case flight::Phase::takeoff:
            return 0.2 + 1.3 * (1.0 - tau) * (1.0 - tau);
        case flight::Phase::cruise:
            return 0.6;
        case flight::Phase::landing:
            return 0.7 + 1.8 * (2.0 * tau - 1.0) * (2.0 * tau - 1.0);
    }
    return 0.0;
}

std::vector<flight::PerPhase<mechanical::PhaseModel>> draw_flights(const mechanical::MechanicalModel& model,
                                                                   std::size_t count, std::uint64_t seed,
                                                                   const SpreadOptions& options) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> uniform(-options.duration_spread, options.duration_spread);
    std::vector<flight::PerPhase<mechanical::PhaseModel>> flights;
    while (flights.size() + 1 < count) {
        flight::PerPhase<mechanical::PhaseModel> one;
        flight::PerPhase<mechanical::PhaseModel> opposite;
        for (const auto phase : flight::all_phases) {
            const Deviation deviation{options.band_scale * normal(random), options.band_scale * 0.5 * normal(random),
                                      uniform(random)};
            one[phase] = deviated(phase, model.phases[phase], deviation, 1.0);
            opposite[phase] = deviated(phase, model.phases[phase], deviation, -1.0);
        }
        flights.push_back(std::move(one));
        flights.push_back(std::move(opposite));
    }
    if (flights.size() < count) flights.push_back(model.phases);
    return flights;
}

}  // namespace flightwatt::synthetic
