#include "mission/simulation.h"

#include "base/csv.h"
#include "base/units.h"
#include "mission/simulation/load_segments.h"
#include "path/path_entries.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double most_rows = 1e7;

void require_output_step(double output_s, double duration_s) {
    if (!(output_s > 0.0) || !std::isfinite(output_s)) {
        throw UsageError(fmt::format("an output step of {:.6g} s makes no sense, expected more than 0", output_s));
    }
    if (duration_s / output_s > most_rows) {
        throw UsageError(fmt::format("an output step of {:.6g} s makes more than {:.0f} rows of {:.6g} s", output_s,
                                     most_rows, duration_s));
    }
}

/// The ends of a demand and the multiples of the output step between them.
std::vector<double> output_times(const LoadSegment& segment, double output_s) {
    const double tolerance_s = output_s * 1e-9;
    std::vector<double> times{segment.start_s};
    auto k = static_cast<std::uint64_t>(std::floor(segment.start_s / output_s)) + 1;
    for (; static_cast<double>(k) * output_s < segment.end_s - tolerance_s; ++k) {
        const double time_s = static_cast<double>(k) * output_s;
        if (time_s > segment.start_s + tolerance_s) times.push_back(time_s);
    }
    times.push_back(segment.end_s);
    return times;
}

/// The mechanical power of a segment; that of the last time is not computed again.
class SegmentPower {
  public:
    explicit SegmentPower(const LoadSegment& segment) : segment_(segment) {}

    double at(double time_s) {
        if (time_s != time_s_) mechanical_w_ = mechanical_w(segment_, time_s_ = time_s);
        return mechanical_w_;
    }

  private:
    const LoadSegment& segment_;
    double time_s_ = std::numeric_limits<double>::quiet_NaN();
    double mechanical_w_ = 0.0;
};

/// Adds a row unless it equals the last one: not every end of a segment is a jump.
void add_row(SocCurve& curve, const battery::Battery& battery, const LoadSegment& segment, double flying_w,
             double time_s, const battery::Discharge& state) {
    SocRow row{time_s, segment.phase, flying_w, segment.compute_w, flying_w + segment.compute_w};
    battery::BatteryState now = state;
    if (const auto ended_at_s = state.ended_at_s()) {
        // Without a load the RC pair discharges itself.
        if (battery.thevenin)
            now.rc_voltage_v *= std::exp((*ended_at_s - time_s) / battery.thevenin->rc_time_constant_s);
    } else {
        row.current_a = internal_current_a(battery, std::min(row.power_w, power_limit_w(battery, now)), now);
    }
    row.soc_percent = state.soc_percent;
    row.terminal_voltage_v = terminal_voltage_v(battery, now, row.current_a);
    if (curve.rows.empty() || curve.rows.back() != row) curve.rows.push_back(row);
}

/// What feeds the mission, as it really is.
struct Supply {
    battery::Battery battery;
    double cutoff_voltage_v = 0.0;
};

/// Over which power and the RC pair's voltage are smooth for Runge-Kutta: a sixtieth of a turn of the fastest harmonic,
/// and a tenth of the time constant, but not below 0.1 s.
double integration_step_s(const battery::Battery& battery, const LoadSegment& segment) {
    constexpr double shortest_s = 0.1;
    double smooth_s = quick_step_s(segment) / 5.0;
    if (battery.thevenin) smooth_s = std::min(smooth_s, battery.thevenin->rc_time_constant_s / 10.0);
    return std::max(smooth_s, shortest_s);
}

