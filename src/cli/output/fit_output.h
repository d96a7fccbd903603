#pragma once

#include "base/text_table.h"
#include "cli/stage.h"
#include "mechanical/model_errors.h"
#include "mechanical/model_fit.h"
#include "mechanical/table_one.h"

#include <filesystem>
#include <optional>
#include <string>

/// Options of a fit, and its output: Table I, and as JSON the model with its errors, its outliers and its order.
namespace flightwatt::cli {

/// Table I of a model, beside a published one where there is one.
TextTable table_of(const mechanical::MechanicalModel& model,
                   const std::optional<mechanical::MechanicalModel>& published,
                   mechanical::TableIntervals intervals = mechanical::TableIntervals::absent);

/// The mean power of each phase with its 95 % interval, the flights and the samples that it rests on.
TextTable mean_power_table(const mechanical::MechanicalModel& model);

/// Text, CSV, Markdown or LaTeX, by the file's ending. Throws UsageError for another ending.
std::string table_text(const TextTable& table, const std::filesystem::path& file);

/// How a model predicts flights that were left out.
Json to_json(const mechanical::HeldOutScore& score);

/// The fitted model as the stages' JSON.
Json to_json(const mechanical::MechanicalModel& model);

/// Warns of a frequency at the edge of what it could be, and of what model_warnings says.
void warn_of_model(const StageCall& call, const mechanical::MechanicalModel& model);

/// Adds the errors and the spread of each phase, where the model has them.
void add_errors_json(Json& json, const mechanical::MechanicalModel& model);

}  // namespace flightwatt::cli
