#include "cli/output/difference_output.h"

#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

using mechanical::Difference;
using mechanical::Estimate;

/// A computed quantity of two missions, without intervals.
Difference computed(std::string part, std::string quantity, std::string unit, const std::optional<double>& a,
                    const std::optional<double>& b) {
    const auto estimate = [](const std::optional<double>& value) {
        return value ? std::optional(Estimate{*value, {}}) : std::nullopt;
    };
    return {std::move(part), std::move(quantity), std::move(unit), estimate(a), estimate(b)};
}

double phase_energy_wh(const mission::SocCurve& curve, mission::Phase phase) {
    double energy_j = 0.0;
    for (std::size_t i = 1; i < curve.rows.size(); ++i) {
        const auto& from = curve.rows[i - 1];
        const auto& to = curve.rows[i];
        if (from.phase == phase) energy_j += (to.time_s - from.time_s) * (from.power_w + to.power_w) / 2.0;
    }
    return units::wh_from_joule(energy_j);
}

double soc_at(const mission::SocCurve& curve, double time_s) {
    const auto after = std::ranges::lower_bound(curve.rows, time_s, {}, &mission::SocRow::time_s);
    if (after == curve.rows.begin()) return curve.rows.front().soc_percent;
    if (after == curve.rows.end()) return curve.rows.back().soc_percent;
    const auto& before = *std::prev(after);
    const auto part = (time_s - before.time_s) / (after->time_s - before.time_s);
    return std::lerp(before.soc_percent, after->soc_percent, part);
}

/// The largest difference of the states of charge during both missions.
std::optional<Difference> soc_difference(const mission::SocCurve& a, const mission::SocCurve& b) {
    if (a.rows.empty() || b.rows.empty()) return std::nullopt;
    const auto end_s = std::min(a.rows.back().time_s, b.rows.back().time_s);
    double max_s = 0.0;
    double largest = -1.0;
    for (const auto* curve : {&a, &b}) {
        for (const auto& row : curve->rows) {
            if (row.time_s > end_s) break;
            const auto apart = std::abs(soc_at(b, row.time_s) - soc_at(a, row.time_s));
            if (apart > largest) std::tie(largest, max_s) = std::pair(apart, row.time_s);
        }
    }
    auto row = computed("mission", "soc_percent", "%", soc_at(a, max_s), soc_at(b, max_s));
    row.at_s = max_s;
    return row;
}

/// Adds the intervals of flights drawn for both missions.
void add_intervals(const mission::SampledDifference& drawn, std::vector<Difference>& rows) {
    const std::map<std::string_view, const mission::DrawnIntervals*> intervals{
        {"duration_s", &drawn.duration_s},
        {"mechanical_energy_wh", &drawn.mechanical_energy_wh},
        {"compute_energy_wh", &drawn.compute_energy_wh},
        {"energy_wh", &drawn.energy_wh},
        {"final_soc_percent", &drawn.final_soc_percent}};
    for (auto& row : rows) {
        const auto found = intervals.find(row.quantity);
        if (row.part != "mission" || found == intervals.end() || !row.a || !row.b) continue;
        row.a->interval = found->second->a;
        row.b->interval = found->second->b;
        row.interval = found->second->difference;
        row.basis = mechanical::DifferenceBasis::flights;
    }
}

/// Whether the difference is significant; of computed missions whether it is more than rounding. std::nullopt: unknown.
std::optional<bool> differs(DifferenceKind kind, const Difference& row) {
    if (kind != DifferenceKind::missions || row.interval) return is_significant(row);
    const auto difference = difference_of(row);
    if (!difference) return std::nullopt;  // only one of them has it
    constexpr double rounding = 1e-9;
    return std::abs(*difference) > rounding * std::max(std::abs(row.a->value), std::abs(row.b->value));
}

/// A quantity of both.
struct DifferenceOutput {
    DifferenceKind kind;
    Difference row;
};

