#pragma once

#include "synthetic/synthetic_flight.h"
#include "telemetry/message_definition.h"

#include <functional>
#include <string>
#include <vector>

namespace flightwatt::synthetic {

/// Everything that a message can tell at one moment.
struct Moment {
    double time_s = 0.0;
    SyntheticState state;
    double voltage_v = 0.0;
    double current_a = 0.0;
    double charge_ah = 0.0;
    double energy_wh = 0.0;
    double altitude_m = 0.0;  ///< as the estimator sees it
    double flight_time_s = 0.0;
};

/// A periodic telemetry message: its definition and how its fields are written.
struct Report {
    double period_s;
    telemetry::MessageDefinition definition;
    std::function<std::vector<std::string>(const Moment&)> fields;
};

/// The telemetry of a synthetic fixed-wing aircraft: the messages that flights are read from, and those that
/// fill a real log beside them, about as often.
std::vector<Report> telemetry_reports();

}  // namespace flightwatt::synthetic
