#include "mission/simulation.h"

#include "base/units.h"
#include "mission/flown_charge.h"
#include "mission/load_segments.h"
#include "mission/mission_utility.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double most_rows = 1e7;
constexpr double same_time_s = 1e-6;  ///< a battery that is empty this near to the end has lasted

void require_output_step(double output_s, double duration_s) {
    if (!(output_s > 0.0) || !std::isfinite(output_s)) {
        throw UsageError(
            fmt::format("an output step of {} s makes no sense, expected more than 0", output_s));
    }
    if (duration_s / output_s > most_rows) {
        throw UsageError(fmt::format("an output step of {} s makes more than {} rows of {} s", output_s,
                                     most_rows, duration_s));
    }
}

/// The ends of a demand and the multiples of the output step between them.
std::vector<double> output_times(const Demand& demand, double output_s) {
    const double tolerance_s = output_s * 1e-9;
    std::vector<double> times{demand.from_s};
    auto k = static_cast<std::uint64_t>(std::floor(demand.from_s / output_s)) + 1;
    for (; static_cast<double>(k) * output_s < demand.to_s - tolerance_s; ++k) {
        const double time_s = static_cast<double>(k) * output_s;
        if (time_s > demand.from_s + tolerance_s) times.push_back(time_s);
    }
    times.push_back(demand.to_s);
    return times;
}

/// A row, unless the last one says the same already: not every end of a stretch is a jump.
void add_row(SocCurve& curve, const battery::Battery& battery, const Demand& demand, double time_s,
             const battery::Discharge& state) {
    SocRow row;
    row.time_s = time_s;
    row.phase = demand.phase;
    row.mechanical_w = mechanical_w(demand, time_s);
    row.compute_w = demand.compute_w;
    row.power_w = power_w(demand, time_s);
    auto now = state.state();
    if (const auto ended_at_s = state.ended_at_s()) {
        // Without a load the RC pair discharges itself.
        if (battery.thevenin) {
            now.rc_voltage_v *= std::exp((*ended_at_s - time_s) / battery.thevenin->rc_time_constant_s);
        }
    } else {
        row.current_a = internal_current_a(battery, std::min(row.power_w, power_limit_w(battery, now)), now);
    }
    row.soc_percent = state.soc_percent;
    row.terminal_voltage_v = terminal_voltage_v(battery, now, row.current_a);
    if (curve.rows.empty() || curve.rows.back() != row) curve.rows.push_back(row);
}

/// Follows the battery from `state` through one demand and adds its rows.
battery::Discharge run_demand(const Mission& mission, const Demand& demand, const SimulationSteps& steps,
                              battery::Discharge state, SocCurve& curve) {
    const auto& battery = mission.battery;
    const battery::DischargeOptions options{steps.integration_s, mission.cutoff_voltage_v};
    const auto load = [&](double time_s) { return power_w(demand, time_s); };
    const auto times = output_times(demand, steps.output_s);
    if (demand.soc_drop_percent > 0.0 && !state.ended_at_s()) {
        add_row(curve, battery, demand, times.front(), state);
        state = after_drop(state, demand);
    }
    add_row(curve, battery, demand, times.front(), state);
    for (std::size_t i = 1; i < times.size(); ++i) {
        if (!state.ended_at_s()) {
            state = discharge(battery, load, times[i - 1], times[i], state.state(), options);
            if (state.undeliverable) {
                add_row(curve, battery, demand, state.undeliverable->time_s, state);
                return state;
            }
            if (const auto ended_at_s = state.ended_at_s()) {
                const battery::Discharge before{state.soc_percent, std::nullopt, std::nullopt, std::nullopt,
                                                state.rc_voltage_v};
                add_row(curve, battery, demand, *ended_at_s, before);  // the last row with a current,
                add_row(curve, battery, demand, *ended_at_s, state);   // and the first without
            }
        }
        add_row(curve, battery, demand, times[i], state);
    }
    return state;
}

void add_energies(const std::vector<Demand>& demands, double delivered_until_s, MissionSummary& summary) {
    for (const auto& demand : demands) {
        summary.mechanical_energy_wh += units::wh_from_joule(mechanical_energy_j(demand, demand.to_s));
        summary.compute_energy_wh += units::wh_from_joule(compute_energy_j(demand, demand.to_s));
        if (demand.from_s >= delivered_until_s) continue;
        const double until_s = std::min(demand.to_s, delivered_until_s);
        summary.delivered_energy_wh +=
            units::wh_from_joule(mechanical_energy_j(demand, until_s) + compute_energy_j(demand, until_s));
    }
    summary.energy_wh = summary.mechanical_energy_wh + summary.compute_energy_wh;
}

