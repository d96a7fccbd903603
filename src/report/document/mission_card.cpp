#include "report/document/mission_card.h"

#include "base/text.h"
#include "base/units.h"
#include "report/document/quality_of_service.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

using mission::ReachUnit;

/// The aim of a mission.
std::string describe_aim(double reserve_soc_percent) {
    return reserve_soc_percent > 0.0 ? fmt::format("keeps the reserve of {:.3g} %", reserve_soc_percent)
                                     : std::string("the battery lasts");
}

std::string before_end(const mission::MissionSummary& summary, double time_s) {
    return duration_text(summary.duration_s - time_s) + " before the end";
}

bool is_cut_off(const mission::MissionSummary& summary) {
    return summary.cut_off_at_s && *summary.cut_off_at_s <= summary.depleted_at_s.value_or(summary.duration_s);
}

std::string describe_end(const mission::MissionSummary& summary) {
    if (!summary.final_soc_percent) return "The battery cannot deliver the power";
    if (is_cut_off(summary)) return "Is cut off " + before_end(summary, *summary.cut_off_at_s);
    if (summary.depleted_at_s) return "Runs empty " + before_end(summary, *summary.depleted_at_s);
    return fmt::format("Lands with {:.1f} % of its charge", *summary.final_soc_percent);
}

std::string describe_landing(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    if (summary.uncertain.empty()) return describe_end(summary);
    return fmt::format("{}, but {}", describe_end(summary), fmt::join(summary.uncertain, "; "));
}

std::string outcome_words(Outcome outcome, const mission::MissionSummary& summary) {
    const bool has_reserve = summary.reserve_soc_percent > 0.0;
    switch (outcome) {
        case Outcome::keeps:
            return has_reserve ? "keeps reserve" : "lasts";
        case Outcome::is_uncertain:
            return "uncertain";
        case Outcome::may_miss:
            return has_reserve ? "may miss reserve" : "may run empty";
        case Outcome::misses:
            return "below reserve";
        case Outcome::fails:
            break;
    }
    if (!summary.final_soc_percent) return "lacks power";
    return is_cut_off(summary) ? "is cut off" : "runs empty";
}

/// "detection 10 fps, encryption 240 key bits"
std::string describe_run(const compute::ComputeModel& compute, const compute::Configuration& run) {
    std::vector<std::string> parts;
    for (const auto& running : run) {
        const auto& component = compute.components[running.component];
        auto part = component.name;
        for (std::size_t p = 0; p < running.qos.size(); ++p)
            part += fmt::format(" {:.4g} {}", running.qos[p], in_words(component.profile.parameters[p]));
        parts.push_back(std::move(part));
    }
    return parts.empty() ? "no software" : fmt::format("{}", fmt::join(parts, ", "));
}

/// "27 s", "2 min 3 s".
std::string whole_seconds(double time_s) {
    return time_s < units::seconds_per_minute ? fmt::format("{:.0f} s", time_s) : duration_text(time_s);
}

/// Its configurations, the longest first: two, and how many more.
std::string describe_software(const SimulatedMission& simulated) {
    const auto& mission = simulated.mission;
    std::vector<std::pair<double, std::string>> runs;
    for (const auto& segment : mission.schedule) {
        const auto text = describe_run(mission.setup.compute, segment.run);
        const auto same = std::ranges::find(runs, text, &std::pair<double, std::string>::second);
        (same == runs.end() ? runs.emplace_back(0.0, text) : *same).first += segment.end_s - segment.start_s;
    }
    std::ranges::stable_sort(runs, std::greater<>(), &std::pair<double, std::string>::first);
    std::string text = mission.setup.mechanical ? "" : "software alone: ";
    if (simulated.planned) text = "planned: ";
    if (simulated.simulation.summary.decisions) text = "planned again in flight: ";
    if (runs.empty()) return text + "no software";
    text += runs.front().second;
    if (runs.size() == 1) return mission.setup.compute.components.empty() ? text : text + ", all the time";
    text += fmt::format("; for {} {}", whole_seconds(std::round(runs[1].first)), runs[1].second);
    return runs.size() == 2 ? text : text + fmt::format("; and {} more", runs.size() - 2);
}

std::string describe_reach(const mission::Reach& reach) {
    if (reach.unit == ReachUnit::circles) return fmt::format("{:.0f} circles", reach.limit.value);
    if (reach.unit == ReachUnit::return_m) return fmt::format("{:.1f} km out and back", reach.limit.value / 1000.0);
    if (reach.unit == ReachUnit::path_times) return fmt::format("{:.2f} times", reach.limit.value);
    return duration_text(reach.limit.value);
}

std::string name_of_reach(const MissionAssessment& answer) {
    const auto unit = answer.reach ? answer.reach->unit : ReachUnit::cruise_s;
    const std::string name = unit == ReachUnit::circles      ? "Most circles"
                             : unit == ReachUnit::return_m   ? "Farthest return"
                             : unit == ReachUnit::path_times ? "The area is flown"
                                                             : "Longest cruise";
    return name + (answer.reach_at_95_percent ? " at 95 %" : ", as modelled");
}

double planned_cruise_s(const SimulatedMission& simulated) {
    return simulated.mission.setup.duration_s[flight::Phase::cruise];
}

