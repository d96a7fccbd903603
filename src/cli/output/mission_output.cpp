#include "cli/output/mission_output.h"

#include "base/error.h"
#include "mechanical/mechanical_model.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

namespace flightwatt::mechanical {

Fields<HeldOutScore> record_fields(const HeldOutScore*) {
    using R = HeldOutScore;
    return {field("model", &R::model, "name of the model"),
            field("flights", &R::flights, "hold-out flights that it predicts"),
            field("mean_absolute_error_percent", &R::mean_absolute_error_percent, "of the energy of these flights")};
}

}  // namespace flightwatt::mechanical

namespace flightwatt::path {

Fields<SurveyStrip> record_fields(const SurveyStrip*) {
    using R = SurveyStrip;
    return {field("to", &R::to, "part of the width up to which it covers, in the order of flight"),
            field("spacing_m", &R::spacing_m, "distance between its lines"),
            field("airspeed_m_per_s", &R::airspeed_m_per_s, "if it was chosen", optional_key{})};
}

Fields<SurveyLayout> record_fields(const SurveyLayout*) {
    using R = SurveyLayout;
    return {field("heading_deg", &R::heading_deg, "course of the first line, or its reverse"),
            field("strips", &R::strips, "parts of the area, in the order of flight")};
}

}  // namespace flightwatt::path

