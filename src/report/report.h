#pragma once

#include "mechanical/mechanical_model.h"
#include "mission/packs.h"
#include "record/record.h"
#include "report/batch_content.h"
#include "report/html.h"
#include "report/outline.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A folder of flightwatt batch and missions as the sections of a page, and as LaTeX tables.
namespace flightwatt::report {

/// Receives the report's warnings and progress.
struct ReportLog {
    std::function<void(const std::string& text)> warn;
    /// Starts a progress of `unit`, shown until it is destroyed.
    std::function<Progress(const std::string& unit)> progress = [](const std::string&) { return Progress(); };
};

/// Limit of the flights for the battery, whose work grows with their square.
inline constexpr std::size_t max_battery_flights = 12;

struct ReportInput {
    std::filesystem::path out = {};  ///< the folder of flightwatt batch, or empty
    std::vector<mission::MissionVariant> missions = {};
    std::vector<mission::PackFlights> packs = {};    ///< missions over several packs; their flights are in `missions`
    std::optional<std::string> published_file = {};  ///< of a model, for Table I
    std::optional<double> capacity_ah = {};          ///< of the flights' battery
    bool with_replay = false;                        ///< of the missions on the flights
    std::vector<Outline> outlines = {};              ///< below the flown tracks
};

struct ReportContent {
    std::string title;                                       ///< aircraft, flights with their dates, missions
    std::vector<std::pair<std::string, std::string>> facts;  ///< "flights" - "3 logs, from out", ...
    std::vector<Section> sections;                           ///< the summary first
    Json summary;                                            ///< of --json, with an empty title
};

/// Throws InputError as read_batch_content, and UsageError for a capacity that flights contradict.
ReportContent make_report(const ReportInput& input, const ReportLog& log);

/// Table I and the constants of the physical model.
std::string model_latex(const mechanical::MechanicalModel& model);

/// JSON Schema of ReportContent::summary.
Json summary_schema();

}  // namespace flightwatt::report
