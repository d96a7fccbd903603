#pragma once

#include "mechanical/mechanical_model.h"
#include "report/figure.h"
#include "report/report_flight.h"

#include <optional>

namespace flightwatt::report {

/// Altitude, throttle and power of a flight on one time axis, its phases shaded, their edges explained, and
/// the model over the power: each phase's curve stretched to the time flown. The flight was not rejected.
Figure flight_figure(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                     const std::string& id);

}  // namespace flightwatt::report
