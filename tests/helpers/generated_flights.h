#pragma once

#include "base/units.h"
#include "helpers/made_up_flights.h"
#include "mechanical/validation.h"
#include "synthetic/synthetic_flight.h"

#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace flightwatt::test {

/// A flight recorded off its true curves; with `until_s`, seen in flight so long after its cruise began.
inline mechanical::MeasuredFlight measured(const std::string& name,
                                           const flight::PerPhase<mechanical::PhaseModel>& truth, std::mt19937& random,
                                           std::optional<double> until_s = std::nullopt) {
    mechanical::MeasuredFlight flight;
    flight.samples.flight = name;
    for (const auto phase : flight::all_phases) {
        const auto& curve = truth[phase];
        flight.samples.phases[phase] = record(curve, {curve.duration_s, 1.1, 0.2, 0.1}, random, name);
        flight.energy_wh[phase] = units::wh_from_joule(energy_j(curve.fourier, curve.duration_s));
    }
    if (until_s) {
        flight.flown = mechanical::FlightProgress{};
        flight.flown->until_s = *until_s;
        const auto& takeoff = truth[flight::Phase::takeoff];
        const double cruise_wh = units::wh_from_joule(energy_j(truth[flight::Phase::cruise].fourier, *until_s));
        flight.flown->cruise_energy_wh = cruise_wh;
        flight.flown->phases[flight::Phase::takeoff] = {
            takeoff.duration_s, units::wh_from_joule(energy_j(takeoff.fourier, takeoff.duration_s))};
        flight.flown->phases[flight::Phase::cruise] = {*until_s, cruise_wh};
    }
    return flight;
}

/// Flights about the published model. The library draws them in opposite pairs; one of each pair is taken, so
/// that they are independent.
inline std::vector<mechanical::MeasuredFlight> generated(std::size_t count, unsigned seed,
                                                         std::optional<double> until_s = std::nullopt) {
    const auto drawn = synthetic::draw_flights(published_model(), 2 * count, seed);
    std::mt19937 random(seed);
    std::vector<mechanical::MeasuredFlight> flights;
    for (std::size_t i = 0; i < drawn.size() && flights.size() < count; i += 2) {
        flights.push_back(measured("flight" + std::to_string(i), drawn[i], random, until_s));
    }
    return flights;
}

}  // namespace flightwatt::test
