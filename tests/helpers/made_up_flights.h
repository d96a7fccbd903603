#pragma once

#include "helpers/test_paths.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace flightwatt::test {

inline mechanical::MechanicalModel published_model() {
    return mechanical::read_mechanical_model(source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
}

/// How a flight is flown and recorded.
struct Recording {
    double duration_s = 0.0;
    double interval_s = 1.1;
    double noise_w = 0.0;
    double lost_part = 0.0;  ///< of the samples
};

/// Samples of the phase's curve, scaled to the recording's duration, with white noise.
inline mechanical::PhaseSamples record(const mechanical::PhaseModel& phase, const Recording& recording,
                                       std::mt19937& random, const std::string& flight = "flight") {
    std::normal_distribution<double> noise(0.0, 1.0);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto model = time_scaled_model(phase, recording.duration_s, mechanical::PhaseTimeScaling::scaled);
    mechanical::PhaseSamples samples{flight, recording.duration_s, {}, {}};
    for (int i = 0; (i + 0.5) * recording.interval_s <= recording.duration_s; ++i) {
        const double time_s = (i + 0.5) * recording.interval_s;
        if (uniform(random) < recording.lost_part) continue;
        samples.tau.push_back(time_s / recording.duration_s);
        samples.power_w.push_back(power_w(model, time_s) + recording.noise_w * noise(random));
    }
    return samples;
}

/// Flights of the published phase, 8 % longer or shorter, at 1.1 s with 15 % of the samples lost.
inline std::vector<mechanical::PhaseSamples> record_flights(flight::Phase phase, std::size_t count, double noise_w,
                                                            unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> scale(0.92, 1.08);
    const auto model = published_model().phases[phase];
    std::vector<mechanical::PhaseSamples> flights;
    for (std::size_t i = 0; i < count; ++i) {
        const Recording recording{model.duration_s * scale(random), 1.1, noise_w, 0.15};
        flights.push_back(record(model, recording, random, "flight" + std::to_string(i + 1)));
    }
    return flights;
}

/// A cruise of 600 s that has so many periods.
inline mechanical::PhaseModel cruise_of(double periods, std::vector<double> cos_w, std::vector<double> sin_w) {
    mechanical::PhaseModel phase;
    phase.duration_s = 600.0;
    phase.fourier = {periods * 2.0 * std::numbers::pi / 600.0, 27.22, std::move(cos_w), std::move(sin_w)};
    return phase;
}

inline double theta_rad(const mechanical::PhaseModel& phase) {
    return phase.fourier.omega_rad_per_s * phase.duration_s;
}

/// Power less its mean, as the search for the frequency wants it; unit 1 W.
inline mechanical::PhaseSamples centred(mechanical::PhaseSamples samples) {
    const double mean_w = mean(samples.power_w);
    for (double& power_w : samples.power_w) power_w -= mean_w;
    return samples;
}

}  // namespace flightwatt::test
