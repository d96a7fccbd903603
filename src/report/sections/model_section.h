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

/// A mechanical model for a section.
struct ReportModel {
    mechanical::MechanicalModel model;
    std::string origin;                                  ///< "Fitted to these flights."
    flight::PerPhase<mechanical::CurveBand> bands = {};  ///< without times: unknown
    std::optional<TextTable> table_one = {};
};

/// The model as Fig. 2 with Table I.
Section model_section(const ReportModel& model, const std::string& id);

/// Errors of predictions by leave-one-out, compared with the baselines. `flights` is not empty; a warning is for
/// `synthetic` ones.
Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic = false);

/// Power from airspeed and climb: figure, constants and trials. std::nullopt where it cannot be fitted.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights);

}  // namespace flightwatt::report
