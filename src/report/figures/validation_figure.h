#pragma once

#include "mechanical/validation.h"
#include "report/figure.h"

#include <span>
#include <string>

namespace flightwatt::report {

/// How far each model's prediction of the energy of a flight that it has not seen was off: a point a flight,
/// model by model. `flights` is not empty.
Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id);

}  // namespace flightwatt::report
