#pragma once

#include "battery/battery.h"
#include "mechanical/mechanical_model.h"

#include <string>

/// Models for programs that read no TOML.
namespace flightwatt::exchange {

/// Returns a model file as JSON, with the keys and units of docs/formats.md.
std::string to_json_text(const mechanical::MechanicalModel& model);
/// Returns a battery file as JSON, with the keys and units of docs/formats.md.
std::string to_json_text(const battery::Battery& battery);

/// Returns the prefix of the names in the C header: the model's name in lower case letters, digits and '_'.
std::string c_prefix(const std::string& name);

/// Returns a model as a header for C99 and C++ that needs only <math.h> and does not allocate. Its functions (PREFIX:
/// c_prefix): PREFIX_duration_s, PREFIX_power_w and PREFIX_energy_j of a phase and its time, PREFIX_flown_power_w for
/// another duration (time scaling), and PREFIX_motion_power_w of a physical model.
std::string to_c_header(const mechanical::MechanicalModel& model);

}  // namespace flightwatt::exchange
