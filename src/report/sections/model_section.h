#pragma once

#include "base/text_table.h"
#include "mechanical/measured_flight.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"
#include "mechanical/validation.h"
#include "report/html.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A mechanical model to show in a section.
struct ReportModel {
    mechanical::MechanicalModel model;
    std::string origin;                                  ///< "Fitted to these flights."
    flight::PerPhase<mechanical::CurveBand> bands = {};  ///< 95 % bands of the mean; unknown if without times
    std::optional<TextTable> table_one = {};
};

/// Returns the section of a model: Fig. 2 with Table I.
Section model_section(const ReportModel& model, const std::string& id);

/// Returns the section of the errors of predictions by leave-one-out, compared with the baselines; with a warning if
/// the flights are `synthetic`. `flights` is not empty.
Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic = false);

/// Fits the power by airspeed and climb and returns its section: figure, constants and trials. std::nullopt if it
/// cannot be fitted.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights);

}  // namespace flightwatt::report
