#pragma once

#include "mechanical/validation.h"
#include "report/batch_content.h"
#include "report/html.h"
#include "report/simulated_mission.h"

#include <span>
#include <vector>

namespace flightwatt::report {

/// How one folder's model predicts flights that are not in it.
struct ValidatedBatch {
    std::string folder;  ///< empty where the page shows one
    std::vector<mechanical::ValidatedFlight> flights;
    bool has_synthetic = false;
};

/// What a page answers first.
struct PageSummary {
    std::vector<SimulatedMission> missions;
    std::vector<MissionAssessment> answers;  ///< one a mission
    std::vector<ValidatedBatch> validated;   ///< of the folders whose models were
    std::vector<std::string> warnings;       ///< of the fits
    std::vector<std::string> notes;          ///< what is not on the page, and why
};

/// A card for each mission; the aircraft and its flights in a line each; whether the model predicts flights that it has
/// not seen; and warnings. `flights` are the batch's, empty without one.
Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights);

/// "20 Faulty: 3 flights, 1 h 6 min in the air, 26.1 Wh" of each aircraft, SYNTHETIC ones so called.
std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights);

/// Whether any flight that was not rejected is synthetic, and whether all are.
bool any_synthetic(std::span<const ReportFlight> flights);
bool all_synthetic(std::span<const ReportFlight> flights);

/// How far off the models are of flights that they have not seen, best first; empty where nothing was validated.
std::string prediction_line(std::span<const mechanical::ValidatedFlight> flights);

/// That line of each folder, which it names where there are several.
std::vector<std::string> prediction_lines(std::span<const ValidatedBatch> batches);

}  // namespace flightwatt::report
