#include "mission/comparison.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// Greater is better: what lasts, by the charge left; then what ended early, by how long it lasted.
std::pair<int, double> merit(const MissionSummary& summary) {
    if (!summary.final_soc_percent) return {0, 0.0};  // undeliverable
    if (summary.depleted_at_s) return {1, *summary.depleted_at_s};
    if (summary.cut_off_at_s) return {1, *summary.cut_off_at_s};
    return {2, *summary.final_soc_percent};
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
    // Most missions have no cut-off voltage, and tables wide enough without it.
    const bool cut_off =
        std::any_of(ranked.begin(), ranked.end(), [](const auto& s) { return s.cut_off_at_s.has_value(); });
    if (cut_off) table.header.emplace_back("cut_off_at_s");
    const bool has_utility = std::any_of(ranked.begin(), ranked.end(),
                                         [](const auto& summary) { return summary.utility.has_value(); });
    if (has_utility) table.header.emplace_back("utility");
    const bool sampled = std::any_of(ranked.begin(), ranked.end(),
                                     [](const auto& summary) { return summary.samples.has_value(); });
    if (sampled) table.header.emplace_back("probability_below_reserve");
    for (std::size_t i = 0; i < ranked.size(); ++i) {
        const auto& summary = ranked[i];
        const auto name = summary.schedule == ScheduleOrigin::given
                              ? summary.mission
                              : fmt::format("{} ({})", summary.mission, to_string(summary.schedule));
        table.rows.push_back({fmt::format("{}", i + 1), name, cell(summary.final_soc_percent, 2),
                              cell(summary.energy_wh, 3), cell(summary.mechanical_energy_wh, 3),
                              cell(summary.compute_energy_wh, 3), cell(summary.duration_s, 1),
                              cell(summary.depleted_at_s, 1)});
        if (cut_off) table.rows.back().push_back(cell(summary.cut_off_at_s, 1));
        if (has_utility) table.rows.back().push_back(cell(summary.utility, 3));
        if (sampled) {
            table.rows.back().push_back(summary.samples ? cell(summary.samples->probability_below_reserve, 4)
                                                        : "-");
        }
    }
    return table;
}

}  // namespace flightwatt::mission
