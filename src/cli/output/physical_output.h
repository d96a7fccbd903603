#pragma once

#include "base/text_table.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"

#include <string>

#include <nlohmann/json.hpp>

/// What a physical model says: its constants, and how they were chosen.
namespace flightwatt::cli {

/// One row a term: its coefficient with half the 95 % interval, and the unit.
TextTable constants_table(const mechanical::PhysicalModel& model);

/// One row a term that was tried: the error of what was held back, without and with it, and what became of it.
TextTable trials_table(const mechanical::PhysicalFit& fit);

/// Both tables, what the model rests on, and how far an unseen flight may be off.
std::string physical_text(const mechanical::PhysicalFit& fit);

nlohmann::ordered_json physical_json(const mechanical::PhysicalFit& fit);

/// Warns of flights that are not in the model, and of what it does not know.
void warn_of_physical(const StageCall& call, const mechanical::PhysicalFit& fit);

}  // namespace flightwatt::cli