/// Changes that keep the reserve, each sufficient on its own; of a mission that keeps it, the spare cruise.
std::string describe_help(const SimulatedMission& simulated, const MissionAssessment& answer, Outcome outcome) {
    const auto& reach = answer.reach_at_95_percent ? answer.reach_at_95_percent : answer.reach;
    const bool is_cruise = reach && reach->unit == ReachUnit::cruise_s;
    if (simulated.is_longest)
        return fmt::format(
            "The longest flight that {} {}", describe_aim(simulated.simulation.summary.reserve_soc_percent),
            answer.reach_at_95_percent ? "in 95 of 100 flights" : "as modelled: how flights differ is unknown");
    const double spare_s = is_cruise ? reach->limit.value - planned_cruise_s(simulated) : 0.0;
    if (outcome == Outcome::is_uncertain) return "";
    if (outcome == Outcome::keeps)
        return spare_s >= 1.0 ? whole_seconds(std::floor(spare_s)) + " of cruise to spare" : "";
    std::vector<std::string> ways;
    // A plan does not reach further than the minimum of software.
    if (simulated.planned && answer.reach_at_95_percent && (!is_cruise || spare_s >= 0.0))
        ways.emplace_back("plan it with --probability 0.95");
    if (is_cruise && spare_s < 0.0)
        ways.push_back(fmt::format("{} less cruise", whole_seconds(std::max(1.0, std::ceil(-spare_s)))));
    if (reach && !is_cruise) ways.push_back(fmt::format("{} at most", describe_reach(*reach)));
    constexpr double steps_per_ah = 10.0;
    if (answer.capacity_ah)
        ways.push_back(
            fmt::format("a pack of {:.1f} Ah", std::ceil(*answer.capacity_ah * steps_per_ah) / steps_per_ah));
    return capitalized(fmt::format("{}", fmt::join(ways, ", or ")));
}

std::vector<std::string> notes_of(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto& summary = simulated.simulation.summary;
    const auto& setup = simulated.mission.setup;
    std::vector<std::string> notes;
    for (const auto& note : setup.notes) notes.push_back("Warning: " + valid_utf8(note));
    if (auto warning = capacity_warning(setup.battery); !warning.empty())
        notes.push_back("Warning: " + warning + (summary.by_flights ? "; " + describe(*summary.by_flights, 1) : ""));
    if (known_probability_below_reserve(summary)) {
        constexpr double exact = 0.05;
        const auto& missed = summary.samples->probability_below_reserve_95;
        if (missed.high - missed.low > exact)
            notes.push_back(fmt::format("The number of flights of the model allows probabilities from {} to {}",
                                        probability_text(1.0 - missed.high), probability_text(1.0 - missed.low)));
    }
    if (!answer.no_reach_reason.empty()) notes.push_back("No longest cruise: " + answer.no_reach_reason);
    if (answer.is_unplanned) notes.emplace_back("The longest cruise is that with the least software");
    if (simulated.planned && !simulated.planned->feasible)
        notes.emplace_back("No schedule that keeps the reserve was found: this one needs the least energy");
    if (summary.lines)
        notes.push_back(
            fmt::format("Chosen: {}, {:.3g} times seen", mission::describe(*summary.lines), *summary.coverage));
    if (summary.utility) {
        notes.push_back(fmt::format("Utility {:.4g}", *summary.utility));
        if (simulated.planned && simulated.planned->feasible)
            notes.back() += fmt::format(", of at most {:.4g} for any schedule", simulated.planned->bound);
    }
    if (setup.power_model) notes.push_back(capitalized(mission::describe(*setup.power_model)));
    return notes;
}

}  // namespace

std::string capitalized(std::string text) {
    if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string probability_text(double probability) {
    constexpr double margin = 0.005;
    if (probability < margin) return "under 1 %";
    if (probability > 1.0 - margin) return "over 99 %";
    // Halves upwards, as the page rounds: many are of 200 flights.
    return fmt::format("{:.0f} %", std::round(units::percentage(probability, 1.0)));
}

MissionCard mission_card(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto& summary = simulated.simulation.summary;
    const auto outcome = outcome_of(simulated);
    const auto& reach = answer.reach_at_95_percent ? answer.reach_at_95_percent : answer.reach;
    const bool is_cruise = reach && reach->unit == ReachUnit::cruise_s;
    const double landing = summary.final_soc_percent.value_or(0.0);
    const auto below = known_probability_below_reserve(summary);
    return {outcome,
            {{"words", outcome_words(outcome, summary)},
             {"lead", describe_landing(simulated)},
             {"runs", valid_utf8(describe_software(simulated))},
             {"landing", landing > 0.0 ? fmt::format("{:.1f} %", landing) : "0 %"},
             {"aim", describe_aim(summary.reserve_soc_percent)},
             {"probability", below ? probability_text(1.0 - *below) : "unknown"},
             {"reach_name", name_of_reach(answer)},
             {"reach", reach ? describe_reach(*reach) : ""},
             {"planned", is_cruise ? duration_text(planned_cruise_s(simulated)) : ""},
             {"help", describe_help(simulated, answer, outcome)},
             {"better", ""},
             {"notes", notes_of(simulated, answer)}}};
}

}  // namespace flightwatt::report
