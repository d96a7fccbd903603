#pragma once

#include "batch/batch_fit.h"
#include "mechanical/measured_flight.h"
#include "report/model_section.h"
#include "report/report_flight.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace flightwatt::report {

/// What flightwatt report takes from a batch's folder.
struct BatchContent {
    std::vector<ReportFlight> flights;
    std::vector<mechanical::MeasuredFlight> measured;  ///< what the batch's fit took of them
    std::optional<batch::BatchFit> fit;                ///< absent where the batch could not fit them
};

/// The folder's flights, those with a usable power record first. Throws InputError as read_stored_flights and
/// read_batch_fit.
BatchContent read_batch_content(const std::filesystem::path& out);

/// The batch's model with its bands and Table I, beside a published one where there is one.
ReportModel model_of(const batch::BatchFit& fit, const std::optional<mechanical::MechanicalModel>& published);

}  // namespace flightwatt::report
