#pragma once

#include "mechanical/mechanical_model.h"
#include "report/batch_content.h"
#include "report/html.h"

#include <optional>
#include <span>

namespace flightwatt::report {

/// All flights as a table (durations, power, energy, closure of integral and counter, gaps, warnings), those
/// that are excluded with their reasons, and a part a flight that is drawn when it is opened.
Section flights_section(std::span<const ReportFlight> flights, const std::optional<mechanical::MechanicalModel>& model);

}  // namespace flightwatt::report
