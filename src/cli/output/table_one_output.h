#pragma once

#include "base/atomic_file.h"
#include "base/error.h"
#include "mechanical/table_one.h"
#include "mechanical/table_one_latex.h"

#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace flightwatt::cli {

/// Table I of a model, beside a published one where there is one.
inline TextTable table_of(const mechanical::MechanicalModel& model,
                          const std::optional<mechanical::MechanicalModel>& published,
                          mechanical::TableIntervals intervals = mechanical::TableIntervals::absent) {
    return published ? table_one_beside(*published, model, intervals) : table_one(model, intervals);
}

/// Text, CSV, Markdown or LaTeX, by the file's ending. Throws UsageError for another ending.
inline std::string table_text(const TextTable& table, const std::filesystem::path& file) {
    const auto ending = file.extension().string();
    if (ending == ".txt") return to_text(table);
    if (ending == ".csv") return to_csv(table);
    if (ending == ".md") return to_markdown(table);
    if (ending == ".tex") return mechanical::to_latex(table);
    throw UsageError(fmt::format("{}: expected a name that ends in .txt, .csv, .md or .tex", file.string()));
}

}  // namespace flightwatt::cli
