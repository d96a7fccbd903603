#include "cli/output/watch_output.h"

#include "base/units.h"
#include "cli/output/mission_output.h"
#include "cli/output/prediction_output.h"
#include "record/json_type.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::live {

Fields<LiveAlarm> record_fields(const LiveAlarm*) {
    return {field("kind", &LiveAlarm::kind, "`reserve`, `model`, `silence` or `voltage`"),
            field("grade", &LiveAlarm::grade, "`caution` or `alarm`"), field("text", &LiveAlarm::text, "the finding"),
            field("action", &LiveAlarm::action, "recommended action, with the time left")};
}

Fields<ReturnDeadline> record_fields(const ReturnDeadline*) {
    using R = ReturnDeadline;
    return {
        field("latest_in_s", &R::latest_in_s, "time until then; null: too late"),
        field("path_can_be_flown", &R::path_can_be_flown, "the path or cruise to its end, and the landing from there")};
}

Fields<LiveBattery> record_fields(const LiveBattery*) {
    using R = LiveBattery;
    const auto initial = [](const R& battery) {
        return battery.soc_percent ? std::optional(battery.initial.soc_percent) : std::nullopt;
    };
    return {field("soc_percent", &R::soc_percent, "initial state of charge less the charge drawn"),
            field("soc_by_voltage_percent", &R::soc_by_voltage_percent, "by the battery model at this voltage"),
            field("initial_soc_percent", initial, "at the beginning"),
            field("initial_soc_sd_percent", at(&R::initial, &InitialCharge::sd_percent),
                  "its standard deviation; 0: not by the voltage at rest"),
            field("drawn_ah", &R::drawn_ah, "charge drawn since the beginning"),
            field("voltage_off_v", &R::voltage_residual_v, "measured less model, median of the last minute"),
            field("reserve_in_s", &R::time_to_reserve_s, "cruise time until the reserve is reached"),
            field("probability_below_reserve", &R::probability_below_reserve,
                  "of landing below the reserve, or not at all")};
}

}  // namespace flightwatt::live