namespace flightwatt::mission {

Fields<UncertaintySources> record_fields(const UncertaintySources*) {
    using R = UncertaintySources;
    return {field("varied", &R::varied, "what differs between the drawn flights"),
            field("fixed", &R::fixed, "what is the same in all drawn flights")};
}

Fields<MonteCarloResult> record_fields(const MonteCarloResult*) {
    using R = MonteCarloResult;
    const auto quantiles = [](const R& flights) -> std::optional<Keyed<double>> {
        if (!flights.variability_is_known) return std::nullopt;
        Keyed<double> all;
        for (std::size_t i = 0; i < shown_quantiles_percent.size(); ++i)
            all.emplace_back(std::to_string(shown_quantiles_percent[i]), flights.final_soc_quantiles_percent[i]);
        return all;
    };
    const auto known = [](auto member) {
        return [member](const R& flights) {
            return flights.variability_is_known ? std::optional(flights.*member) : std::nullopt;
        };
    };
    return list_fields<R>(
        field("probability_below_reserve", known(&R::probability_below_reserve),
              "fraction of the flights below the reserve; null: how flights differ is unknown",
              column_if_any("probability below reserve", ".4f"), csv_column{}),
        field("probability_below_reserve_interval_95", known(&R::probability_below_reserve_95),
              "of new flights, by the number drawn and by the few flights of the model"),
        field("probability_below_reserve_standard_error", known(&R::probability_below_reserve_standard_error),
              "of the number drawn"),
        field("probability_depleted", known(&R::probability_depleted), "the battery is empty before the end"),
        field("probability_battery_failure", known(&R::probability_battery_failure), "empty, cut off or too weak"),
        field("samples", &R::samples, "number of drawn flights"), field("seed", &R::seed, "seed of the random numbers"),
        field("final_soc_mean_percent", known(&R::final_soc_mean_percent), "mean over the flights"),
        field("final_soc_sd_percent", known(&R::final_soc_sd_percent), "standard deviation over the flights"),
        field("final_soc_quantiles_percent", quantiles, "quantiles over the flights: 5, 25, 50, 75 and 95 %"),
        embedded(&R::sources));
}

Fields<EstimatedLanding> record_fields(const EstimatedLanding*) {
    using R = EstimatedLanding;
    return {field("capacity_ah", &R::capacity_ah, "capacity of the pack by its flights"),
            field("final_soc_percent", &R::final_soc_percent, "at the end; null: the battery cannot deliver the power"),
            field("fails_at_s", &R::fails_at_s, "time of the battery's failure; null: never"),
            field("keeps_reserve", &R::keeps_reserve, "lands with the reserve")};
}

Fields<AdaptiveDecisions> record_fields(const AdaptiveDecisions*) {
    using R = AdaptiveDecisions;
    return {
        field("decisions", &R::made, "plans made in flight"),
        field("decisions_without_plan", &R::without_plan, "decisions where no plan kept the reserve"),
        field("learned_mechanical_factor", &R::mechanical_factor, "mechanical power over the model's, as estimated")};
}

Fields<MissionSummary> record_fields(const MissionSummary*) {
    using R = MissionSummary;
    const auto schedule = [](const R& summary) {
        return summary.schedule == ScheduleOrigin::given ? std::nullopt : std::optional(to_string(summary.schedule));
    };
    const auto uncertain = [](const R& summary) {
        return summary.uncertain.empty() ? std::nullopt : std::optional(summary.uncertain);
    };
    return list_fields<R>(
        field("mission", &R::mission, "name of the mission", column{}, csv_column{}),
        field("schedule", schedule, "origin of the schedule, unless the mission states it", column_if_any(),
              csv_column{}, optional_key{}),
        field("final_soc_percent", &R::final_soc_percent, "at the end; null: the battery cannot deliver the power",
              column{"final state of charge [%]", ".2f"}, csv_column{}),
        field("reserve_soc_percent", &R::reserve_soc_percent, "reserve that the mission demands",
              column{"reserve [%]", ".2f"}, csv_column{}),
        field("keeps_reserve", &R::keeps_reserve, "the battery lasts, and the reserve is left", csv_column{}),
        field("uncertain", uncertain, "why that may be wrong whatever its probability, if it may", optional_key{}),
        field("energy_wh", &R::energy_wh, "demanded by the whole mission", column{"energy [Wh]"}, csv_column{}),
        field("mechanical_energy_wh", &R::mechanical_energy_wh, "part of flying", column{"mechanical [Wh]"},
              csv_column{}),
        field("compute_energy_wh", &R::compute_energy_wh, "part of the software", column{"computing [Wh]"},
              csv_column{}),
        field("delivered_energy_wh", &R::delivered_energy_wh, "until the battery's end", csv_column{}),
        field("duration_s", &R::duration_s, "duration of the mission", column{"duration [s]"}, csv_column{}),
        field("depleted_at_s", &R::depleted_at_s, "the battery is empty; null: never", column_if_any("empty at [s]"),
              csv_column{}),
        field("cut_off_at_s", &R::cut_off_at_s, "the voltage falls below the cut-off; null: never",
              column_if_any("cut off at [s]"), csv_column{}),
        field("feasible", &R::feasible, "the battery lasts"),
        field("power_model", &R::power_model, "model of the (cruise) power and its error", optional_key{}),
        field("utility", &R::utility, "mean utility per second", column_if_any("", ".3f"), csv_column{},
              optional_key{}),
        field("lines", &R::lines, "lines over an area, if they were chosen", optional_key{}),
        field("coverage", &R::coverage, "how often they see a place on average", optional_key{}),
        embedded_if_any(&R::decisions), embedded_if_any(&R::samples),
        field("with_capacity_of_flights", &R::by_flights, "with the capacity by the pack's flights, if it differs",
              optional_key{}));
}

Fields<FlownTrack> record_fields(const FlownTrack*) {
    using R = FlownTrack;
    const auto rounded = [](const std::vector<double> R::*column, double scale) {
        return [column, scale](const R& track) {
            std::vector<std::optional<double>> values;
            for (const double value : track.*column)
                values.push_back(std::isnan(value) ? std::nullopt : std::optional(std::round(value * scale) / scale));
            return values;
        };
    };
    const auto degrees = [rounded](const std::vector<double> R::*column) {
        constexpr double scale = 1e7;
        return [column, round = rounded(column, scale)](const R& track) {
            return (track.*column).empty() ? std::nullopt : std::optional(round(track));
        };
    };
    constexpr double tenths = 10.0;
    return {field("time_s", rounded(&R::time_s, tenths), "since the mission began"),
            field("east_m", rounded(&R::east_m, tenths), "from the start of the path"),
            field("north_m", rounded(&R::north_m, tenths), "likewise"),
            field("latitude_deg", degrees(&R::latitude_deg), "null: the path is in metres from an unknown place"),
            field("longitude_deg", degrees(&R::longitude_deg), "likewise"),
            field("soc_percent", rounded(&R::soc_percent, tenths), "charge there; null: the battery has failed"),
            field("return_index", &R::return_index, "of the point where the way home begins; null: no pack is changed"),
            field("wind_m_per_s", at(&R::wind, &path::Wind::speed_m_per_s), "speed of the wind"),
            field("wind_from_deg", at(&R::wind, &path::Wind::from_deg), "where it comes from, clockwise from north")};
}

Fields<PackFlight> record_fields(const PackFlight*) {
    using R = PackFlight;
    const auto track = [](const R& r) { return flown_track(setup_of(r.mission), r.flown.simulation); };
    const auto schedule = [](const R& flight) {
        std::vector<Json> segments;
        for (const auto& segment : flight.flown.schedule)
            segments.push_back({{"phase", to_string(segment.phase)},
                                {"from_s", segment.start_s},
                                {"to_s", segment.end_s},
                                {"run", JsonType<Keyed<Keyed<double>>>::write(
                                            cli::run_values(segment.run, setup_of(flight.mission).compute))}});
        return segments;
    };
    return list_fields<R>(
        field("pack", &R::pack, "number of the pack", csv_column{}),
        field("start_s", &R::start_s, "since the first take-off", column{"start [s]"}, csv_column{}),
        field("cruise_from_s", &R::cruise_from_s, "of the cruise as if flown at once", column{"cruise from [s]"},
              csv_column{}),
        field("cruise_to_s", &R::cruise_to_s, "the same", column{"to [s]"}, csv_column{}),
        field("largest_to_s", &R::largest_to_s, "from where this pack could still return with the reserve",
              column{"at most [s]"}, csv_column{}),
        field("margin_percent", &R::margin_percent, "above the reserve, for the probability", optional_key{}),
        field("return_from", &R::return_from, "element of the path and its completed part; empty: the end, or no path",
              column_if_any("returns from"), csv_column{}),
        field("return_east_m", &R::return_east_m, "from the start of the path; null: the same", csv_column{}),
        field("return_north_m", &R::return_north_m, "the same", csv_column{}),
        embedded([](const R& r) { return &r.flown.simulation.summary; }),
        field("track", track, "of the cruise along its path"),
        field("runs", schedule, "schedule: from and to since the phase began"));
}

Fields<PackFlights> record_fields(const PackFlights*) {
    using R = PackFlights;
    const auto stated = [](const R& all) { return all.setup.packs->count; };
    return list_fields<R>(
        field("packs", stated, "number of packs of the mission"),
        field("packs_needed", &R::needed, "null: no number of packs is enough"),
        field("probability", &R::probability, "of each flight to keep the reserve", optional_key{}),
        field("on_ground_s", &R::on_ground_s, "between the flights; part of the duration"),
        embedded(&R::total, {"schedule", "depleted_at_s", "cut_off_at_s", "delivered_energy_wh"}),
        field("flights", &R::flights, "one with each pack; final_soc_percent above is the least of them"));
}

Fields<InfeasibilityReport> record_fields(const InfeasibilityReport*) {
    using R = InfeasibilityReport;
    return {field("short_percent", &R::shortfall_percent, "missing charge with the least energy"),
            field("short_wh", &R::shortfall_wh, "the same as energy"),
            field("cut_off_at_s", &R::cut_off_at_s, "the voltage falls below the cut-off; null: never"),
            field("longest_cruise_s", &R::cruise_s, "longest feasible cruise"),
            field("largest_reserve_soc_percent", &R::reserve_soc_percent, "largest feasible reserve"),
            field("smallest_capacity_ah", &R::capacity_ah, "smallest sufficient capacity")};
}

}  // namespace flightwatt::mission

