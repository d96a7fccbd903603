#include "cli/output/difference_output.h"

#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {

Fields<Difference> record_fields(const Difference*) {
    using R = Difference;
    const auto basis = [](const R& r) {
        const auto name = to_string(r.basis);
        return name.empty() ? std::nullopt : std::optional(name);
    };
    return {field("part", &R::part, "the phase, `physical` or `mission`", column{}, csv_column{}),
            field("quantity", &R::quantity, "name of the quantity", column{}, csv_column{}),
            field("unit", &R::unit, "unit of the quantity", column{}, csv_column{}),
            field("a", at(&R::a, &Estimate::value), "value of A", column{"", ".4g"}, csv_column{}),
            field("a_interval_95", at(&R::a, &Estimate::interval), "", column{"a_low|a_high", ".4g"},
                  csv_column{"a_low|a_high"}),
            field("b", at(&R::b, &Estimate::value), "value of B", column{"", ".4g"}, csv_column{}),
            field("b_interval_95", at(&R::b, &Estimate::interval), "", column{"b_low|b_high", ".4g"},
                  csv_column{"b_low|b_high"}),
            field(
                "difference", [](const R& r) { return difference_of(r); }, "B less A", column{"", ".4g"}, csv_column{}),
            field("difference_interval_95", &R::interval, "", column{"low|high", ".4g"}, csv_column{"low|high"}),
            field(
                "differs", [](const R& r) { return is_significant(r); }, "the interval excludes 0; null: no interval",
                column{}, csv_column{}),
            field("basis", basis, "`noise` or `flights`; null: no interval", column{}, csv_column{}),
            field("at_s", &R::at_s, "of a curve: time of the largest difference", column{"", ".4g"}, csv_column{})};
}

}  // namespace flightwatt::mechanical

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

}  // namespace

std::vector<Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b,
                                           const std::optional<mission::SampledDifference>& drawn) {
    std::vector<Difference> all;
    all.reserve(2 * mission::all_phases.size());
    for (const auto phase : mission::all_phases) {
        all.push_back(computed(std::string(to_string(phase)), "energy_wh", "Wh", phase_energy_wh(a.curve, phase),
                               phase_energy_wh(b.curve, phase)));
    }
    using Intervals = mission::DrawnIntervals mission::SampledDifference::*;
    const auto add = [&](const char* quantity, const char* unit, auto mission::MissionSummary::*member,
                         Intervals intervals = nullptr) {
        auto row = computed("mission", quantity, unit, a.summary.*member, b.summary.*member);
        if (!row.a && !row.b) return;
        if (drawn && intervals != nullptr && row.a && row.b) {
            std::tie(row.a->interval, row.b->interval) = std::pair((*drawn.*intervals).a, (*drawn.*intervals).b);
            row.interval = (*drawn.*intervals).difference;
            row.basis = mechanical::DifferenceBasis::flights;
        }
        all.push_back(std::move(row));
    };
    using S = mission::MissionSummary;
    using D = mission::SampledDifference;
    add("duration_s", "s", &S::duration_s, &D::duration_s);
    add("mechanical_energy_wh", "Wh", &S::mechanical_energy_wh, &D::mechanical_energy_wh);
    add("compute_energy_wh", "Wh", &S::compute_energy_wh, &D::compute_energy_wh);
    add("energy_wh", "Wh", &S::energy_wh, &D::energy_wh);
    add("final_soc_percent", "%", &S::final_soc_percent, &D::final_soc_percent);
    add("depleted_at_s", "s", &S::depleted_at_s);
    add("utility", "", &S::utility);
    return all;
}

Fields<Differences> record_fields(const Differences*) {
    using R = Differences;
    const auto kind = [](const R& r) {
        constexpr std::array kinds{"models", "batches", "missions"};
        return std::string(kinds.at(static_cast<std::size_t>(r.kind)));
    };
    return {field("kind", kind, "`models`, `batches` or `missions`"), field("differences", &R::rows, "quantities")};
}

void note_differences(const StageCall& call, const std::vector<Difference>& rows) {
    const auto compared = std::ranges::count_if(rows, [](const auto& row) { return is_significant(row).has_value(); });
    if (compared == 0)
        return note(call, "no significance test: the models have no intervals; `flightwatt fit --errors` writes them");
    for (const auto& [basis, than] : {std::pair{mechanical::DifferenceBasis::flights, "flights of one aircraft do"},
                                      std::pair{mechanical::DifferenceBasis::noise, "the noise of their samples"}}) {
        std::vector<std::string> differing;
        for (const auto& row : rows)
            if (row.basis == basis && is_significant(row).value_or(false))
                differing.push_back(row.part + " " + row.quantity);
        if (!differing.empty())
            note(call, fmt::format("differ by more than {} (of {} compared, one in 20 by chance): {}", than, compared,
                                   fmt::join(differing, ", ")));
    }
}

}  // namespace flightwatt::cli
