#include "synthetic/synthetic_flight.h"

#include "base/error.h"
#include "mechanical/model_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

namespace flightwatt::synthetic {
namespace {

constexpr double spool_up_s = 3.0;    // full power before the aircraft leaves the ground
constexpr double ground_run_s = 1.0;  // from standing to lift-off height
constexpr double flare_s = 2.0;       // from touchdown height to standing
constexpr double motor_off_after_s = 3.0;
constexpr double hand_over_s = 1.5;  // from one phase's power to the next one's
constexpr double full_power_w = 95.0;
constexpr double dive_fraction = 0.7;  // of the height
constexpr double dive_down_s = 8.0;
constexpr double dive_low_s = 5.0;
constexpr double dive_up_s = 20.0;
constexpr double close_dives_s = 30.0;  // from one to the next, before the first is climbed back
constexpr double estimator_climb_s = 15.0;
constexpr double stage_change_s = 15.0;
constexpr double settling_s = 4.0;     // time constant to the cruise height
constexpr double oscillation = 0.008;  // of the height in cruise
constexpr double oscillation_period_s = 47.0;

/// Propeller power grows about with the cube of its speed.
double throttle_for(double power_w) { return 100.0 * std::cbrt(std::clamp(power_w / full_power_w, 0.0, 1.0)); }

/// Depth of a dive as a fraction of the height.
double dive_depth(const SyntheticFlight& flight, double time_s) {
    for (const double start_s : flight.dives_s) {
        const double since_s = time_s - start_s;
        if (since_s < 0.0 || since_s > dive_down_s + dive_low_s + dive_up_s) continue;
        return dive_fraction *
               std::min({since_s / dive_down_s, 1.0, (dive_down_s + dive_low_s + dive_up_s - since_s) / dive_up_s});
    }
    return 0.0;
}

/// Fraction of the height before the landing.
double stage_fraction(const SyntheticFlight& flight, double time_s) {
    if (flight.low_stage_s <= 0.0) return 1.0;
    const double begin_s = flight.start_s(flight::Phase::landing) - flight.low_stage_s;
    return std::lerp(1.0, low_stage_fraction, std::clamp((time_s - begin_s) / stage_change_s + 1.0, 0.0, 1.0));
}

/// Fraction of the height at a fraction of the landing, from `from` down to `ground`.
double landing_fraction(const SyntheticFlight& flight, double part, double from, double ground) {
    const double step = flight.landing_step_s / flight.duration_s[flight::Phase::landing];
    if (step <= 0.0) return std::lerp(from, ground, part);
    const double descent = 0.5 * (1.0 - step);  // before and after the step
    if (part < descent) return std::lerp(from, landing_step_fraction, part / descent);
    return std::lerp(landing_step_fraction, ground, std::max(part - descent - step, 0.0) / descent);
}

/// Height above the ground. Phases begin and end at the heights of the segmentation's definitions; the oscillation
/// raises the cruise height.
double height_m(const SyntheticFlight& flight, double time_s) {
    const flight::SegmentationOptions definition;
    const double ground = definition.ground_fraction;
    const double reached = definition.cruise_fraction * (1.0 + oscillation);
    const double lift_off = flight.lift_off_s;
    const double climbed = flight.end_s(flight::Phase::takeoff);
    const double descent = flight.start_s(flight::Phase::landing);
    const double touchdown = flight.end_s(flight::Phase::landing);
    double fraction = 0.0;
    if (time_s < lift_off) {
        fraction = ground * std::clamp(1.0 - (lift_off - time_s) / ground_run_s, 0.0, 1.0);
    } else if (time_s < climbed) {
        fraction = std::lerp(ground, reached, (time_s - lift_off) / (climbed - lift_off));
    } else if (time_s < descent) {
        const double rise = std::exp(-(time_s - climbed) / settling_s);
        const double fall = std::exp(-(descent - time_s) / settling_s);
        const double held =
            1.0 + oscillation * std::sin(2.0 * std::numbers::pi * (time_s - climbed) / oscillation_period_s);
        fraction = stage_fraction(flight, time_s) * (held - (held - reached) * (rise + fall));
    } else if (time_s < touchdown) {
        fraction = landing_fraction(flight, (time_s - descent) / (touchdown - descent),
                                    stage_fraction(flight, descent) * reached, ground);
    } else {
        fraction = ground * std::clamp(1.0 - (time_s - touchdown) / flare_s, 0.0, 1.0);
    }
    return (fraction - dive_depth(flight, time_s)) * flight.height_m;
}

struct Motor {
    double power_w;
    double throttle_percent;
};

std::optional<Motor> unusual_motor(const SyntheticFlight& flight, double time_s) {
    constexpr Motor off{0.0, 0.0};
    for (const double start_s : flight.dives_s) {
        const double since_s = time_s - start_s;
        if (since_s >= 0.0 && since_s < dive_down_s) return off;
        if (since_s >= dive_down_s && since_s < dive_down_s + dive_low_s + dive_up_s) return Motor{full_power_w, 100.0};
    }
    const double landed_s = time_s - flight.end_s(flight::Phase::landing);
    if (flight.power_burst_after_landing && landed_s > 15.0 && landed_s < 18.0) return Motor{40.0, 0.0};
    if (flight.throttle_burst_before_touchdown && landed_s > -flight.duration_s[flight::Phase::landing] &&
        landed_s < 0.0) {
        const bool burst = landed_s > -9.0 && landed_s < -3.0;
        return burst ? Motor{20.0, throttle_for(20.0)} : off;
    }
    return std::nullopt;
}

double power_w_at(const SyntheticFlight& flight, double time_s) {
    const double touchdown = flight.end_s(flight::Phase::landing);
    if (time_s >= flight.motor_run_up_s && time_s < flight.motor_run_up_end_s()) return flight.motor_run_up_power_w;
    if (time_s < flight.lift_off_s - spool_up_s || time_s > touchdown + motor_off_after_s) return 0.0;
    const auto phase_power_w = [&](flight::Phase phase) {
        const double tau = (time_s - flight.start_s(phase)) / flight.duration_s[phase];
        return flight.power_w(phase, std::clamp(tau, 0.0, 1.0));
    };
    const double cruised_s = time_s - flight.start_s(flight::Phase::cruise);
    const double to_descent_s = flight.start_s(flight::Phase::landing) - time_s;
    if (cruised_s < 0.0) return phase_power_w(flight::Phase::takeoff);
    if (to_descent_s < 0.0) return phase_power_w(flight::Phase::landing);
    // Continuous power between the phases.
    const double from_climb = std::clamp(1.0 - cruised_s / hand_over_s, 0.0, 1.0);
    const double to_landing = std::clamp(1.0 - to_descent_s / hand_over_s, 0.0, 1.0);
    return from_climb * phase_power_w(flight::Phase::takeoff) + to_landing * phase_power_w(flight::Phase::landing) +
           (1.0 - from_climb - to_landing) * phase_power_w(flight::Phase::cruise);
}

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

double SyntheticFlight::start_s(flight::Phase phase) const {
    double start = lift_off_s;
    for (const auto earlier : flight::all_phases) {
        if (earlier == phase) break;
        start += duration_s[earlier];
    }
    return start;
}

SyntheticState state_at(const SyntheticFlight& flight, double time_s) {
    SyntheticState state;
    constexpr double half_step_s = 0.05;
    const double height = height_m(flight, time_s);
    state.altitude_m = flight.ground_altitude_m + height;
    state.climb_m_per_s =
        (height_m(flight, time_s + half_step_s) - height_m(flight, time_s - half_step_s)) / (2.0 * half_step_s);
    const double nominal_w = power_w_at(flight, time_s);
    const auto motor = unusual_motor(flight, time_s).value_or(Motor{nominal_w, throttle_for(nominal_w)});
    state.power_w = motor.power_w;
    state.throttle_percent = motor.throttle_percent;
    const double fixed = std::clamp((time_s - flight.estimator_fix_s) / estimator_climb_s, 0.0, 1.0);
    state.estimated_altitude_m = flight.estimator_fix_s > 0.0 ? fixed * state.altitude_m : state.altitude_m;
    state.airborne = time_s >= flight.lift_off_s && time_s < flight.end_s(flight::Phase::landing);
    state.airspeed_m_per_s = flight.airspeed_m_per_s;
    state.wind_east_m_per_s = flight.wind_east_m_per_s;
    state.wind_north_m_per_s = flight.wind_north_m_per_s;
    const double flown_s =
        std::clamp(time_s, flight.lift_off_s, flight.end_s(flight::Phase::landing)) - flight.lift_off_s;
    const double angle = flown_s * flight.airspeed_m_per_s / flight.circle_radius_m;
    state.east_m = flight.circle_radius_m * std::sin(angle);
    state.north_m = flight.circle_radius_m * (1.0 - std::cos(angle));
    state.course_rad = std::fmod(0.5 * std::numbers::pi - angle + 2000.0 * std::numbers::pi, 2.0 * std::numbers::pi);
    if (state.airborne) {
        state.ground_speed_m_per_s =
            std::hypot(flight.airspeed_m_per_s * std::sin(state.course_rad) + flight.wind_east_m_per_s,
                       flight.airspeed_m_per_s * std::cos(state.course_rad) + flight.wind_north_m_per_s);
    }
    constexpr double auto1_before_s = 5.0;
    constexpr double auto2_after_s = 15.0;
    constexpr double manual_landing_s = 15.0;
    const double touchdown = flight.end_s(flight::Phase::landing);
    if (time_s > flight.lift_off_s - auto1_before_s) state.mode = 1;
    if (time_s > flight.lift_off_s + auto2_after_s) state.mode = 2;
    if (time_s > touchdown - manual_landing_s) state.mode = 1;
    if (time_s > touchdown + motor_off_after_s) state.mode = 0;
    state.block = 2;
    if (time_s > flight.motor_run_up_end_s() + 5.0) state.block = 3;
    if (time_s > flight.lift_off_s + 10.0) state.block = 4;
    if (time_s > flight.end_s(flight::Phase::takeoff)) state.block = 5;
    if (time_s > flight.start_s(flight::Phase::landing)) state.block = 6;
    return state;
}

const std::vector<std::string>& anomaly_names() {
    static const std::vector<std::string> names{"estimator-starts-at-zero",
                                                "dives-in-cruise",
                                                "run-up",
                                                "power-burst-after-landing",
                                                "throttle-burst-before-touchdown",
                                                "two-sorties",
                                                "begins-in-the-air",
                                                "ends-in-the-air",
                                                "landing-in-steps",
                                                "works-low"};
    return names;
}

SyntheticScenario make_scenario(SyntheticFlight flight, std::string_view anomaly) {
    const double cruise_s = flight.duration_s[flight::Phase::cruise];
    if (anomaly == "estimator-starts-at-zero") flight.estimator_fix_s = 12.0;
    if (anomaly == "power-burst-after-landing") flight.power_burst_after_landing = true;
    if (anomaly == "throttle-burst-before-touchdown") flight.throttle_burst_before_touchdown = true;
    if (anomaly == "dives-in-cruise") {
        const double cruise_start_s = flight.start_s(flight::Phase::cruise);
        flight.dives_s = {cruise_start_s + 0.2 * cruise_s, cruise_start_s + 0.5 * cruise_s,
                          cruise_start_s + 0.5 * cruise_s + close_dives_s, cruise_start_s + 0.8 * cruise_s};
    }
    if (anomaly == "works-low") flight.low_stage_s = 120.0;
    if (anomaly == "landing-in-steps") {
        flight.landing_step_s = 40.0;
        flight.duration_s[flight::Phase::landing] += flight.landing_step_s;
    }
    if (anomaly == "run-up") {  // as long and as hard as a take-off
        flight.motor_run_up_length_s = 28.0;
        flight.motor_run_up_power_w = full_power_w;
        flight.lift_off_s += flight.motor_run_up_length_s;
    }
    SyntheticScenario scenario{{flight}, 8.0, flight.log_end_s()};
    const double middle_s = flight.start_s(flight::Phase::cruise) + 0.5 * cruise_s;
    if (anomaly == "begins-in-the-air") scenario.begin_s = middle_s;
    if (anomaly == "ends-in-the-air") scenario.end_s = middle_s;
    if (anomaly == "two-sorties") {
        const double later_s = scenario.end_s + 20.0;
        flight.motor_run_up_s += later_s;
        flight.lift_off_s += later_s;
        scenario.flights.push_back(flight);
        scenario.end_s = flight.log_end_s();
    }
    return scenario;
}

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