namespace flightwatt::cli {

Fields<RankedMission> record_fields(const RankedMission*) {
    using R = RankedMission;
    return list_fields<R>(field("rank", &R::rank, "1: most charge left", column{}, csv_column{}),
                          embedded(&R::summary));
}

Fields<MissionComparison> record_fields(const MissionComparison*) {
    return {field("missions", &MissionComparison::missions, "the mission with most charge left first")};
}

Fields<PlanOutput> record_fields(const PlanOutput*) {
    using R = PlanOutput;
    using P = mission::MissionPlan;
    using S = mission::MissionSummary;
    using Setup = mission::MissionSetup;
    const auto utility = [](const P& plan) { return plan.plan.feasible ? plan.summary.utility : std::nullopt; };
    const auto bound = [](const P& plan) {
        return plan.plan.feasible && plan.plan.bound_is_proven ? std::optional(plan.plan.utility_bound) : std::nullopt;
    };
    return list_fields<R>(
        field("mission", at(&R::setup, &Setup::name), "name of the mission"),
        field("feasible", at(&R::plan, &P::plan, &mission::Plan::feasible), "a schedule lands with the reserve"),
        field("utility", at(&R::plan, utility), "mean utility per second of the plan"),
        field("bound", at(&R::plan, bound), "no schedule has a greater utility"),
        field("final_soc_percent", at(&R::plan, &P::summary, &S::final_soc_percent), "at the end"),
        field("reserve_soc_percent", at(&R::setup, &Setup::reserve_soc_percent), "reserve"),
        field("lines", at(&R::plan, &P::summary, &S::lines), "lines over an area, if they were chosen", optional_key{}),
        field("coverage", at(&R::plan, &P::summary, &S::coverage), "how often they see a place on average",
              optional_key{}),
        field("margin_percent", at(&R::plan, &P::margin_percent), "above the reserve, for `--probability`"),
        field("power_model", at(&R::setup, &Setup::power_model), "model of the (cruise) power", optional_key{}),
        embedded_if_any([](const R& r) { return r.plan->sources ? &*r.plan->sources : nullptr; }),
        field("with_capacity_of_flights", at(&R::plan, &P::summary, &S::by_flights),
              "with the capacity by the pack's flights, if it differs", optional_key{}),
        field("shortfall", &R::shortfall, "why no plan is feasible", optional_key{}));
}

Keyed<Keyed<double>> run_values(const compute::Configuration& run, const compute::ComputeModel& compute) {
    Keyed<Keyed<double>> all;
    for (const auto& running : run) {
        const auto& component = compute.components[running.component];
        auto& qos = all.emplace_back(component.name, Keyed<double>()).second;
        for (std::size_t i = 0; i < running.qos.size(); ++i)
            qos.emplace_back(component.profile.parameters[i], running.qos[i]);
    }
    return all;
}

void print_packs(const StageCall& call, const mission::PackFlights& all, const std::string& csv,
                 const ScreenTable& table) {
    for (const auto& text : all.total.uncertain)  // of single flights; warn_of_setup() warned of the mission's
        if (std::ranges::find(all.setup.uncertain, text) == all.setup.uncertain.end())
            warn(call, fmt::format("{}: {}", all.setup.name, text));
    if (all.suffice) write_csv_result(call, csv, table);
    if (call.json) print_json(call, all);
    if (!all.suffice) throw NoResultError(describe(all));
    if (call.json) return;
    for (const auto& flight : all.flights) {
        auto text = describe(flight.flown.simulation.summary);
        if (flight.return_east_m)
            text += fmt::format("; returns from {} ({:.0f} m east, {:.0f} m north of the start)", flight.return_from,
                                *flight.return_east_m, *flight.return_north_m);
        note(call, text);
    }
    note(call, describe(all));
    note_power_model(call, all.setup);
}

void warn_of_lost_comments(const StageCall& call, const mission::PlannedMissionText& written) {
    if (written.lost_comments)
        warn(call,
             "the result lacks the mission's comments and order; to keep them, write [plan], [policy] and [[schedule]] "
             "as tables of their own, not inline or dotted, and choices of lines in [path] on one line each: "
             "spacing_m = { levels = [30, 50] }");
}

void warn_of_setup(const StageCall& call, const mission::MissionSetup& mission) {
    auto warnings = battery_warnings(mission.battery);
    if (mission.packs)
        for (const auto& battery : mission.packs->batteries)
            std::ranges::copy(battery_warnings(battery), std::back_inserter(warnings));
    if (mission.mechanical) std::ranges::copy(model_warnings(*mission.mechanical), std::back_inserter(warnings));
    std::ranges::copy(mission.uncertain, std::back_inserter(warnings));
    std::ranges::copy(mission.notes, std::back_inserter(warnings));
    for (const auto& warning : warnings) warn(call, fmt::format("{}: {}", mission.name, warning));
}

mission::MissionVariant MissionNames::made_unique(const StageCall& call, mission::MissionVariant mission) {
    auto& setup = std::visit(
        [](auto& kind) -> auto& { return kind.setup; }, mission);
    const auto stated = setup.name;
    const auto file = std::filesystem::path(setup.file).stem().string();
    for (int use = 1; !used_.insert(setup.name).second; ++use)
        setup.name = use == 1 ? fmt::format("{} ({})", stated, file) : fmt::format("{} ({} {})", stated, file, use);
    if (setup.name != stated)
        note(call, fmt::format("{}: another mission is named '{}' too; this one is shown as '{}'", setup.file, stated,
                               setup.name));
    return mission;
}

void note_power_model(const StageCall& call, const mission::MissionSetup& mission) {
    if (mission.power_model) note(call, fmt::format("{}: {}", mission.name, mission::describe(*mission.power_model)));
}

std::vector<RankedMission> ranked_missions(const std::vector<mission::MissionSummary>& ranked) {
    std::vector<RankedMission> missions;
    missions.reserve(ranked.size());
    for (const auto& summary : ranked) missions.push_back({missions.size() + 1, summary});
    return missions;
}

}  // namespace flightwatt::cli
