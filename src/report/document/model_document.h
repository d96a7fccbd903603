#pragma once

#include "mechanical/measured_flight.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"
#include "mechanical/validation.h"
#include "report/latex_tables.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

/// Models and their validation (ModelDocument, PhysicalDocument and ValidationDocument of web/app/src/documents.ts).
namespace flightwatt::report {

/// A mechanical model to show.
struct ReportModel {
    mechanical::MechanicalModel model;
    std::string origin;                                  ///< "Fitted to these flights."
    flight::PerPhase<mechanical::CurveBand> bands = {};  ///< 95 % bands of the mean; unknown if without times
    std::optional<TextTable> table_one = {};
    bool is_of_missions = false;
};

/// Returns a model with its curves and Table I.
Json model_json(const ReportModel& model);

/// Returns the errors of predictions by leave-one-out, compared with the baselines; with a warning if the flights are
/// `synthetic`. `flights` is not empty.
Json validation_json(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic, LatexTables& tables);

/// Fits the power by airspeed and climb; null if it cannot be fitted.
Json physical_json(std::span<const mechanical::MeasuredFlight> flights, LatexTables& tables);

}  // namespace flightwatt::report
