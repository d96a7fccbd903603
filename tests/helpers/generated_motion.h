#pragma once

#include "mechanical/physical_fit.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace flightwatt::test {

/// What the made-up flights obey.
struct MotionTruth {
    double drag = 0.01;
    double induced = 0.0;
    double climb = 12.0;
    double descent = -7.0;
    double level_sd = 0.05;  ///< of a flight's own factor
    double drift_sd_w = 3.0;
    double correlation_s = 60.0;
    double mean_airspeed_m_per_s = 13.0;
};

struct MadeUpMotion {
    mechanical::BinnedFlight motion;
    double level = 0.0;
};

/// A flight of so many bins of 30 s: the first climbs at 3 m/s, the last descends; between, the airspeed wanders about
/// a mean of its own.
inline MadeUpMotion made_up_motion(const std::string& name, std::size_t bins, const MotionTruth& truth,
                                   std::mt19937& random) {
    std::normal_distribution<double> normal;
    MadeUpMotion made{{name, {}, true, ""}, truth.level_sd * normal(random)};
    const double own_speed = truth.mean_airspeed_m_per_s + 1.2 * normal(random);
    const double kept = std::exp(-mechanical::default_bin_s / truth.correlation_s);
    double drift = truth.drift_sd_w * normal(random);
    double gust = normal(random);
    for (std::size_t i = 0; i < bins; ++i) {
        mechanical::FlightBin bin;
        const bool first = i == 0;
        const bool last = i + 1 == bins;
        bin.phase = first ? flight::Phase::takeoff : last ? flight::Phase::landing : flight::Phase::cruise;
        bin.start_s = mechanical::default_bin_s * static_cast<double>(i);
        bin.duration_s = mechanical::default_bin_s;
        bin.samples = 27;
        bin.airspeed_m_per_s = own_speed + gust;
        const double climb = first ? 3.0 : last ? -2.5 : 0.4 * normal(random);
        bin.values = mechanical::term_values({bin.airspeed_m_per_s, climb, 1.0 + 0.1 * std::abs(normal(random))});
        const double model_w = truth.drag * bin.values[mechanical::PowerTerm::drag] +
                               truth.induced * bin.values[mechanical::PowerTerm::induced] +
                               truth.climb * bin.values[mechanical::PowerTerm::climb] +
                               truth.descent * bin.values[mechanical::PowerTerm::descent];
        bin.power_w = (1.0 + made.level) * model_w + drift;
        made.motion.bins.push_back(bin);
        drift = kept * drift + std::sqrt(1.0 - kept * kept) * truth.drift_sd_w * normal(random);
        gust = 0.8 * gust + 0.6 * normal(random);
    }
    return made;
}

/// A model of drag and climb with nothing absent.
inline mechanical::PhysicalModel drag_and_climb_model() {
    mechanical::PhysicalModel model;
    model.terms = {mechanical::PowerTerm::drag, mechanical::PowerTerm::climb};
    model.coefficients[mechanical::PowerTerm::drag] = 0.01;
    model.coefficients[mechanical::PowerTerm::climb] = 12.0;
    model.covariance = {{1e-7, 2e-5}, {2e-5, 0.25}};
    model.level_sd = 0.1;
    model.degrees_of_freedom = 4.0;
    model.drift_sd_w = 3.0;
    model.correlation_s = 60.0;
    model.drift_degrees_of_freedom = 50.0;
    model.airspeed_m_per_s = {10.0, 18.0};
    model.climb_m_per_s = {-3.0, 3.0};
    return model;
}

inline std::vector<mechanical::BinnedFlight> made_up_motions(std::size_t flights, std::size_t bins,
                                                             const MotionTruth& truth, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<mechanical::BinnedFlight> motions;
    for (std::size_t i = 0; i < flights; ++i)
        motions.push_back(made_up_motion("flight" + std::to_string(i), bins, truth, random).motion);
    return motions;
}

}  // namespace flightwatt::test
