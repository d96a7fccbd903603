#include "cli/output/replay_output.h"

#include "base/duration_text.h"
#include "cli/output/mission_output.h"
#include "cli/output/records.h"
#include "cli/stage.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

using mission::ComparisonOutcome;
using mission::Replay;
using mission::ReplayedSchedule;
using mission::ScheduleMethod;
using Replays = std::span<const Replay>;

constexpr std::array baselines{ScheduleMethod::planned, ScheduleMethod::planned_with_margin};

double total_s(const mission::PerPhase<double>& duration_s) {
    return std::accumulate(duration_s.values.begin(), duration_s.values.end(), 0.0);
}

std::string model_text(const Replay& replay) {
    switch (replay.model_saw_flight) {
        case mission::TrainingOverlap::yes:
            return fmt::format("{}, which saw this flight", replay.model);
        case mission::TrainingOverlap::unknown:
            return fmt::format("{}, which does not name its flights", replay.model);
        case mission::TrainingOverlap::no:
            break;
    }
    return fmt::format("{}, {} flight{}", replay.model, replay.model_flights.size(),
                       replay.model_flights.size() == 1 ? "" : "s");
}

std::optional<double> undeliverable_at_s(const ReplayedSchedule& replayed) {
    return replayed.summary.undeliverable ? std::optional(replayed.summary.undeliverable->time_s) : std::nullopt;
}

std::string how_it_ended(const ReplayedSchedule& replayed) {
    const auto& summary = replayed.summary;
    if (summary.undeliverable)
        return fmt::format("beyond power after {}", duration_text(summary.undeliverable->time_s));
    if (summary.depleted_at_s) return fmt::format("empty after {}", duration_text(*summary.depleted_at_s));
    if (summary.cut_off_at_s) return fmt::format("cut off after {}", duration_text(*summary.cut_off_at_s));
    return summary.keeps_reserve ? "kept" : "below";
}

/// The way, and whether no plan was found to keep the reserve with.
std::string way_text(const ReplayedSchedule& replayed) {
    const bool is_hopeless = replayed.summary.schedule == mission::ScheduleOrigin::infeasible;
    return mission::to_string(replayed.way) + (is_hopeless ? " (least energy)" : "");
}

std::vector<std::string> missions_of(Replays replays) {
    std::vector<std::string> names;
    for (const auto& replay : replays)
        if (std::ranges::find(names, replay.mission) == names.end()) names.push_back(replay.mission);
    return names;
}

std::string_view to_string(ComparisonOutcome verdict) {
    constexpr std::array<std::string_view, 3> names{"better", "tie", "worse"};
    return names.at(static_cast<std::size_t>(verdict));
}

std::string baseline_words(ScheduleMethod baseline) {
    return baseline == ScheduleMethod::planned ? "planning beforehand" : "planning beforehand with the policy's margin";
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
    const auto verdicts = [&](ComparisonOutcome verdict) {
        return std::ranges::count(comparisons, verdict, &mission::Comparison::verdict);
    };
    auto text = fmt::format(
        "{}: replanning in flight against {}, on {} flight{}: better on {}, a tie on {}, worse on {}. It keeps the "
        "reserve on {} of {}, the plan on {}; on average it has {:+.4g} of utility",
        mission, baseline_words(baseline), flights, flights == 1 ? "" : "s", verdicts(ComparisonOutcome::better),
        verdicts(ComparisonOutcome::tie), verdicts(ComparisonOutcome::worse),
        count(&mission::Comparison::replanned_keeps_reserve), flights,
        count(&mission::Comparison::baseline_keeps_reserve), utility / static_cast<double>(flights));
    if (charged > 0)
        text += fmt::format(" and leaves {:+.2f} points of charge", soc_percent / static_cast<double>(charged));
    return text + ".";
}

Json phases_json(const mission::PerPhase<double>& values) {
    Json json;
    for (const auto phase : mission::all_phases) json[std::string(flight::to_string(phase))] = values[phase];
    return json;
}

Json schedule_json(const ReplayedSchedule& replayed) {
    Json json{{"way", mission::to_string(replayed.way)}};
    auto summary = cli::to_json(replayed.summary);
    summary.erase("mission");
    json.update(summary);
    json["undeliverable_at_s"] = optional_json(undeliverable_at_s(replayed));
    json["expected_soc_percent"] = optional_json(replayed.expected_soc_percent);
    json["regret"] = optional_json(replayed.regret);
    return json;
}

Json known_bound(const Replay& replay) { return replay.bound_is_proven ? optional_json(replay.bound) : nullptr; }

Json replay_json(const Replay& replay) {
    constexpr std::array<std::string_view, 3> seen{"no", "yes", "unknown"};
    Json json{{"flight", replay.flight},
              {"mission", replay.mission},
              {"model", replay.model},
              {"model_flights", replay.model_flights},
              {"model_saw_flight", seen.at(static_cast<std::size_t>(replay.model_saw_flight))},
              {"planned_s", phases_json(replay.planned_s)},
              {"flown_s", phases_json(replay.flown_s)},
              {"expected_mechanical_wh", replay.expected_mechanical_wh},
              {"measured_mechanical_wh", replay.measured_mechanical_wh},
              {"counter_energy_wh", optional_json(replay.counter_energy_wh)},
              {"gaps", replay.gaps},
              {"longest_gap_s", replay.max_gap_s},
              {"bound", known_bound(replay)},
              {"notes", replay.notes}};
    json["schedules"] = list_json(replay.schedules, schedule_json);
    return json;
}

