#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"
#include "mechanical/validation.h"

#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {
Fields<BestSpeed> record_fields(const BestSpeed*);
Fields<PhysicalFit> record_fields(const PhysicalFit*);
}  // namespace flightwatt::mechanical

/// Output of physical models: coefficients and their selection.
namespace flightwatt::cli {

/// One row a term: its coefficient with the 95 % interval, and the unit.
TextTable constants_table(const mechanical::PhysicalModel& model);

/// One row a term that was tried: hold-out error without and with it, and the result.
TextTable trials_table(const mechanical::PhysicalFit& fit);

/// A line a purpose: the best speed with its interval; then the flights that would determine more.
std::vector<std::string> speed_lines(const mechanical::SpeedToFly& speeds);

/// Both tables, the data of the model and the speed to fly.
std::string physical_text(const mechanical::PhysicalFit& fit, const Screen& screen);

/// mechanical::add_best_power, with its progress.
void add_best_power(std::span<const mechanical::MeasuredFlight> measured, const mechanical::ModelFitOptions& options,
                    mechanical::MechanicalModel& model);

/// Fits the physical model, adds it to `model`, and warns of skipped flights and of a model of a single flight. Its
/// speeds are also those in a headwind. Throws as fit_physical_model.
mechanical::PhysicalFit fit_motion(const StageCall& call, std::span<const mechanical::MeasuredFlight> measured,
                                   mechanical::MechanicalModel& model, double headwind_m_per_s = 0.0);

}  // namespace flightwatt::cli
