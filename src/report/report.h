#pragma once

#include "mechanical/mechanical_model.h"
#include "mission/mission.h"
#include "record/record.h"
#include "report/batch_content.h"
#include "report/html.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Folders of flightwatt batch and missions as the sections of a page, and as LaTeX tables.
namespace flightwatt::report {

/// Where the report writes its warnings, its notes and the progress of its long steps.
struct ReportLog {
    std::function<void(const std::string& text)> warn;
    std::function<void(const std::string& text)> note = {};
    /// A progress of `unit`, which is shown until it is destroyed.
    std::function<Progress(const std::string& unit)> progress = {};
};

/// Flights that are validated, and that a battery is identified from: the work grows with the square of either.
inline constexpr std::size_t usual_validation_flights = 30;
inline constexpr std::size_t usual_battery_flights = 12;

struct ReportInput {
    std::vector<std::filesystem::path> outs;  ///< folders of flightwatt batch
    std::vector<mission::MissionVariant> missions;
    std::optional<std::string> published_file = {};  ///< of a model, for Table I
    PublishedFigures figures = {};
    std::optional<double> capacity_ah = {};  ///< of the flights' battery
    std::size_t max_validation_flights = usual_validation_flights;
    std::size_t max_battery_flights = usual_battery_flights;
    bool with_replay = false;  ///< of the missions on the flights
};

struct ReportContent {
    std::vector<std::pair<std::string, std::string>> facts;  ///< "flights" - "3 logs, from out", ...
    std::vector<Section> sections;                           ///< the summary first
    Json summary;                                            ///< of --json, with an empty title
};

/// Throws InputError and UsageError as read_batch_contents, and UsageError for a capacity that flights contradict.
ReportContent make_report(const ReportInput& input, const ReportLog& log);

/// Table I and the constants of the physical model.
std::string model_latex(const mechanical::MechanicalModel& model);

/// Flights, their model with its validation, and their battery.
std::string batch_latex(const BatchContent& content, std::span<const mission::MissionVariant> missions,
                        const std::optional<double>& capacity_ah, const ReportLog& log);

/// The missions by final state of charge, and those that were planned.
std::string missions_latex(const std::vector<mission::MissionVariant>& missions);

/// The missions on the power that the flights measured.
std::string replay_latex(const BatchContent& content, const std::vector<mission::MissionVariant>& missions,
                         const ReportLog& log);

/// JSON Schema of ReportContent::summary.
Json summary_schema();

}  // namespace flightwatt::report
