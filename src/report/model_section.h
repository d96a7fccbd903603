#pragma once

#include "base/text_table.h"
#include "batch/batch_fit.h"
#include "mechanical/model_errors.h"
#include "mechanical/validation.h"
#include "report/figure.h"
#include "report/html.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A mechanical model and what is known of it.
struct ReportModel {
    mechanical::MechanicalModel model;
    std::string origin;                                  ///< "fitted to these flights", or the file it was read from
    flight::PerPhase<mechanical::CurveBand> bands = {};  ///< without times: not known
    std::optional<TextTable> table_one = {};
};

/// The batch's model with its bands and Table I, beside a published one where there is one.
ReportModel model_of(const batch::BatchFit& fit, const std::optional<mechanical::MechanicalModel>& published);

/// The model as Fig. 2 with Table I. `id` tells several apart.
Section model_section(const ReportModel& model, const PublishedFigures& published, const std::string& id);

/// How well flights that it has not seen are predicted, beside the baselines. `flights` is not empty;
/// of `synthetic` ones it says so.
Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic = false,
                           const SectionScope& of = {});

/// Power from airspeed and climb, fitted to the flights: figure, constants, and what was tried. std::nullopt where no
/// flight measured its motion, or it does not tell their power.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights,
                                        const SectionScope& of = {});

/// Its tables; none where there is no such section.
std::vector<CaptionedTable> physical_tables(std::span<const mechanical::MeasuredFlight> flights);

}  // namespace flightwatt::report
