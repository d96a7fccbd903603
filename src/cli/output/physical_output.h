#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"
#include "mechanical/validation.h"

#include <span>
#include <string>

/// What a physical model says: its constants, and how they were chosen.
namespace flightwatt::cli {

/// One row a term: its coefficient with half the 95 % interval, and the unit.
TextTable constants_table(const mechanical::PhysicalModel& model);

/// One row a term that was tried: the error of what was held back, without and with it, and what became of it.
TextTable trials_table(const mechanical::PhysicalFit& fit);

/// Both tables, what the model rests on, and how far an unseen flight may be off.
std::string physical_text(const mechanical::PhysicalFit& fit, const Screen& screen);

Json physical_json(const mechanical::PhysicalFit& fit);

/// Warns of flights that are not in the model, and of what it does not know.
void warn_of_physical(const StageCall& call, const mechanical::PhysicalFit& fit);

/// mechanical::add_best_power, with its progress.
void add_best_power(std::span<const mechanical::MeasuredFlight> measured, const mechanical::ModelFitOptions& options,
                    mechanical::MechanicalModel& model);

/// The physical model of the flights, put into the model too; warns of what it does not know. Throws what
/// fit_physical_model throws.
mechanical::PhysicalFit fit_motion(const StageCall& call, std::span<const mechanical::MeasuredFlight> measured,
                                   mechanical::MechanicalModel& model);

}  // namespace flightwatt::cli
