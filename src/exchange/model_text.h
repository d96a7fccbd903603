#pragma once

#include "battery/battery.h"
#include "mechanical/mechanical_model.h"

#include <string>

/// Models for programs that read no TOML.
namespace flightwatt::exchange {

/// A model file as JSON: the keys, units and meanings of docs/formats.md, nothing more or less.
std::string to_json_text(const mechanical::MechanicalModel& model);
std::string to_json_text(const battery::Battery& battery);

/// What the names in the header begin with: the model's name in small letters, digits and '_'.
std::string c_prefix(const std::string& name);

/// The model as a header for C99 and C++ that needs <math.h> alone and allocates nothing. Functions (PREFIX of
/// c_prefix): PREFIX_duration_s, PREFIX_power_w and PREFIX_energy_j of a phase and its time, PREFIX_flown_power_w of
/// another duration (PhaseTimeScaling::scaled), and PREFIX_motion_power_w of a physical model.
std::string to_c_header(const mechanical::MechanicalModel& model);

}  // namespace flightwatt::exchange