/// Follows the battery from `state` through one demand and adds its rows.
battery::Discharge run_segment(const Supply& supply, const LoadSegment& segment, const SimulationOptions& steps,
                               battery::Discharge state, SocCurve& curve) {
    const auto& battery = supply.battery;
    const battery::DischargeOptions options{std::min(steps.integration_s, integration_step_s(battery, segment)),
                                            supply.cutoff_voltage_v};
    SegmentPower power(segment);
    const auto load = [&](double time_s) { return power.at(time_s) + segment.compute_w; };
    const auto add = [&](double time_s, const battery::Discharge& now) {
        if (steps.with_curve) add_row(curve, battery, segment, power.at(time_s), time_s, now);
    };
    const auto times = output_times(segment, steps.output_s);
    if (segment.soc_drop_percent > 0.0 && !state.ended_at_s()) {
        add(times.front(), state);
        state = apply_charge_drop(state, segment);
    }
    add(times.front(), state);
    for (std::size_t i = 1; i < times.size(); ++i) {
        if (!state.ended_at_s()) {
            state = discharge(battery, {load, times[i - 1], times[i]}, state, options);
            if (state.undeliverable) {
                add(state.undeliverable->time_s, state);
                return state;
            }
            if (const auto ended_at_s = state.ended_at_s()) {
                const battery::Discharge before{static_cast<const battery::BatteryState&>(state)};
                add(*ended_at_s, before);  // the last row with a current,
                add(*ended_at_s, state);   // and the first without
            }
        }
        add(times[i], state);
    }
    return state;
}

void add_energies(const std::vector<LoadSegment>& segments, MissionSummary& summary) {
    const double powered_s = powered_end_s(summary);
    for (const auto& segment : segments) {
        summary.mechanical_energy_wh += units::wh_from_joule(mechanical_energy_j(segment, segment.end_s));
        summary.compute_energy_wh += units::wh_from_joule(compute_energy_j(segment, segment.end_s));
        if (segment.start_s >= powered_s) continue;
        const double until_s = std::min(segment.end_s, powered_s);
        summary.delivered_energy_wh +=
            units::wh_from_joule(mechanical_energy_j(segment, until_s) + compute_energy_j(segment, until_s));
    }
    summary.energy_wh = summary.mechanical_energy_wh + summary.compute_energy_wh;
}

/// All but the utility, which depends on the schedule.
MissionSummary summarize(const MissionSetup& mission, const std::vector<LoadSegment>& segments,
                         const battery::Discharge& end) {
    MissionSummary summary;
    summary.mission = mission.name;
    summary.duration_s = segments.back().end_s;
    summary.undeliverable = end.undeliverable;
    const auto ended_early_at_s = [&](const std::optional<double>& time_s) {
        return time_s && *time_s < summary.duration_s - end_tolerance_s ? time_s : std::nullopt;
    };
    summary.depleted_at_s = ended_early_at_s(end.empty_at_s);
    summary.cut_off_at_s = ended_early_at_s(end.cut_off_at_s);
    if (!end.undeliverable) summary.final_soc_percent = end.soc_percent;
    add_energies(segments, summary);
    summary.feasible = !summary.undeliverable && !summary.depleted_at_s && !summary.cut_off_at_s;
    summary.power_model = mission.power_model;
    summary.uncertain = mission.uncertain;
    if (mission.survey && mission.survey->is_chosen) {
        summary.lines = mission.survey->layout;
        summary.coverage = mission.survey->coverage;
    }
    summary.reserve_soc_percent = mission.reserve_soc_percent;
    summary.keeps_reserve = summary.feasible && *summary.final_soc_percent >= mission.reserve_soc_percent;
    return summary;
}

/// The charge at a time of the simulation; NaN after the battery's end.
double charge_percent(const Simulation& simulation, double time_s) {
    const auto& rows = simulation.curve.rows;
    if (rows.empty() || time_s > powered_end_s(simulation.summary)) return std::nan("");
    const auto after = std::ranges::lower_bound(rows, time_s, {}, &SocRow::time_s);
    if (after == rows.begin()) return after->soc_percent;
    if (after == rows.end()) return rows.back().soc_percent;
    const auto& [before, next] = std::pair(*std::prev(after), *after);
    const double part = next.time_s > before.time_s ? (time_s - before.time_s) / (next.time_s - before.time_s) : 1.0;
    return std::lerp(before.soc_percent, next.soc_percent, part);
}

}  // namespace

