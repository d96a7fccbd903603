#include "cli/output/table_one_output.h"

#include "base/error.h"

#include <fmt/format.h>

namespace flightwatt::cli {

TextTable table_of(const mechanical::MechanicalModel& model,
                   const std::optional<mechanical::MechanicalModel>& published,
                   mechanical::TableIntervals intervals) {
    return published ? table_one_beside(*published, model, intervals) : table_one(model, intervals);
}

std::string table_text(const TextTable& table, const std::filesystem::path& file) {
    const auto ending = file.extension().string();
    if (ending == ".txt") return to_text(table);
    if (ending == ".csv") return to_csv(table);
    if (ending == ".md") return to_markdown(table);
    if (ending == ".tex") return mechanical::to_latex(table);
    throw UsageError(fmt::format("{}: expected a name that ends in .txt, .csv, .md or .tex", file.string()));
}

}  // namespace flightwatt::cli
