#pragma once

#include "base/text_table.h"
#include "mechanical/validation.h"
#include "report/figure.h"

#include <span>
#include <string>

namespace flightwatt::report {

/// How far each model's prediction of the energy of a flight that it has not seen was off: a point a flight,
/// model by model. `flights` is not empty.
Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id);

/// The scores behind it as a table's rows: phase, model, flights, mean absolute error, bias, coverage.
TextTable validation_table(std::span<const mechanical::ValidatedFlight> flights);

}  // namespace flightwatt::report
