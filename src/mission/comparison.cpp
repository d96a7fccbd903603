#include "mission/comparison.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt {
namespace {

/// Greater is better.
std::pair<double, double> merit(const MissionSummary& summary) {
    constexpr double never = std::numeric_limits<double>::infinity();
    return {summary.final_soc_percent.value_or(-never), summary.depleted_at_s.value_or(never)};
}

std::string cell(const std::optional<double>& value, int decimals) {
    return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

}  // namespace

std::vector<MissionSummary> ranked(std::vector<MissionSummary> summaries) {
    std::stable_sort(summaries.begin(), summaries.end(),
                     [](const auto& a, const auto& b) { return merit(a) > merit(b); });
    return summaries;
}

TextTable comparison_table(const std::vector<MissionSummary>& ranked) {
    TextTable table;
    table.header = {"rank",
                    "mission",
                    "final_soc_percent",
                    "energy_wh",
                    "mechanical_energy_wh",
                    "compute_energy_wh",
                    "duration_s",
                    "depleted_at_s"};
    for (std::size_t i = 0; i < ranked.size(); ++i) {
        const auto& summary = ranked[i];
        table.rows.push_back({fmt::format("{}", i + 1), summary.mission, cell(summary.final_soc_percent, 2),
                              cell(summary.energy_wh, 3), cell(summary.mechanical_energy_wh, 3),
                              cell(summary.compute_energy_wh, 3), cell(summary.duration_s, 1),
                              cell(summary.depleted_at_s, 1)});
    }
    return table;
}

}  // namespace flightwatt
