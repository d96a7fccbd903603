#pragma once

#include "base/text_table.h"
#include "mechanical/table_one.h"

#include <filesystem>
#include <optional>
#include <string>

namespace flightwatt::cli {

/// Table I of a model, beside a published one where there is one.
TextTable table_of(const mechanical::MechanicalModel& model,
                   const std::optional<mechanical::MechanicalModel>& published,
                   mechanical::TableIntervals intervals = mechanical::TableIntervals::absent);

/// Text, CSV, Markdown or LaTeX, by the file's ending. Throws UsageError for another ending.
std::string table_text(const TextTable& table, const std::filesystem::path& file);

}  // namespace flightwatt::cli
