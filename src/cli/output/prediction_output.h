#pragma once

#include "battery/landing_forecast.h"
#include "cli/stage.h"
#include "mechanical/prediction.h"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// What predict says of a flight in the air.
namespace flightwatt::cli {

/// The battery's part of it.
struct BatteryPrediction {
    battery::LandingForecast expected;
    battery::LandingForecast worst;    ///< of energy's high end, and where its interval is known capacity's low one
    battery::LandingLimits limits;     ///< of the mission
    bool with_least_capacity = false;  ///< `worst`
    double initial_soc_percent = 0.0;
    bool initial_is_measured = false;  ///< by the resting voltage
};

struct Prediction {
    mechanical::FlightProgress flown;
    double remaining_s = 0.0;
    bool by_motion = false;  ///< the cruise, by airspeed and climb; else by the curve or a law
    mechanical::RestPrediction cruise;
    std::vector<battery::PowerStretch> power_ahead = {};  ///< the cruise's course along a path; empty: even
    mechanical::EnergyEstimate landing;
    double landing_s = 0.0;
    mechanical::EnergyEstimate rest;
    mechanical::EnergyInterval interval;
    std::optional<BatteryPrediction> battery = {};
};

/// Flies the battery through the rest of `prediction`, from its initial charge and what was drawn of it. Throws as
/// battery::state_after.
void land(const battery::Battery& battery, const battery::DischargeRecord& flown, const Prediction& prediction,
          BatteryPrediction& result);

/// A line each for what was flown, what lies ahead and the sum; two for the battery.
std::string text_of(const Prediction& prediction);

/// The same; null for what is not known, and for a battery that does not fail.
nlohmann::ordered_json json_of(const Prediction& prediction);

/// Warns of a flight's own level that no flight of the model's aircraft should have.
void warn_of_level(const StageCall& call, const mechanical::PhysicalModel& model, double level);

/// Warns of a motion that the model's flights did not fly.
void warn_of_motion(const StageCall& call, const mechanical::PhysicalModel& model, const mechanical::AirMotion& motion);

}  // namespace flightwatt::cli
