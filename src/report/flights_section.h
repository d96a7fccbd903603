#pragma once

#include "mechanical/mechanical_model.h"
#include "report/report_flight.h"
#include "report/section.h"

#include <optional>
#include <span>

namespace flightwatt {

/// All flights as a table (durations, power, energy, closure of integral and counter, gaps, warnings), those
/// that are left out with their reasons, and a part a flight that is drawn when it is opened.
Section flights_section(std::span<const ReportFlight> flights, const std::optional<MechanicalModel>& model);

}  // namespace flightwatt
