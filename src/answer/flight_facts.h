#pragma once

#include "flight/load_flight.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

/// What the logs of flights show apart from the power of their phases.
namespace flightwatt::answer {

/// The cruise of one flight, as far as its log shows it.
struct FlightFacts {
    std::string flight;
    double cruise_s = 0.0;
    std::optional<double> ground_speed_m_per_s = {};  ///< mean of the cruise
    std::optional<double> farthest_m = {};            ///< from where the flight began
    std::optional<double> stated_capacity_ah = {};    ///< of the pack, by the log's parameters
    std::optional<double> mean_voltage_v = {};        ///< of the cruise
    std::vector<flight::MonitorShare> monitors = {};  ///< see FlightData
    std::optional<double> pack_percent = {};          ///< of the energy, by the pack; absent with a single circuit
    std::optional<double> wing_s = {};                ///< of the cruise, on the wing; absent for one that is no VTOL
    std::optional<double> payload_kg = {};            ///< that the log states
};

/// Returns the facts of each cruise of a log.
std::vector<FlightFacts> flight_facts(const flight::LoadedFlight& loaded);

/// Returns the cruises of the fit: without those in which a VTOL only hovers, unless all are such, or `keep` names the
/// flight (mechanical::exclude_hover).
std::vector<FlightFacts> fitted_facts(std::vector<FlightFacts> facts, const std::set<std::string>& keep = {});

/// Returns which part of the time of all cruises VTOLs were on their wing; 1 for other aircraft.
double wing_share(const std::vector<FlightFacts>& facts);

/// Returns the mean ground speed of all cruises, each by its duration; std::nullopt where none was logged [m/s].
std::optional<double> mean_ground_speed_m_per_s(const std::vector<FlightFacts>& facts);

}  // namespace flightwatt::answer
