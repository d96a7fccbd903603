#pragma once

#include "mechanical/validation.h"
#include "report/html.h"

#include <optional>
#include <span>

namespace flightwatt::report {

/// Power from airspeed and climb, fitted to the flights: figure, constants, and what was tried. std::nullopt where no
/// flight measured its motion, or it does not tell their power.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights);

}  // namespace flightwatt::report