Simulation simulate(const MissionSetup& mission, const Schedule& schedule, const SimulationOptions& steps,
                    const Disturbances& disturbances) {
    const auto stated = load_segments(mission, schedule);
    if (stated.empty()) throw std::invalid_argument("simulate: the mission has no schedule");
    refuse_charging(mission, stated);
    const auto segments = disturbed(stated, disturbances);
    require_output_step(steps.output_s, segments.back().end_s);
    const Supply supply{apply_disturbances(mission.battery, disturbances), mission.cutoff_voltage_v};
    SocCurve curve;
    battery::Discharge state{{mission.initial_soc_percent}};
    for (const auto& segment : segments) {
        state = run_segment(supply, segment, steps, state, curve);
        if (state.undeliverable) break;
    }
    auto summary = summarize(mission, segments, state);
    summary.utility = mean_utility(mission, schedule, powered_end_s(summary));
    return {std::move(curve), std::move(summary)};
}

Simulation simulate(const Mission& mission, const SimulationOptions& steps, const Disturbances& disturbances) {
    return simulate(mission.setup, mission.schedule, steps, disturbances);
}

std::optional<EstimatedLanding> landing_by_flights(const MissionSetup& mission, const Schedule& schedule,
                                                   const Disturbances& disturbances) {
    auto estimated = estimated_by_flights(mission.battery);
    if (!estimated) return std::nullopt;
    auto setup = mission;
    setup.battery = std::move(*estimated);
    const auto summary = simulate(setup, schedule, {.with_curve = false}, disturbances).summary;
    EstimatedLanding landing{setup.battery.capacity_ah, summary.final_soc_percent, std::nullopt, summary.keeps_reserve};
    if (!summary.feasible) landing.fails_at_s = powered_end_s(summary);
    return landing;
}

std::optional<FlownTrack> flown_track(const MissionSetup& mission, const Simulation& simulation) {
    if (!mission.cruise_path) return std::nullopt;
    const auto& plan = *mission.cruise_path->plan;
    const auto& elements = plan.path.elements;
    constexpr double step_s = 2.0;
    constexpr int most_points = 20, most_of_circles = 400;
    const auto flown = compute_trajectory(plan.path, plan.wind, path::InfeasibleLegPolicy::crawl);
    FlownTrack track;
    track.wind = plan.wind;
    path::LocalPosition start;
    const auto add = [&](const path::LocalPosition& place, double time_s) {
        track.time_s.push_back(time_s);
        track.east_m.push_back(place.east_m);
        track.north_m.push_back(place.north_m);
        track.soc_percent.push_back(charge_percent(simulation, time_s));
        if (!plan.origin) return;
        const auto where = to_geodetic(plan.origin->start + place, plan.origin->place);
        track.latitude_deg.push_back(where.latitude_deg);
        track.longitude_deg.push_back(where.longitude_deg);
    };
    double time_s = timeline_of(mission.duration_s).start_s[Phase::cruise];
    if (!elements.empty()) add(start, time_s);
    for (std::size_t e = 0; e < elements.size(); ++e) {
        if (elements[e].name == way_home && !track.return_index) track.return_index = track.time_s.size() - 1;
        const bool is_round = std::holds_alternative<path::Circles>(elements[e].shape);
        const int count =
            std::clamp(static_cast<int>(flown.element_s[e] / step_s), 1, is_round ? most_of_circles : most_points);
        for (int i = 1; i <= count; ++i) {
            const double part = static_cast<double>(i) / count;
            add(start + path::local_position_at({{elements[e]}}, {0, part}), time_s + part * flown.element_s[e]);
        }
        start = start + path::local_position_at({{elements[e]}}, {1, 0.0});
        time_s += flown.element_s[e];
    }
    return track;
}

std::string to_csv(const SocCurve& curve) {
    constexpr int digits = 10;
    CsvWriter csv(
        {"time_s", "phase", "mechanical_w", "compute_w", "power_w", "current_a", "soc_percent", "terminal_voltage_v"},
        digits);
    for (const auto& row : curve.rows) {
        csv.add(row.time_s, to_string(row.phase), row.mechanical_w, row.compute_w, row.power_w, row.current_a,
                row.soc_percent, row.terminal_voltage_v);
    }
    return csv.text();
}

}  // namespace flightwatt::mission
