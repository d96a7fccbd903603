#include "cli/output/answer_output.h"

#include "base/text.h"
#include "base/units.h"
#include "cli/output/pack_output.h"
#include "cli/output/physical_output.h"
#include "cli/stage.h"
#include "cli/terminal.h"

#include <cmath>
#include <set>
#include <tuple>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::answer {

Fields<Answered> record_fields(const Answered*) {
    using R = Answered;
    return {field("value", &R::value, "in the unit of the key; null: unknown"),
            field("basis", &R::basis, "what it rests on: measured, physics, assumed"),
            field("unknown", &R::unknown, "why there is no value, and what would give one")};
}

Fields<VoltageThreshold> record_fields(const VoltageThreshold*) {
    using R = VoltageThreshold;
    return {
        field("voltage_v", &R::voltage_v, "of the pack under cruise current, rounded up"),
        field("probability_too_late", &R::too_late, "null: unknown"),
        field("probability_too_early", &R::too_early, "10 points of charge or more before the count; null: unknown")};
}

Fields<FailsafeAction> record_fields(const FailsafeAction*) {
    using R = FailsafeAction;
    return {field("soc_percent", &R::soc_percent, "charge at which it acts, rounded up"),
            field("used_mah", &R::used_mah, "charge used since the full pack"),
            field("remaining_mah", &R::remaining_mah, "capacity less that, rounded up"),
            field("current_a", &R::current_a, "in cruise, at this charge"),
            field("probability_too_late", &R::too_late, "of the count of charge; null: unknown"),
            field("probability_too_late_interval_95", &R::too_late_95, "in new flights"),
            field("voltage", &R::voltage, "at this charge; null: constant voltage"),
            field("voltage_alone", &R::voltage_alone, "early enough with the probability, without a count of charge")};
}

Fields<GroundedPart> record_fields(const GroundedPart*) {
    using R = GroundedPart;
    return {field("ground", &R::ground, "measured, physics or assumption"), field("text", &R::text, "the part")};
}

Fields<FailsafeCard> record_fields(const FailsafeCard*) {
    using R = FailsafeCard;
    return {field("capacity_mah", &R::capacity_mah, "of the pack"),
            field("reserve_percent", &R::reserve_percent, "to be left at landing"),
            field("probability", &R::probability, "with which an action is early enough"),
            field("probability_is_known", &R::chances_known, "false: nothing shows how the power of flights differs"),
            field("home_distance_m", &R::home_distance_m, "farthest place; null: unknown"),
            field("home_duration_s", &R::home_duration_s, "of the way home, as planned"),
            field("low", &R::low, "return in time; null: no value"),
            field("low_missing", &R::low_missing, "why there is no value; empty: there is"),
            field("critical", &R::critical, "land at once, and keep half of the reserve"),
            field("probability_landed_short", &R::lands_short, "that the critical action ends a return; null: unknown"),
            field("empty_voltage_v", &R::empty_voltage_v, "of the empty pack under cruise current"),
            field("rests_on", &R::grounds, "what the values rest on")};
}

}  // namespace flightwatt::answer

