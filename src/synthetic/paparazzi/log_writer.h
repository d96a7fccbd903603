#pragma once

#include "synthetic/synthetic_flight.h"
#include "telemetry/log_configuration.h"
#include "telemetry/message_definition.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Paparazzi's formats, and the messages of a synthetic aircraft.
namespace flightwatt::synthetic {

/// A float as printed by Paparazzi's OCaml server: "235.", "-0.", "-3e-06", "12.421459".
std::string ocaml_float(double value);

/// One line of a .data file: "335.149 20 ENERGY 69 11.704956 ...\n". A message without fields has a trailing blank.
std::string data_line(double time_s, std::string_view sender, std::string_view message,
                      const std::vector<std::string>& fields);

/// A well-formed .log: configuration, the aircraft with its flight plan and current sensor, message definitions.
/// `data_file`: name without folder.
std::string to_log_xml(const std::string& comment, const std::string& data_file,
                       const telemetry::AircraftConfiguration& aircraft,
                       const std::vector<telemetry::MessageDefinition>& messages);

/// Values for messages at one moment.
struct SensorReadings {
    double time_s = 0.0;
    SyntheticState state;
    double voltage_v = 0.0;
    double current_a = 0.0;
    double charge_ah = 0.0;
    double energy_wh = 0.0;
    double altitude_m = 0.0;  ///< of the estimator
    double flight_time_s = 0.0;
};

/// A periodic telemetry message, and a function for its fields.
struct PeriodicMessage {
    double period_s;
    telemetry::MessageDefinition definition;
    std::function<std::vector<std::string>(const SensorReadings&)> fields;
};

/// The telemetry of a synthetic fixed-wing aircraft: messages required for flights and other typical ones.
std::vector<PeriodicMessage> periodic_messages();

}  // namespace flightwatt::synthetic