MissionSummary summarize(const Mission& mission, const std::vector<Demand>& demands,
                         const battery::Discharge& end) {
    MissionSummary summary;
    summary.mission = mission.name;
    summary.duration_s = demands.back().to_s;
    summary.undeliverable = end.undeliverable;
    const auto ended_early_at_s = [&](const std::optional<double>& time_s) {
        return time_s && *time_s < summary.duration_s - same_time_s ? time_s : std::nullopt;
    };
    summary.depleted_at_s = ended_early_at_s(end.empty_at_s);
    summary.cut_off_at_s = ended_early_at_s(end.cut_off_at_s);
    if (!end.undeliverable) summary.final_soc_percent = end.soc_percent;
    const double delivered_until_s =
        end.undeliverable ? end.undeliverable->time_s
                          : summary.depleted_at_s.value_or(summary.cut_off_at_s.value_or(summary.duration_s));
    add_energies(demands, delivered_until_s, summary);
    summary.feasible = !summary.undeliverable && !summary.depleted_at_s && !summary.cut_off_at_s;
    summary.reserve_soc_percent = mission.reserve_soc_percent;
    summary.keeps_reserve = summary.feasible && *summary.final_soc_percent >= mission.reserve_soc_percent;
    summary.utility = mean_worth(mission, delivered_until_s);
    return summary;
}

}  // namespace

Simulation simulate(const Mission& planned, const SimulationSteps& steps,
                    const std::vector<Disturbance>& disturbances) {
    auto mission = planned;
    mission.battery = disturbed(planned.battery, disturbances);
    const auto demands = disturbed(demands_of(mission), disturbances);
    if (demands.empty() || mission.plan) throw std::invalid_argument("simulate: the mission has no schedule");
    require_output_step(steps.output_s, demands.back().to_s);
    SocCurve curve;
    battery::Discharge state{mission.initial_soc_percent, std::nullopt, std::nullopt};
    for (const auto& demand : demands) {
        state = run_demand(mission, demand, steps, state, curve);
        if (state.undeliverable) break;
    }
    return {std::move(curve), summarize(mission, demands, state)};
}

std::string describe(const MissionSummary& summary) {
    if (const auto& failure = summary.undeliverable) {
        return fmt::format(
            "{}: the battery cannot deliver {:.6g} W at {:.6g} s: its limit U^2 / (4 R) is {:.6g} W",
            summary.mission, failure->power_w, failure->time_s, failure->limit_w);
    }
    auto end = fmt::format("{:.2f} % left after {:.1f} s", *summary.final_soc_percent, summary.duration_s);
    if (summary.depleted_at_s) {
        end = fmt::format("empty at {:.1f} s of {:.1f} s", *summary.depleted_at_s, summary.duration_s);
    } else if (summary.cut_off_at_s) {
        end = fmt::format("cut off at {:.1f} s of {:.1f} s with {:.2f} % left", *summary.cut_off_at_s,
                          summary.duration_s, *summary.final_soc_percent);
    } else if (!summary.keeps_reserve) {
        end += fmt::format(", less than the reserve of {:.6g} %", summary.reserve_soc_percent);
    }
    if (summary.decisions && summary.decisions->without_plan > 0) {
        end += fmt::format(
            " (at {} of {} decisions no plan kept the reserve with its margin, and what drains "
            "least was run)",
            summary.decisions->without_plan, summary.decisions->made);
    }
    return fmt::format("{}: {}; {:.3f} Wh, {:.3f} mechanical and {:.3f} computing", summary.mission, end,
                       summary.energy_wh, summary.mechanical_energy_wh, summary.compute_energy_wh);
}

std::string to_csv(const SocCurve& curve) {
    std::string text =
        "time_s,phase,mechanical_w,compute_w,power_w,current_a,soc_percent,terminal_voltage_v\n";
    for (const auto& row : curve.rows) {
        fmt::format_to(std::back_inserter(text),
                       "{:.10g},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}\n", row.time_s,
                       to_string(row.phase), row.mechanical_w, row.compute_w, row.power_w, row.current_a,
                       row.soc_percent, row.terminal_voltage_v);
    }
    return text;
}

}  // namespace flightwatt::mission
