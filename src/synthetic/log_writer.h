#pragma once

#include "telemetry/log_configuration.h"

#include <string>
#include <string_view>
#include <vector>

/// Paparazzi's own formats, for synthetic logs.
namespace flightwatt::synthetic {

/// A float as Paparazzi's OCaml server prints what came over the air: "235.", "-0.", "-3e-06", "12.421459".
std::string ocaml_float(double value);

/// One line of a .data file: "335.149 20 ENERGY 69 11.704956 ...\n". A message without fields keeps a
/// trailing blank.
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

/// A well-formed .log: configuration, the aircraft with its flight plan and current sensor, message
/// definitions.
std::string to_log_xml(const LogDocument& document);

}  // namespace flightwatt::synthetic
