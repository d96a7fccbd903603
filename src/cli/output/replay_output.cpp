#include "cli/output/replay_output.h"

#include "cli/output/mission_output.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

using mission::ComparisonOutcome;
using mission::Replay;
using mission::ReplayedSchedule;
using mission::ScheduleMethod;
using Replays = std::span<const Replay>;

/// Replanning in flight compared with a plan, on all flights of a mission.
struct BaselineComparison {
    std::string mission;
    ScheduleMethod baseline = ScheduleMethod::planned;
    std::string sentence;
    std::vector<mission::Comparison> flights;
};

/// A schedule on a flight.
struct ScheduleOutput {
    const Replay* replay = nullptr;
    const ReplayedSchedule* replayed = nullptr;
};

constexpr std::array baselines{ScheduleMethod::planned, ScheduleMethod::planned_with_margin};

/// Values by phase: "takeoff", "cruise", "landing".
Keyed<double> by_phase(const mission::PerPhase<double>& values) {
    Keyed<double> all;
    for (const auto phase : flight::all_phases) all.emplace_back(std::string(to_string(phase)), values[phase]);
    return all;
}

double total_s(const mission::PerPhase<double>& duration_s) {
    return std::accumulate(duration_s.values.begin(), duration_s.values.end(), 0.0);
}

/// The flight is part of the model's fit.
std::string overlap_text(const Replay& replay) {
    constexpr std::array<const char*, 3> names{"no", "yes", "unknown"};
    return names.at(static_cast<std::size_t>(replay.model_saw_flight));
}

std::optional<double> undeliverable_at_s(const ReplayedSchedule& replayed) {
    return replayed.summary.undeliverable ? std::optional(replayed.summary.undeliverable->time_s) : std::nullopt;
}

std::vector<std::string> missions_of(Replays replays) {
    std::vector<std::string> names;
    for (const auto& replay : replays)
        if (std::ranges::find(names, replay.mission) == names.end()) names.push_back(replay.mission);
    return names;
}

std::string outcome_name(ComparisonOutcome outcome) {
    constexpr std::array names{"better", "tie", "worse"};
    return names.at(static_cast<std::size_t>(outcome));
}

std::string sentence(const std::string& mission, ScheduleMethod baseline,
                     const std::vector<mission::Comparison>& comparisons) {
    const auto count = [&](auto member, const auto& value) { return std::ranges::count(comparisons, value, member); };
    using C = mission::Comparison;
    return fmt::format(
        "{}: replanning in flight against {}: better on {} of {}, a tie on {}, worse on {}; it keeps the reserve on "
        "{}, the plan on {}.",
        mission, baseline == ScheduleMethod::planned ? "planning before the flight" : "planning with the margin",
        count(&C::outcome, ComparisonOutcome::better), comparisons.size(), count(&C::outcome, ComparisonOutcome::tie),
        count(&C::outcome, ComparisonOutcome::worse), count(&C::replanned_keeps_reserve, true),
        count(&C::baseline_keeps_reserve, true));
}

std::vector<BaselineComparison> comparisons_of(Replays replays) {
    std::vector<BaselineComparison> all;
    for (const auto& name : missions_of(replays)) {
        for (const auto baseline : baselines) {
            auto flights = compare_replanned(replays, name, baseline);
            if (flights.empty()) continue;
            auto text = sentence(name, baseline, flights);
            all.push_back({name, baseline, std::move(text), std::move(flights)});
        }
    }
    return all;
}

std::vector<ScheduleOutput> schedules_of(const Replay& replay) {
    std::vector<ScheduleOutput> all;
    for (const auto& replayed : replay.schedules) all.push_back({&replay, &replayed});
    return all;
}

std::optional<double> proven_bound(const Replay& replay) {
    return replay.bound_is_proven ? replay.bound : std::nullopt;
}

Fields<BaselineComparison> record_fields(const BaselineComparison*) {
    using R = BaselineComparison;
    return {field("mission", &R::mission, "name of the mission"),
            field("baseline", &R::baseline, "the plan that replanning in flight is compared with"),
            field("sentence", &R::sentence, "result in words"), field("flights", &R::flights, "results by flight")};
}

Fields<ScheduleOutput> record_fields(const ScheduleOutput*) {
    using R = ScheduleOutput;
    using S = ReplayedSchedule;
    auto summary = embedded(at(&R::replayed, [](const S& replayed) { return &replayed.summary; }), {"mission"});
    const std::set<std::string> shown{"final_soc_percent", "reserve_soc_percent", "utility",
                                      "compute_energy_wh", "depleted_at_s",       "cut_off_at_s"};
    for (auto& field : summary)
        if (!shown.contains(field.key)) field.table_column.reset();
    return list_fields<R>(
        field("flight", at(&R::replay, &Replay::flight), "name of the flight", column{}, csv_column{}, not_in_json{}),
        field("mission", at(&R::replay, &Replay::mission), "of the mission", column{}, csv_column{}, not_in_json{}),
        field("method", at(&R::replayed, &S::way), "`given`, `invariant` ... `hindsight`", column{"schedule"},
              csv_column{}),
        field("expected_soc_percent", at(&R::replayed, &S::expected_soc_percent), "at the end, as expected before",
              column{"expected [%]", ".2f"}, csv_column{}),
        std::move(summary),
        field("kept", at(&R::replayed, &S::summary, &mission::MissionSummary::keeps_reserve), "",
              column{"reserve kept"}, not_in_json{}),
        field("regret", at(&R::replayed, &S::regret), "utility less than hindsight's; null: without reserve or utility",
              column{"", ".4f"}, csv_column{}),
        field("bound", at(&R::replay, proven_bound), "as of `replays[]`", csv_column{}, not_in_json{}),
        field("undeliverable_at_s", at(&R::replayed, undeliverable_at_s), "time of the failure; null: never",
              column_if_any("beyond power at [s]"), csv_column{}));
}