namespace flightwatt::cli {
namespace {

using answer::Answered;
using answer::Endurance;
using answer::PackAnswer;

constexpr double mohm_per_ohm = 1000.0;
constexpr double m_per_km = 1000.0;

/// "9 min 10 s", in whole seconds.
std::string time_text(double time_s) { return duration_text(std::round(time_s)); }

std::string speed_text(double m_per_s) { return fmt::format("{:.1f} m/s", m_per_s); }

std::string counted(std::size_t count, const char* of) {
    return fmt::format("{} {}{}", count, of, count == 1 ? "" : "s");
}

std::string power_line(const Endurance& endurance) {
    if (!endurance.power_w.value) return "unknown: " + endurance.power_w.unknown;
    auto text = fmt::format("{:.0f} W", *endurance.power_w.value);
    if (endurance.airspeed_m_per_s.value && !endurance.is_hover)
        text += " at " + speed_text(*endurance.airspeed_m_per_s.value);
    return fmt::format("{} ({})", text, endurance.power_w.basis);
}

/// Whether the pack is colder than in every flight, so that it holds less than is assumed.
bool is_colder_than_flown(const PackAnswer& pack) {
    const auto& flown_c = pack.battery_start_c ? pack.battery_start_c : pack.air_temperature_c;
    return pack.asked_temperature_c && flown_c && *pack.asked_temperature_c < flown_c->low;
}

std::string time_line(const AircraftAnswer& answer) {
    const auto& [time_s, time_95_s] = std::tie(answer.endurance.time_s, answer.endurance.time_95_s);
    if (!time_s.value) return "unknown: " + time_s.unknown;
    auto text = fmt::format("{}{} from a full pack of {:.3g} Ah to {:g} %",
                            is_colder_than_flown(answer.pack) ? "at most " : "", time_text(*time_s.value),
                            answer.pack.capacity_ah.value.value_or(0.0), answer.question.reserve_soc_percent);
    text += time_95_s.value ? fmt::format("; {} in 95 of 100 flights", time_text(*time_95_s.value))
                            : "; in 95 of 100 flights unknown: " + time_95_s.unknown;
    if (const auto down_to = answer.pack.known_down_to_percent;
        down_to && *down_to > answer.question.reserve_soc_percent)
        text += fmt::format("; no flight went below {:.0f} %: the voltage there is assumed", *down_to);
    return text;
}

constexpr double right_angle_deg = 90.0;

/// " (70 and 250 degrees)": the courses at an angle to the wind; empty where its direction is not stated.
std::string courses_text(const answer::Question& question, double angle_deg) {
    if (!question.wind_from_deg) return "";
    constexpr double half_turn_deg = 2.0 * right_angle_deg;
    const double course_deg = std::fmod(*question.wind_from_deg + angle_deg + 2.0 * half_turn_deg, half_turn_deg);
    return fmt::format(" ({:.0f} and {:.0f} degrees)", course_deg, course_deg + half_turn_deg);
}

std::string distance_line(const AircraftAnswer& answer) {
    const auto& endurance = answer.endurance;
    if (!endurance.distance_m.value) return "unknown: " + endurance.distance_m.unknown;
    auto text = fmt::format("{:.1f} km in all, out and back", *endurance.distance_m.value / m_per_km);
    text += answer.question.wind_m_per_s > 0.0
                ? fmt::format(" along a wind of {}", speed_text(answer.question.wind_m_per_s))
                : std::string(" in calm air");
    if (endurance.distance_across_m) {
        text += courses_text(answer.question, 0.0);
        text += fmt::format("; {:.1f} km across it", *endurance.distance_across_m / m_per_km);
        text += courses_text(answer.question, right_angle_deg);
    }
    return fmt::format("{} ({})", text, endurance.distance_m.basis);
}

/// Empty where no speed is known.
std::string speeds_line(const Endurance& endurance) {
    std::vector<std::string> texts;
    for (const auto& best : endurance.best_speeds) {
        if (best.airspeed_m_per_s && !best.below_flown && !best.above_flown)
            texts.push_back(fmt::format("{} at {}", best.purpose, speed_text(*best.airspeed_m_per_s)));
        else
            texts.push_back(
                fmt::format("{} unknown: {} legs would show it", best.purpose, best.above_flown ? "faster" : "slower"));
    }
    return fmt::format("{}", fmt::join(texts, "; "));
}

std::string mohm_text(const Answered& ohm, const std::optional<Interval>& interval) {
    auto text = fmt::format("{:.3g} mOhm", ohm.value.value_or(0.0) * mohm_per_ohm);
    if (interval)
        text += fmt::format(" ({:.3g} to {:.3g})", interval->low * mohm_per_ohm, interval->high * mohm_per_ohm);
    return text;
}

/// "; at 21 to 29 degC of the battery at take-off (measured)", and the resistance at the temperature that is asked for.
std::string temperature_text(const PackAnswer& pack) {
    const auto& [battery_c, air_c] = std::tie(pack.battery_start_c, pack.air_temperature_c);
    auto text =
        battery_c ? fmt::format("; at {:.0f} to {:.0f} degC of the battery at take-off (measured)", battery_c->low,
                                battery_c->high)
        : air_c ? fmt::format("; in air of {:.0f} to {:.0f} degC, other temperatures unknown", air_c->low, air_c->high)
                : std::string("; temperature unknown: the logs state none");
    if (!pack.asked_temperature_c) return text;
    const auto& asked = pack.resistance_at_ohm;
    if (!asked.value) return text + "; " + asked.unknown;
    return text + fmt::format("; at {:g} degC {}, {}", *pack.asked_temperature_c,
                              mohm_text(asked, pack.resistance_at_interval_ohm), asked.basis);
}

std::string pack_line(const PackAnswer& pack) {
    std::string text = pack.capacity_ah.value
                           ? fmt::format("{:.3g} Ah {}", *pack.capacity_ah.value, pack.capacity_ah.basis)
                           : std::string("capacity unknown");
    if (const auto& flights = pack.flights_capacity_ah)
        text += fmt::format("; the flights indicate {:.3g} to {:.3g} Ah", flights->low, flights->high);
    if (!pack.resistance_ohm.value) return text + "; resistance unknown: " + pack.resistance_ohm.unknown;
    text += "; " + mohm_text(pack.resistance_ohm, pack.resistance_interval_ohm);
    return text + temperature_text(pack);
}

/// The health of each pack; empty where no flight shows one.
std::string health_line(const std::vector<answer::Pack>& packs) {
    std::vector<std::string> texts;
    texts.reserve(packs.size());
    for (const auto& pack : packs)
        texts.push_back(fmt::format("{}{}: {}", packs.size() > 1 ? pack.name + " " : "",
                                    to_string(pack.condition.health), pack.condition.reason));
    return fmt::format("{}", fmt::join(texts, "; "));
}

/// "return at 34 % or 2040 mAh left (too late in 5 of 100 flights), and at 22.10 V in cruise (alone too late in 42)".
std::string action_text(const char* name, const answer::FailsafeAction& action) {
    const auto late = [](double chance) {
        return fmt::format("too late in {:.3g}", units::percent_per_whole * chance);
    };
    auto text = fmt::format("{} at {} % or {} mAh left", name, action.soc_percent, action.remaining_mah);
    if (action.too_late) {
        text += fmt::format(" ({} of 100 flights", late(*action.too_late));
        if (const auto& in_new = action.too_late_95)
            text += fmt::format(", {:.1f} to {:.1f} in new ones", units::percent_per_whole * in_new->low,
                                units::percent_per_whole * in_new->high);
        text += ")";
    }
    if (!action.voltage) return text;
    text += fmt::format(", and at {:.2f} V in cruise", action.voltage->voltage_v);
    return text + (action.voltage->too_late ? fmt::format(" (alone {})", late(*action.voltage->too_late)) : "");
}

std::string failsafe_line(const AircraftAnswer& answer) {
    if (!answer.failsafe) return "unknown: " + answer.failsafe_missing;
    const auto& card = *answer.failsafe;
    const auto& [cruise, home] = std::tie(answer.endurance.airspeed_m_per_s, answer.endurance.return_airspeed_m_per_s);
    auto text = card.low ? fmt::format("{}, from {:.0f} m", action_text("return", *card.low), *card.home_distance_m)
                         : "return unknown: " + (home.value ? card.low_missing : home.unknown);
    if (card.low && home.value && home.basis != cruise.basis)
        text += fmt::format(" at {} ({})", speed_text(*home.value), home.basis);
    text += "; " + action_text("land", card.critical);
    if (!card.monitors.empty()) text += "; " + card.monitors;
    const auto& no_chance = answer.endurance.time_95_s.unknown;
    if (!card.chances_known)
        text +=
            "; chances unknown: " + (no_chance.empty() ? "two more flights would show how flights differ" : no_chance);
    return text;
}

std::string failsafe_command(const AircraftAnswer& answer) {
    if (!answer.failsafe) return "";
    const auto& card = *answer.failsafe;
    const std::string own = answer.name.starts_with("PX4")    ? "px4"
                            : answer.name.starts_with("INAV") ? "inav"
                                                              : "ardupilot";
    std::vector<std::string> others{"ardupilot", "px4", "inav", "paparazzi"};
    std::erase(others, own);
    // Of the mission, which has the payload and the reserve that were asked for.
    auto command = fmt::format("flightwatt export {} --format failsafe-{}",
                               shell_quoted(answer.folder + "/answer-mission.toml"), own);
    if (card.home_distance_m) command += fmt::format(" --home-distance {:.0f}", *card.home_distance_m);
    if (answer.question.wind_m_per_s > 0.0) command += fmt::format(" --wind {:g}", answer.question.wind_m_per_s);
    if (const auto& home = answer.endurance.return_airspeed_m_per_s; home.value)
        command += fmt::format(" --airspeed {:.2f}", *home.value);
    return fmt::format("; written by {} (or -{})", command, fmt::join(others, ", -"));
}

}  // namespace

Fields<AircraftAnswer> record_fields(const AircraftAnswer*) {
    using R = AircraftAnswer;
    using Q = answer::Question;
    // With what it rests on in JSON, and alone as a column.
    const auto answered = [](const std::string& key, const std::string& description, auto... path) {
        return Fields<R>{field(key, at(path...), description),
                         field("csv_" + key, at(path..., &Answered::value), "", csv_column{key}, not_in_json{})};
    };
    return list_fields<R>(
        field("aircraft", &R::aircraft, "a text for --aircraft", csv_column{}),
        field("aircraft_name", &R::name, "name in the logs", csv_column{}),
        field("folder", &R::folder, "folder of its model, pack, mission and page", csv_column{}),
        field("logs", &R::logs, "logs that were read", csv_column{}),
        field("flights_used", &R::used, "flights of the model", csv_column{}),
        field("no_answer", &R::no_answer, "why nothing is answered; empty if something is", csv_column{}),
        field("reserve_soc_percent", at(&R::question, &Q::reserve_soc_percent), "charge to land with", csv_column{}),
        field("payload_kg", at(&R::question, &Q::payload_kg), "payload; null: as flown", csv_column{}),
        field("wind_m_per_s", at(&R::question, &Q::wind_m_per_s), "steady wind", csv_column{}),
        field("wind_from_deg", at(&R::question, &Q::wind_from_deg), "null: not stated", csv_column{}),
        field("is_hover", at(&R::endurance, &Endurance::is_hover), "the power is that of hover", csv_column{}),
        answered("power_w", "mean of hover or cruise", &R::endurance, &Endurance::power_w),
        answered("time_in_air_s", "from a full pack to the reserve", &R::endurance, &Endurance::time_s),
        answered("time_in_air_95_s", "what 95 of 100 flights reach", &R::endurance, &Endurance::time_95_s),
        answered("airspeed_m_per_s", "of the cruise", &R::endurance, &Endurance::airspeed_m_per_s),
        answered("distance_m", "over ground, out and back along the wind", &R::endurance, &Endurance::distance_m),
        field("distance_across_m", at(&R::endurance, &Endurance::distance_across_m), "the same across it; null: calm"),
        field("return_airspeed_m_per_s", at(&R::endurance, &Endurance::return_airspeed_m_per_s),
              "of the failsafe's way home"),
        field("best_speeds", at(&R::endurance, &Endurance::best_speeds), "of endurance and range"),
        answered("capacity_ah", "of the pack", &R::pack, &PackAnswer::capacity_ah),
        field("flights_capacity_ah_interval_95", at(&R::pack, &PackAnswer::flights_capacity_ah), "by the flights"),
        field("voltage_known_down_to_percent", at(&R::pack, &PackAnswer::known_down_to_percent),
              "lowest charge of the flights, below which the voltage is assumed; null: no flight shows the voltage"),
        answered("resistance_ohm", "series resistance of the pack", &R::pack, &PackAnswer::resistance_ohm),
        field("resistance_ohm_interval_95", at(&R::pack, &PackAnswer::resistance_interval_ohm)),
        field("air_temperature_c_range", at(&R::pack, &PackAnswer::air_temperature_c), "means of the flights"),
        field("battery_temperature_c_range", at(&R::pack, &PackAnswer::battery_start_c), "of the flights' take-offs"),
        field("temperature_c", at(&R::pack, &PackAnswer::asked_temperature_c), "asked for; null: as flown",
              csv_column{}),
        field("resistance_at_temperature_ohm", at(&R::pack, &PackAnswer::resistance_at_ohm), "at that temperature"),
        field("resistance_at_temperature_ohm_interval_95", at(&R::pack, &PackAnswer::resistance_at_interval_ohm)),
        answered("prediction_error_percent", "of the energy of flights left out", &R::prediction_error_percent),
        field("packs", &R::packs, "the packs of the flights"),
        field("failsafe", &R::failsafe, "values for an autopilot; null: unknown"),
        field("failsafe_missing", &R::failsafe_missing, "the reason why they are absent"),
        field("requirement_missed", &R::requirement_missed, "why --require is missed; empty: it is not"),
        field("notes", at(&R::endurance, &Endurance::notes), "limits of these answers"),
        field("page", &R::page, "file of the report; empty without one"));
}

std::string aircraft_line(const AircraftAnswer& answer) {
    const auto name = answer.name.empty() || answer.name == answer.aircraft ? "" : fmt::format(" ({})", answer.name);
    return fmt::format("{}{}: {} used of {}", answer.aircraft, name, counted(answer.used, "flight"),
                       counted(answer.logs, "log"));
}

std::vector<AnswerLine> answer_lines(const AircraftAnswer& answer) {
    if (const auto& why = answer.no_answer; !why.empty()) {
        const auto* subject = why.starts_with("has ") ? "the log " : why.starts_with("is ") ? "the file " : "";
        return {{"No answer", subject + why, ""}};  // messages begin with the file
    }
    std::vector<AnswerLine> lines;
    std::set<std::string> given;
    const auto add = [&](const std::string& label, const std::string& text, const std::string& on_terminal = "") {
        if (text.empty()) return;
        const bool is_repeated = !given.insert(text).second;  // a reason why nothing is known
        lines.push_back({label, is_repeated ? "unknown, for the same reason" : text, on_terminal});
    };
    add(answer.endurance.is_hover ? "Hover" : "Cruise", power_line(answer.endurance));
    add("Time", time_line(answer));
    add("Distance", distance_line(answer));
    add("Speeds", speeds_line(answer.endurance));
    add("Pack", pack_line(answer.pack));
    add("Health", health_line(answer.packs));
    add("Failsafe", failsafe_line(answer), failsafe_command(answer));
    const auto& error = answer.prediction_error_percent;
    add("Checked", error.value ? fmt::format("flights like these take the predicted energy within {:.1f} % ({})",
                                             *error.value, error.basis)
                               : "unknown: " + error.unknown);
    add("Limits", fmt::format("{}", fmt::join(answer.endurance.notes, "; ")));
    return lines;
}

std::string lines_text(const std::vector<AnswerLine>& lines, std::size_t columns) {
    constexpr std::size_t label_width = 10;
    std::string text;
    for (const auto& line : lines) {
        auto wrapped_text = wrapped(line.text + line.on_terminal, columns - label_width, "");
        boost::algorithm::replace_all(wrapped_text, "\n", "\n" + std::string(label_width, ' '));
        text += fmt::format("{:<{}}{}\n", line.label, label_width, wrapped_text);
    }
    return text;
}

std::string answer_text(const AircraftAnswer& answer, std::size_t columns) {
    auto lines = answer_lines(answer);
    if (!answer.page.empty()) lines.push_back({"Page", answer.page, ""});
    return wrapped(aircraft_line(answer), columns) + "\n" + lines_text(lines, columns);
}

}  // namespace flightwatt::cli
