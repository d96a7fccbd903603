#include "cli/output/replay_output.h"

#include "base/duration_text.h"
#include "cli/output/mission_output.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <optional>
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

double total_s(const mission::PerPhase<double>& duration_s) {
    return std::accumulate(duration_s.values.begin(), duration_s.values.end(), 0.0);
}

std::string model_text(const Replay& replay) {
    switch (replay.model_saw_flight) {
        case mission::TrainingOverlap::yes:
            return fmt::format("{}, fitted to this flight too", replay.model);
        case mission::TrainingOverlap::unknown:
            return fmt::format("{}, flights unknown", replay.model);
        case mission::TrainingOverlap::no:
            break;
    }
    return fmt::format("{}, {} flight{}", replay.model, replay.model_flights.size(),
                       replay.model_flights.size() == 1 ? "" : "s");
}

std::optional<double> undeliverable_at_s(const ReplayedSchedule& replayed) {
    return replayed.summary.undeliverable ? std::optional(replayed.summary.undeliverable->time_s) : std::nullopt;
}

std::string end_text(const ReplayedSchedule& replayed) {
    const auto& summary = replayed.summary;
    if (summary.undeliverable)
        return fmt::format("beyond power after {}", duration_text(summary.undeliverable->time_s));
    if (summary.depleted_at_s) return fmt::format("empty after {}", duration_text(*summary.depleted_at_s));
    if (summary.cut_off_at_s) return fmt::format("cut off after {}", duration_text(*summary.cut_off_at_s));
    return summary.keeps_reserve ? "kept" : "below";
}

/// The method, and whether no plan keeps the reserve.
std::string method_text(const ReplayedSchedule& replayed) {
    const bool is_hopeless = replayed.summary.schedule == mission::ScheduleOrigin::infeasible;
    return mission::to_string(replayed.way) + (is_hopeless ? " (least energy)" : "");
}

std::vector<std::string> missions_of(Replays replays) {
    std::vector<std::string> names;
    for (const auto& replay : replays)
        if (std::ranges::find(names, replay.mission) == names.end()) names.push_back(replay.mission);
    return names;
}

std::string_view outcome_name(ComparisonOutcome outcome) {
    constexpr std::array<std::string_view, 3> names{"better", "tie", "worse"};
    return names.at(static_cast<std::size_t>(outcome));
}

std::string baseline_words(ScheduleMethod baseline) {
    return baseline == ScheduleMethod::planned ? "planning before the flight" : "planning with the policy's margin";
}

std::string sentence(const std::string& mission, ScheduleMethod baseline,
                     const std::vector<mission::Comparison>& comparisons) {
    const auto flights = comparisons.size();
    const auto count = [&](bool mission::Comparison::*keeps) {
        return std::ranges::count_if(comparisons, [&](const auto& comparison) { return comparison.*keeps; });
    };
    double utility = 0.0;
    double soc_percent = 0.0;
    std::size_t charged = 0;
    for (const auto& comparison : comparisons) {
        utility += comparison.more_utility;
        if (!comparison.more_soc_percent) continue;
        soc_percent += *comparison.more_soc_percent;
        ++charged;
    }
    const auto count_of = [&](ComparisonOutcome outcome) {
        return std::ranges::count(comparisons, outcome, &mission::Comparison::outcome);
    };
    auto text = fmt::format(
        "{}: replanning in flight against {}, on {} flight{}: better on {}, a tie on {}, worse on {}. It keeps the "
        "reserve on {} of {}, the plan on {}; on average it has {:+.4g} of utility",
        mission, baseline_words(baseline), flights, flights == 1 ? "" : "s", count_of(ComparisonOutcome::better),
        count_of(ComparisonOutcome::tie), count_of(ComparisonOutcome::worse),
        count(&mission::Comparison::replanned_keeps_reserve), flights,
        count(&mission::Comparison::baseline_keeps_reserve), utility / static_cast<double>(flights));
    if (charged > 0)
        text += fmt::format(" and leaves {:+.2f} points of charge", soc_percent / static_cast<double>(charged));
    return text + ".";
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
    for (auto& field : summary)
        if (field.key != "final_soc_percent" && field.key != "reserve_soc_percent" && field.key != "utility" &&
            field.key != "compute_energy_wh")
            field.table_column.reset();
    return list_fields<R>(
        field("flight", at(&R::replay, &Replay::flight), "name of the flight", column{}, csv_column{}, not_in_json{}),
        field("mission", at(&R::replay, &Replay::mission), "of the mission", column{}, csv_column{}, not_in_json{}),
        field("method", at(&R::replayed, &S::way), "`given`, `invariant` ... `hindsight`", csv_column{}),
        field("shown_method", at(&R::replayed, method_text), "", column{"schedule"}, not_in_json{}),
        field("expected_soc_percent", at(&R::replayed, &S::expected_soc_percent), "at the end, as expected before",
              column{"expected [%]", ".2f"}, csv_column{}),
        std::move(summary), field("end", at(&R::replayed, end_text), "", column{"reserve"}, not_in_json{}),
        field("regret", at(&R::replayed, &S::regret), "utility less than hindsight's; null: without reserve or utility",
              column{"", ".4f"}, csv_column{}),
        field("bound", at(&R::replay, proven_bound), "as of `replays[]`", csv_column{}, not_in_json{}),
        field("undeliverable_at_s", at(&R::replayed, undeliverable_at_s), "time of the failure; null: never",
              csv_column{}));
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
    const ScreenTable results{"results of the schedules",
                              {"flight", "mission", "schedule", "final state of charge [%]", "utility", "reserve"}};
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
            field(
                "outcome", [](const R& r) { return std::string(cli::outcome_name(r.outcome)); },
                "of replanning: `better`, `tie` or `worse`"),
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
    const auto overlap = [](const R& replay) {
        constexpr std::array<const char*, 3> names{"no", "yes", "unknown"};
        return std::string(names.at(static_cast<std::size_t>(replay.model_saw_flight)));
    };
    return {
        field("flight", &R::flight, "name of the flight", column{}),
        field("mission", &R::mission, "name of the mission", column{}),
        field("model", &R::model, "name of the model"),
        field(
            "model_text", [](const R& r) { return cli::model_text(r); }, "the model", column{"model"}, not_in_json{}),
        field("model_flights", &R::model_flights, "flights of the model's fit"),
        field("training_overlap", overlap, "the flight is part of the fit: `no`, `yes` or `unknown`"),
        field("planned_s", at(&R::planned_s, cli::by_phase<PerPhase<double>>), "planned durations"),
        field("flown_s", at(&R::flown_s, cli::by_phase<PerPhase<double>>), "measured durations"),
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
        field(
            "bound", [](const R& replay) { return cli::proven_bound(replay); }, "no schedule has a greater utility",
            column{"", ".4f"}),
        field("notes", &R::notes, "adjustments of mission or flight"),
        field(
            "schedules", [](const R& replay) { return cli::schedules_of(replay); }, "results by schedule")};
}

Fields<mission::Replays> record_fields(const mission::Replays*) {
    using R = mission::Replays;
    return {field("replays", &R::replays, "each mission on each flight"),
            field(
                "comparisons", [](const R& r) { return cli::comparisons_of(r.replays); },
                "replanning in flight compared with plans"),
            field("not_replayed", &R::not_replayed, "missions that were not simulated")};
}

}  // namespace flightwatt::mission