namespace flightwatt::cli {
namespace {

std::string phase_text(const live::LiveState& state) {
    if (state.phase) return std::string(to_string(*state.phase));
    return state.landed ? "landed" : "ground";
}

/// A decision with the names of its components.
struct DecisionOutput {
    const live::LiveDecision* decision = nullptr;
    const compute::ComputeModel* compute = nullptr;
};

Fields<DecisionOutput> record_fields(const DecisionOutput*) {
    using R = DecisionOutput;
    using D = live::LiveDecision;
    const auto run = [](const R& r) { return run_values(r.decision->run, *r.compute); };
    const auto next = [](const R& r) {
        return r.decision->next ? std::optional(run_values(*r.decision->next, *r.compute)) : std::nullopt;
    };
    const auto next_in_s = [](const R& r) {
        return r.decision->next ? std::optional(r.decision->next_in_s) : std::nullopt;
    };
    return {
        field("run", run, "running components with their parameters"),
        field("utility_per_s", at(&R::decision, &D::utility_per_s), "of these"),
        field("next", next, "the configuration after it; null: no change"),
        field("next_in_s", next_in_s, "time until then"),
        field("remaining_utility_per_s", at(&R::decision, &D::remaining_utility_per_s), "mean to the mission's end"),
        field("keeps_reserve", at(&R::decision, &D::keeps_reserve), "replanned: some plan keeps the reserve"),
        field("final_soc_percent", at(&R::decision, &D::final_soc_percent), "replanned: at the mission's end"),
        field("changes", at(&R::decision, &D::changes), "changes of the configuration so far")};
}

std::string with_unit(const std::optional<double>& value, int decimals, const char* unit) {
    return value ? fmt::format("{:.{}f} {}", *value, decimals, unit) : fmt::format("- {}", unit);
}

/// "34.1 % and 10.92 V (30.2 % at the high end)"
std::string landing_line(const live::LiveState& state) {
    if (state.landed) return "";
    if (!state.prediction) return "no prediction: " + state.no_prediction_reason;
    const auto& prediction = *state.prediction;
    auto text = fmt::format("{:.2f} Wh {} ({:.2f} to {:.2f})", prediction.remaining_energy.energy_wh,
                            prediction.overtime_s ? "if it lands now" : "to the landing", prediction.interval.low,
                            prediction.interval.high);
    if (!prediction.battery) return text;
    const auto& expected = prediction.battery->expected;
    const auto& worst = prediction.battery->worst;
    if (expected.fails_after_s)
        return text + fmt::format(", the battery fails in {:.1f} min", *expected.fails_after_s / 60.0);
    text += fmt::format(", {:.1f} % and {:.2f} V there", expected.soc_percent, expected.voltage_v);
    return text + (worst.fails_after_s ? std::string(" (fails at the high end)")
                                       : fmt::format(" ({:.1f} % at the high end)", worst.soc_percent));
}

std::string reserve_line(const live::LiveState& state) {
    if (!state.battery || !state.battery->time_to_reserve_s) return "";
    auto text = fmt::format("reserve in {:.1f} min of cruise", *state.battery->time_to_reserve_s / 60.0);
    if (const auto& probability = state.battery->probability_below_reserve)
        text += fmt::format(", probability of landing below it {:.1f} %", units::percentage(*probability, 1.0));
    if (const auto& turn = state.turn_home) {
        const auto* way = state.prediction && !state.prediction->on_path_s ? "land" : "turn home";
        text += !turn->latest_in_s ? fmt::format(", too late to {} with it", way)
                                   : fmt::format(", {} within {:.1f} min{}", way, *turn->latest_in_s / 60.0,
                                                 turn->path_can_be_flown ? " or finish as planned" : "");
    }
    return text;
}

std::string schedule_line(const live::LiveState& state, const compute::ComputeModel& compute) {
    if (!state.decision) return "";
    const auto& decision = *state.decision;
    auto text = "runs " + describe(compute, decision.run, "=");
    if (decision.next)
        text += fmt::format(", in {:.0f} s {}", decision.next_in_s, describe(compute, *decision.next, "="));
    if (decision.remaining_utility_per_s)
        text += fmt::format("; utility {:.4g} per second to the end", *decision.remaining_utility_per_s);
    if (!decision.keeps_reserve) text += "; no plan keeps the reserve";
    return text;
}

std::string charge_text(const live::LiveState& state) {
    if (!state.battery) return "";
    return fmt::format("{} by charge, {} by voltage", with_unit(state.battery->soc_percent, 1, "%"),
                       with_unit(state.battery->soc_by_voltage_percent, 1, "%"));
}

constexpr auto replace_invalid = Json::error_handler_t::replace;

/// The JSON document of a record in one line.
template <Record R>
std::string json_line(const StageCall& call, const R& record) {
    return json_document(call, record_json(record)).dump(-1, ' ', false, replace_invalid) + "\n";
}

std::string without_numbers(std::string text) {
    std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
    return text;
}

}  // namespace

Fields<WatchState> record_fields(const WatchState*) {
    using R = WatchState;
    using S = live::LiveState;
    const auto of = [](const std::string& key, auto S::*member, const char* description = "") {
        return field(key, at(&R::state, member), description);
    };
    const auto reason = [](const R& r) {
        return r.state->prediction ? std::nullopt : std::optional(r.state->no_prediction_reason);
    };
    const auto decision = [](const R& r) {
        return r.state->decision ? std::optional(DecisionOutput{&*r.state->decision, r.compute}) : std::nullopt;
    };
    return {of("time_s", &S::time_s, "time of the latest message"),
            of("aircraft_id", &S::aircraft_id, "empty: not known yet"),
            of("aircraft_name", &S::aircraft_name, "by the `.log`"),
            field("phase", at(&R::state, phase_text), "`ground`, `takeoff`, `cruise`, `landing` or `landed`"),
            of("sortie", &S::sortie, "number of the flight since the start; 0: none yet"),
            of("began_in_air", &S::began_in_air, "the telemetry began in flight"),
            of("lift_off_s", &S::lift_off_s, "of this sortie"),
            of("flight_time_s", &S::flight_time_s, "time in the air"),
            of("energy_wh", &S::energy_wh, "since lift-off, or since the first message in the air"),
            of("power_w", &S::power_w, "measured"),
            of("expected_power_w", &S::expected_power_w, "predicted from here"),
            of("voltage_v", &S::voltage_v, "measured"),
            of("current_a", &S::current_a, "measured"),
            of("altitude_m", &S::altitude_m, "measured"),
            of("reserve_soc_percent", &S::reserve_soc_percent, "of the mission"),
            of("battery", &S::battery, "the battery"),
            of("prediction", &S::prediction, "as of `predict`"),
            field("no_prediction_reason", reason, "null: there is a prediction"),
            of("turn_home", &S::turn_home, "latest return from the path, or without one latest landing"),
            field("decision", decision, "the schedule"),
            of("alarms", &S::alarms, "active alarms"),
            of("warnings", &S::warnings, "of battery, record and prediction"),
            of("messages", &S::messages, "received messages"),
            of("restarts", &S::restarts, "restarts of the telemetry's clock"),
            of("time_since_message_s", &S::time_since_message_s, "since the latest message"),
            of("silence_threshold_s", &S::silence_threshold_s, "silence after which the link counts as lost"),
            of("others", &S::other_senders, "messages of other senders"),
            of("unusable", &S::unusable, "ignored lines and values by reason")};
}

Fields<WatchEnd> record_fields(const WatchEnd*) {
    using R = WatchEnd;
    return {field("ended", &R::ended, "reason of the end"),
            field("last_prediction", &R::last_prediction, "the last state with a prediction")};
}

PageEvent page_event(const live::LiveState& state, const compute::ComputeModel& compute, const live::TimeCurve& ahead) {
    const auto soc = state.battery ? state.battery->soc_percent : std::nullopt;
    const auto by_voltage = state.battery ? state.battery->soc_by_voltage_percent : std::nullopt;
    const auto at_landing = state.prediction && state.prediction->battery && !state.prediction->overtime_s
                                ? std::optional(state.prediction->battery->expected.soc_percent)
                                : std::nullopt;
    const auto known = [](const auto& value) { return JsonType<std::optional<double>>::write(value); };
    const Json point{{"t", state.time_s},
                     {"phase", phase_text(state)},
                     {"soc", known(soc)},
                     {"soc_by_voltage", known(by_voltage)},
                     {"power", known(state.power_w)},
                     {"expected", known(state.expected_power_w)},
                     {"altitude", known(state.altitude_m)},
                     {"at_landing", known(at_landing)}};
    auto json = record_json(WatchState{&state, &compute});
    json["ahead"] = {{"time_s", ahead.time_s}, {"soc_percent", ahead.value}};
    json["point"] = point;
    return {json.dump(-1, ' ', false, replace_invalid), point.dump(-1, ' ', false, replace_invalid)};
}

std::vector<std::string> screen_of(const live::LiveState& state, const compute::ComputeModel& compute) {
    std::vector<std::string> lines{
        fmt::format("{:.0f} s  {} {:.0f} s  {}  {}{}  {}  {}", state.time_s, phase_text(state), state.flight_time_s,
                    with_unit(state.energy_wh, 3, "Wh"), with_unit(state.power_w, 1, "W"),
                    state.expected_power_w ? fmt::format(" ({:.1f} W expected)", *state.expected_power_w) : "",
                    with_unit(state.voltage_v, 2, "V"), with_unit(state.altitude_m, 0, "m")),
        charge_text(state), landing_line(state), reserve_line(state), schedule_line(state, compute)};
    std::erase(lines, "");
    for (const auto& alarm : state.alarms)
        lines.push_back(
            fmt::format("{}: {} ({})", alarm.grade == "alarm" ? "ALARM" : "Caution", alarm.action, alarm.text));
    for (auto& line : lines) line = one_line(line);
    return lines;
}

std::string line_of(const live::LiveState& state, const compute::ComputeModel& compute) {
    return fmt::format("{}\n", fmt::join(screen_of(state, compute), "  "));
}

std::vector<std::string> fresh_warnings(const std::vector<std::string>& now, std::set<std::string>& reported) {
    constexpr std::size_t max_kinds = 200;
    std::vector<std::string> fresh;
    for (const auto& text : now)
        if (reported.size() < max_kinds && reported.insert(without_numbers(text)).second) fresh.push_back(text);
    return fresh;
}

WatchOutput::WatchOutput(const StageCall& call, const compute::ComputeModel& compute)
    : call_(call), compute_(compute), is_screen_(!call.output && !call.json && standard_output_redraws()) {}

void WatchOutput::print_state(const live::LiveState& state) {
    if (is_screen_) return draw(state);
    for (const auto& warning : fresh_warnings(state.warnings, reported_)) warn(call_, warning);
    is_read_ = print_flushed(call_.json ? json_line(call_, WatchState{&state, &compute_}) : line_of(state, compute_));
}

void WatchOutput::end(const live::LiveFlight& flight, const std::string& why) {
    const auto& last = flight.last_predicted();
    if (call_.json) {
        print(json_line(call_, WatchEnd{why, last ? std::optional(WatchState{&*last, &compute_}) : std::nullopt}));
    } else {
        note(call_, why);
    }
    const auto text = last ? text_of(*last->prediction) : std::string();
    if (call_.output || !text.empty()) write_result(call_, text);
}

void WatchOutput::draw(const live::LiveState& state) {
    constexpr std::chrono::milliseconds min_interval{250};
    const auto now = std::chrono::steady_clock::now();
    if (drawn_ && now - *drawn_ < min_interval) return;
    drawn_ = now;
    auto lines = screen_of(state, compute_);
    for (const auto& warning : state.warnings) lines.push_back(one_line(warning));
    const auto text = fmt::format("\x1b[H\x1b[J{}\n", fmt::join(lines, "\n"));  // clears the screen
    is_read_ = print_flushed(text);
}

}  // namespace flightwatt::cli
