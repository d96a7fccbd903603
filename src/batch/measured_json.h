#pragma once

#include "mechanical/measured_flight.h"

#include <nlohmann/json.hpp>

namespace flightwatt::batch {

/// What a fit takes from a log, as a part of its record, and back. Numbers read back exactly. Reading throws
/// what nlohmann::json throws, or std::bad_optional_access for a phase or covariate that there is none of.
nlohmann::ordered_json measured_json(const mechanical::MeasuredFlights& measured);
mechanical::MeasuredFlights measured_from_json(const nlohmann::ordered_json& json);

}  // namespace flightwatt::batch
