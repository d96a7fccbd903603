#pragma once

#include "base/text_table.h"
#include "cli/stage.h"
#include "mechanical/model_fit.h"
#include "mechanical/physical_fit.h"
#include "mechanical/table_one.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// Options of a fit, and its output: Table I and JSON.
namespace flightwatt::cli {

/// Table I of a model, with a published one for comparison.
TextTable model_table(const mechanical::MechanicalModel& model,
                      const std::optional<mechanical::MechanicalModel>& published,
                      mechanical::TableIntervals intervals = mechanical::TableIntervals::absent);

/// The mean power of each phase with its 95 % interval, RMS and (of --errors) R2 of its curve, flights and samples.
TextTable mean_power_table(const mechanical::MechanicalModel& model);

/// Text, CSV, Markdown or LaTeX, by the file's ending. The LaTeX label is the file's name, "tab:table1"; without a
/// caption it is Table I. Throws UsageError for another ending.
std::string table_text(const TextTable& table, const std::filesystem::path& file, std::string_view caption = "");

/// Warns as model_warnings, and notes the fit's deviations and validation.
void warn_of_model(const StageCall& call, const mechanical::MechanicalModel& model);

/// JSON of a fitted model.
struct FitOutput {
    const mechanical::MechanicalModel* model = nullptr;
    const mechanical::PhysicalFit* physical = nullptr;
    bool with_errors = false;  ///< with the intervals of the coefficients
};
Fields<FitOutput> record_fields(const FitOutput*);

}  // namespace flightwatt::cli
