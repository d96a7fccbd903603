#include "report/figures/published_figures.h"

#include "base/csv.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

PublishedCurve read_curve(const std::filesystem::path& path, std::string_view value) {
    const auto table = read_csv(path);
    const auto time_at = column_index(table, "time_s");
    const auto value_at = column_index(table, value);
    PublishedCurve curve;
    for (const auto& row : table.rows) {
        curve.time_s.push_back(cell_number(table, row, time_at));
        curve.value.push_back(cell_number(table, row, value_at));
    }
    return curve;
}

std::vector<PublishedCell> read_cells(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto number = [&](const CsvTable::Row& row, std::string_view name) {
        return cell_number(table, row, column_index(table, name));
    };
    std::vector<PublishedCell> cells;
    for (const auto& row : table.rows) {
        cells.push_back({number(row, "fps_low"), number(row, "fps_high"), number(row, "key_bits_low"),
                         number(row, "key_bits_high"), number(row, "soc_percent")});
    }
    return cells;
}

}  // namespace

PublishedFigures read_published_figures(const std::filesystem::path& folder) {
    PublishedFigures figures;
    for (const auto phase : flight::all_phases) {
        figures.power[phase] = read_curve(folder / fmt::format("fig2_{}.csv", to_string(phase)), "power_w");
    }
    for (const auto* mission : {"mechanical-only", "invariant-5.8fps-32bit", "invariant-10fps-240bit",
                                "invariant-32fps-448bit", "phased", "adaptive"}) {
        auto name = std::string("fig3_") + mission + ".csv";
        std::ranges::replace(name, '-', '_');
        figures.soc[mission] = read_curve(folder / name, "soc_percent");
    }
    figures.soc_cells = read_cells(folder / "fig4_soc_cells.csv");
    return figures;
}

}  // namespace flightwatt::report
