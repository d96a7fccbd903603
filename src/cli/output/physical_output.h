#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"
#include "mechanical/validation.h"

#include <span>
#include <string>

namespace flightwatt::mechanical {
Fields<PhysicalFit> record_fields(const PhysicalFit*);
}

/// Output of physical models: coefficients and their selection.
namespace flightwatt::cli {

/// One row a term: its coefficient with the 95 % interval, and the unit.
TextTable constants_table(const mechanical::PhysicalModel& model);

/// One row a term that was tried: hold-out error without and with it, and the result.
TextTable trials_table(const mechanical::PhysicalFit& fit);

/// Both tables and the data of the model.
std::string physical_text(const mechanical::PhysicalFit& fit, const Screen& screen);

/// mechanical::add_best_power, with its progress.
void add_best_power(std::span<const mechanical::MeasuredFlight> measured, const mechanical::ModelFitOptions& options,
                    mechanical::MechanicalModel& model);

/// Fits the physical model, adds it to `model`, and warns of skipped flights and of a model of a single flight. Throws as fit_physical_model.
mechanical::PhysicalFit fit_motion(const StageCall& call, std::span<const mechanical::MeasuredFlight> measured,
                                   mechanical::MechanicalModel& model);

}  // namespace flightwatt::cli
