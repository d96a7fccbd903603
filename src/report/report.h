#pragma once

#include "base/parallel.h"
#include "mechanical/mechanical_model.h"
#include "mission/packs.h"
#include "record/record.h"
#include "report/batch_content.h"
#include "report/latex_tables.h"
#include "report/outline.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The report of a folder of flightwatt batch and of missions: the document of a page and of figures, and LaTeX tables.
namespace flightwatt::report {

/// Receives the report's warnings and progress.
struct ReportLog {
    /// Reports a warning.
    std::function<void(const std::string& text)> warn;
    /// Starts a progress that counts `unit` and is shown until it is destroyed.
    std::function<Progress(const std::string& unit)> progress = [](const std::string&) { return Progress(); };
};

/// Maximum number of flights for the battery, whose computation grows with their square.
inline constexpr std::size_t max_battery_flights = 12;

/// The input of a report.
// NOLINTNEXTLINE(bugprone-exception-escape): the move of Json does not throw
struct ReportInput {
    std::filesystem::path out = {};  ///< the folder of flightwatt batch, or empty
    std::vector<mission::MissionVariant> missions = {};
    bool are_longest = false;                        ///< the missions are the longest flights that keep their reserve
    std::vector<mission::PackFlights> packs = {};    ///< missions over several packs; their flights are in `missions`
    std::optional<std::string> published_file = {};  ///< file of a published model, for Table I
    std::optional<double> capacity_ah = {};          ///< capacity of the flights' battery
    bool with_replay = false;                        ///< with the missions replayed on the flights
    std::vector<Outline> outlines = {};              ///< drawn below the flown tracks
    bool is_interactive = false;                     ///< the page runs the program: with the missions' files
    bool with_figures = false;                       ///< the document is also for write_figures()
    Json answer = nullptr;                           ///< of flightwatt LOG... (AnswerDocument)
    std::string command = {};                        ///< that makes the page
};

/// The content of a report.
struct ReportContent {
    Json document;  ///< ReportDocument of web/app/src/documents.ts
    LatexTables latex;
    Json summary;  ///< JSON of --json, with the title
};

/// Makes a report, computed now or at SOURCE_DATE_EPOCH (reproducible-builds.org). Throws InputError as
/// read_batch_content(), and UsageError for a capacity that flights contradict and a SOURCE_DATE_EPOCH that is not in
/// seconds.
ReportContent make_report(const ReportInput& input, const ReportLog& log);

/// Returns Table I and the constants of the physical model as LaTeX.
std::string model_latex(const mechanical::MechanicalModel& model);

/// Returns the JSON Schema of ReportContent::summary.
Json summary_schema();

}  // namespace flightwatt::report