std::vector<ScheduleOutput> all_schedules(Replays replays) {
    std::vector<ScheduleOutput> all;
    for (const auto& replay : replays) std::ranges::move(schedules_of(replay), std::back_inserter(all));
    return all;
}

}  // namespace

TextTable replay_basis_table(Replays replays) {
    return flightwatt::table_of(std::vector<Replay>(replays.begin(), replays.end()));
}

TextTable replay_table(Replays replays) { return flightwatt::table_of(all_schedules(replays)); }

std::vector<std::string> replay_sentences(Replays replays) {
    std::vector<std::string> sentences;
    for (auto& comparison : comparisons_of(replays)) sentences.push_back(std::move(comparison.sentence));
    return sentences;
}

std::string replay_remark() {
    return "The power is what the aircraft measured, autopilot and radios included; battery, computing power and its "
           "utility are the missions' own and were not aboard.";
}

std::string replay_text(Replays replays, const Screen& screen) {
    const ScreenTable results{
        "results of the schedules",
        {"flight", "mission", "schedule", "final state of charge [%]", "utility", "reserve kept"}};
    auto text = screen_text(replay_basis_table(replays), screen, {"data of the replays", {}}) + "\n" +
                screen_text(replay_table(replays), screen, results) + "\n";
    for (const auto& sentence : replay_sentences(replays)) text += sentence + "\n";
    return text + replay_remark() + "\n";
}

std::string replay_csv(Replays replays) {
    constexpr int digits = 10;
    return csv_of(all_schedules(replays), digits);
}

}  // namespace flightwatt::cli

namespace flightwatt::mission {

Fields<Comparison> record_fields(const Comparison*) {
    using R = Comparison;
    return {field("flight", &R::flight, "name of the flight"),
            field("outcome", at(&R::outcome, cli::outcome_name), "of replanning: `better`, `tie` or `worse`"),
            field("replanned_keeps_reserve", &R::replanned_keeps_reserve, "replanning keeps the reserve"),
            field("baseline_keeps_reserve", &R::baseline_keeps_reserve, "the baseline keeps the reserve"),
            field("more_utility", &R::more_utility, "replanned less baseline"),
            field("more_soc_percent", &R::more_soc_percent, "the same of the remaining charge")};
}

Fields<SkippedReplay> record_fields(const SkippedReplay*) {
    using R = SkippedReplay;
    return {field("flight", &R::flight, "name of the flight"), field("mission", &R::mission, "name of the mission"),
            field("reason", &R::reason, "why the mission was not simulated on the flight")};
}

Fields<Replay> record_fields(const Replay*) {
    using R = Replay;
    return {field("flight", &R::flight, "name of the flight", column{}),
            field("mission", &R::mission, "name of the mission", column{}),
            field("model", &R::model, "name of the model", column{}),
            field("model_flights", &R::model_flights, "flights of the model's fit"),
            field("training_overlap", cli::overlap_text, "the flight is part of the fit: `no`, `yes` or `unknown`",
                  column{"fitted to it"}),
            field("planned_s", at(&R::planned_s, cli::by_phase), "planned durations"),
            field("flown_s", at(&R::flown_s, cli::by_phase), "measured durations"),
            field("planned_total_s", at(&R::planned_s, cli::total_s), "their sum", column{"planned s", ".0f"},
                  not_in_json{}),
            field("flown_total_s", at(&R::flown_s, cli::total_s), "their sum", column{"flown s", ".0f"}, not_in_json{}),
            field("expected_mechanical_wh", &R::expected_mechanical_wh, "by the model, over the planned durations",
                  column{"expected Wh"}),
            field("measured_mechanical_wh", &R::measured_mechanical_wh, "measured in the phases of the mission",
                  column{"measured Wh"}),
            field("counter_energy_wh", &R::counter_energy_wh, "by the autopilot's counter", column{"counter Wh"}),
            field("gaps", &R::gaps, "gaps in the measured power", column{}),
            field("longest_gap_s", &R::max_gap_s, "the longest of them", column{"longest gap s"}),
            field("bound", cli::proven_bound, "no schedule has a greater utility", column{"", ".4f"}),
            field("notes", &R::notes, "adjustments of mission or flight"),
            field("schedules", cli::schedules_of, "results by schedule")};
}

Fields<mission::Replays> record_fields(const mission::Replays*) {
    using R = mission::Replays;
    return {field("replays", &R::replays, "each mission on each flight"),
            field("comparisons", at(&R::replays, cli::comparisons_of), "replanning in flight compared with plans"),
            field("not_replayed", &R::not_replayed, "missions that were not simulated")};
}

}  // namespace flightwatt::mission