Fields<DifferenceOutput> record_fields(const DifferenceOutput*) {
    using R = DifferenceOutput;
    const auto basis = [](const R& r) {
        auto name = r.kind == DifferenceKind::missions && !r.row.interval ? "computed" : to_string(r.row.basis);
        return name.empty() ? std::nullopt : std::optional(name);
    };
    return {field("part", at(&R::row, &Difference::part), "the phase, `physical` or `mission`", column{}, csv_column{}),
            field("quantity", at(&R::row, &Difference::quantity), "name of the quantity", column{}, csv_column{}),
            field("unit", at(&R::row, &Difference::unit), "unit of the quantity", column{}, csv_column{}),
            field("a", at(&R::row, &Difference::a, &Estimate::value), "value of A", column{"", ".4g"}, csv_column{}),
            field("a_interval_95", at(&R::row, &Difference::a, &Estimate::interval), "", column{"a_low|a_high", ".4g"},
                  csv_column{"a_low|a_high"}),
            field("b", at(&R::row, &Difference::b, &Estimate::value), "value of B", column{"", ".4g"}, csv_column{}),
            field("b_interval_95", at(&R::row, &Difference::b, &Estimate::interval), "", column{"b_low|b_high", ".4g"},
                  csv_column{"b_low|b_high"}),
            field("difference", at(&R::row, mechanical::difference_of), "B less A", column{"", ".4g"}, csv_column{}),
            field("difference_interval_95", at(&R::row, &Difference::interval), "", column{"low|high", ".4g"},
                  csv_column{"low|high"}),
            field(
                "differs", [](const R& r) { return differs(r.kind, r.row); }, "the interval excludes 0; null: unknown",
                column{}, csv_column{}),
            field("basis", basis, "`noise`, `flights` or `computed`", column{}, csv_column{}),
            field("at_s", at(&R::row, &Difference::at_s), "of a curve: time of the largest difference",
                  column{"", ".4g"}, csv_column{})};
}

std::vector<DifferenceOutput> outputs_of(const Differences& differences) {
    std::vector<DifferenceOutput> all;
    for (const auto& row : differences.rows) all.push_back({differences.kind, row});
    return all;
}

}  // namespace

std::vector<Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b,
                                           const std::optional<mission::SampledDifference>& drawn) {
    std::vector<Difference> all;
    all.reserve(mission::all_phases.size() + 8);  // and of the whole mission
    for (const auto phase : mission::all_phases) {
        all.push_back(computed(std::string(to_string(phase)), "energy_wh", "Wh", phase_energy_wh(a.curve, phase),
                               phase_energy_wh(b.curve, phase)));
    }
    const auto add = [&](const char* quantity, const char* unit, const std::optional<double>& of_a,
                         const std::optional<double>& of_b) {
        if (of_a || of_b) all.push_back(computed("mission", quantity, unit, of_a, of_b));
    };
    const auto& x = a.summary;
    const auto& y = b.summary;
    add("duration_s", "s", x.duration_s, y.duration_s);
    add("mechanical_energy_wh", "Wh", x.mechanical_energy_wh, y.mechanical_energy_wh);
    add("compute_energy_wh", "Wh", x.compute_energy_wh, y.compute_energy_wh);
    add("energy_wh", "Wh", x.energy_wh, y.energy_wh);
    add("final_soc_percent", "%", x.final_soc_percent, y.final_soc_percent);
    add("depleted_at_s", "s", x.depleted_at_s, y.depleted_at_s);
    add("utility", "", x.utility, y.utility);
    if (const auto curve = soc_difference(a.curve, b.curve)) all.push_back(*curve);
    if (drawn) add_intervals(*drawn, all);
    return all;
}

TextTable difference_table(const Differences& differences) { return table_of(outputs_of(differences)); }

std::string differences_csv(const Differences& differences) { return csv_of(outputs_of(differences)); }

Fields<Differences> record_fields(const Differences*) {
    using R = Differences;
    const auto kind = [](const R& r) {
        constexpr std::array kinds{"models", "batches", "missions"};
        return std::string(kinds.at(static_cast<std::size_t>(r.kind)));
    };
    return {field("kind", kind, "`models`, `batches` or `missions`"),
            field(
                "differences", [](const R& r) { return outputs_of(r); }, "quantities")};
}

void note_differences(const StageCall& call, const std::vector<Difference>& rows) {
    std::vector<std::string> beyond_noise;
    std::vector<std::string> beyond_flights;
    std::size_t compared = 0;
    for (const auto& row : rows) {
        const auto significant = is_significant(row);
        if (significant) ++compared;
        if (!significant.value_or(false)) continue;
        auto& differing = row.basis == mechanical::DifferenceBasis::noise ? beyond_noise : beyond_flights;
        differing.push_back(row.part + " " + row.quantity);
    }
    if (compared == 0) {
        note(call, "no significance test: the models have no intervals; `flightwatt fit --errors` writes them");
    } else if (beyond_noise.empty() && beyond_flights.empty()) {
        note(call, fmt::format("none of {} quantities differs by more than its 95 % interval", compared));
    }
    if (!beyond_flights.empty()) {
        note(call,
             fmt::format("differ by more than flights of one aircraft do (of {} compared, one in 20 by chance): {}",
                         compared, fmt::join(beyond_flights, ", ")));
    }
    if (!beyond_noise.empty()) {
        note(call, fmt::format("differ by more than the noise of their samples, as other flights of the same "
                               "aircraft may: {}",
                               fmt::join(beyond_noise, ", ")));
    }
}

}  // namespace flightwatt::cli