/// Of each schedule, with its flight and mission.
Json schedules_json(Replays replays) {
    auto records = Json::array();
    for (const auto& replay : replays) {
        for (const auto& replayed : replay.schedules) {
            auto record = schedule_json(replayed);
            record["flight"] = replay.flight;
            record["mission"] = replay.mission;
            record["bound"] = known_bound(replay);
            record["shown_way"] = way_text(replayed);
            record["end"] = how_it_ended(replayed);
            records.push_back(std::move(record));
        }
    }
    return records;
}

Json comparison_json(const std::string& mission, ScheduleMethod baseline,
                     const std::vector<mission::Comparison>& comparisons) {
    Json json{{"mission", mission},
              {"baseline", mission::to_string(baseline)},
              {"sentence", sentence(mission, baseline, comparisons)}};
    json["flights"] = list_json(comparisons, [](const auto& comparison) -> Json {
        return {{"flight", comparison.flight},
                {"verdict", to_string(comparison.outcome)},
                {"replanned_keeps_reserve", comparison.replanned_keeps_reserve},
                {"baseline_keeps_reserve", comparison.baseline_keeps_reserve},
                {"more_utility", comparison.more_utility},
                {"more_soc_percent", optional_json(comparison.more_soc_percent)}};
    });
    return json;
}

/// Of every mission with every way of planning beforehand that its flights have.
Json comparisons_json(Replays replays) {
    auto json = Json::array();
    for (const auto& name : missions_of(replays)) {
        for (const auto baseline : baselines) {
            const auto comparisons = compare_replanned(replays, name, baseline);
            if (!comparisons.empty()) json.push_back(comparison_json(name, baseline, comparisons));
        }
    }
    return json;
}

}  // namespace

TextTable replay_basis_table(Replays replays) {
    TextTable table{{"flight", "mission", "model", "planned s", "flown s", "expected Wh", "measured Wh", "counter Wh",
                     "gaps", "longest gap s", "bound"},
                    {}};
    for (const auto& replay : replays) {
        table.rows.push_back({replay.flight, replay.mission, model_text(replay), fixed(total_s(replay.planned_s), 0),
                              fixed(total_s(replay.flown_s), 0), fixed(replay.expected_mechanical_wh, 3),
                              fixed(replay.measured_mechanical_wh, 3), fixed(replay.counter_energy_wh, 3),
                              std::to_string(replay.gaps), fixed(replay.max_gap_s, 1),
                              fixed(replay.bound_is_proven ? replay.bound : std::nullopt, 4)});
    }
    return table;
}

TextTable replay_table(Replays replays) {
    return table_of(schedules_json(replays),
                    {"flight", "mission", "shown_way: schedule", "expected_soc_percent .2f: expected SoC %",
                     "final_soc_percent .2f: final SoC %", "reserve_soc_percent .2f: reserve %", "end: reserve",
                     "utility .4f", "regret .4f", "compute_energy_wh .3f: computing Wh"});
}

std::vector<std::string> replay_sentences(Replays replays) {
    std::vector<std::string> sentences;
    for (const auto& comparison : comparisons_json(replays)) sentences.push_back(comparison["sentence"]);
    return sentences;
}

std::string replay_remark() {
    return "The power is what the aircraft measured, autopilot and radios included; battery, computing power and its "
           "utility are the missions' own and were not aboard.";
}

std::string replay_text(Replays replays, const Screen& screen) {
    const ScreenTable results{"what came of each schedule",
                              {"flight", "mission", "schedule", "final SoC %", "utility", "reserve"}};
    auto text = screen_text(replay_basis_table(replays), screen, {"what the replays rest on", {}}) + "\n" +
                screen_text(replay_table(replays), screen, results) + "\n";
    for (const auto& sentence : replay_sentences(replays)) text += sentence + "\n";
    return text + replay_remark() + "\n";
}

std::string replay_csv(Replays replays) {
    constexpr int digits = 10;
    return csv_of(schedules_json(replays),
                  {"flight", "mission", "way: schedule", "reserve_soc_percent", "keeps_reserve", "expected_soc_percent",
                   "final_soc_percent", "utility", "regret", "bound", "depleted_at_s", "cut_off_at_s",
                   "undeliverable_at_s", "mechanical_energy_wh", "compute_energy_wh", "duration_s"},
                  digits);
}

Json to_json(const mission::Replays& replays) {
    Json json{{"replays", list_json(replays.replays, replay_json)}, {"comparisons", comparisons_json(replays.replays)}};
    json["not_replayed"] = list_json(replays.not_replayed, [](const auto& left) -> Json {
        return {{"flight", left.flight}, {"mission", left.mission}, {"reason", left.reason}};
    });
    return json;
}

}  // namespace flightwatt::cli
