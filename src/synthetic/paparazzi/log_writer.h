#pragma once

#include "synthetic/synthetic_flight.h"
#include "telemetry/log_configuration.h"
#include "telemetry/message_definition.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Paparazzi's own formats, and what a synthetic aircraft sends in them.
namespace flightwatt::synthetic {

/// A float as Paparazzi's OCaml server prints what came over the air: "235.", "-0.", "-3e-06", "12.421459".
std::string ocaml_float(double value);

/// One line of a .data file: "335.149 20 ENERGY 69 11.704956 ...\n". A message without fields keeps a trailing blank.
std::string data_line(double time_s, std::string_view sender, std::string_view message,
                      const std::vector<std::string>& fields);

/// What a synthetic .log says.
struct LogDocument {
    std::string comment;
    double time_of_day_s = 0.0;
    std::string data_file;  ///< name without folder
    telemetry::AircraftConfiguration aircraft;
    std::vector<telemetry::MessageDefinition> telemetry;
};

/// A well-formed .log: configuration, the aircraft with its flight plan and current sensor, message definitions.
std::string to_log_xml(const LogDocument& document);

/// Everything that a message can tell at one moment.
struct SensorReadings {
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
struct PeriodicMessage {
    double period_s;
    telemetry::MessageDefinition definition;
    std::function<std::vector<std::string>(const SensorReadings&)> fields;
};

/// The telemetry of a synthetic fixed-wing aircraft: the messages that flights are read from, and those that
/// fill a real log beside them, about as often.
std::vector<PeriodicMessage> periodic_messages();

}  // namespace flightwatt::synthetic
