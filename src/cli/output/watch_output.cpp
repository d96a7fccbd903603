#include "cli/output/watch_output.h"

#include "base/units.h"
#include "cli/output/prediction_output.h"
#include "cli/screen_table.h"
#include "live/turn_home.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

std::string phase_text(const live::LiveState& state) {
    if (state.phase) return std::string(to_string(*state.phase));
    return state.landed ? "landed" : "ground";
}

Json run_json(const compute::Configuration& run, const compute::ComputeModel& compute) {
    auto json = Json::object();
    for (const auto& running : run) {
        const auto& component = compute.components[running.component];
        auto qos = Json::object();
        for (std::size_t i = 0; i < running.qos.size(); ++i) qos[component.profile.parameters[i]] = running.qos[i];
        json[component.name] = std::move(qos);
    }
    return json;
}

Json battery_json(const live::LiveBattery& battery) {
    const auto known = [&](double value) { return battery.soc_percent ? std::optional(value) : std::nullopt; };
    return {{"soc_percent", optional_json(battery.soc_percent)},
            {"soc_by_voltage_percent", optional_json(battery.soc_by_voltage_percent)},
            {"initial_soc_percent", optional_json(known(battery.initial_soc_percent))},
            {"initial_is_measured", battery.initial_is_from_voltage},
            {"drawn_ah", optional_json(battery.drawn_ah)},
            {"voltage_off_v", optional_json(battery.voltage_residual_v)},
            {"reserve_in_s", optional_json(battery.time_to_reserve_s)},
            {"chance_below_reserve", optional_json(battery.probability_below_reserve)}};
}

Json decision_json(const live::LiveDecision& decision, const compute::ComputeModel& compute) {
    return {{"run", run_json(decision.run, compute)},
            {"utility_per_s", decision.utility_per_s},
            {"next", decision.next ? run_json(*decision.next, compute) : Json()},
            {"next_in_s", decision.next ? Json(decision.next_in_s) : Json()},
            {"rest_utility_per_s", optional_json(decision.remaining_utility_per_s)},
            {"keeps_reserve", decision.keeps_reserve},
            {"final_soc_percent", optional_json(decision.final_soc_percent)},
            {"changes", decision.changes}};
}

std::string spare(const std::optional<double>& value, int decimals, const char* unit) {
    return value ? fmt::format("{:.{}f} {}", *value, decimals, unit) : fmt::format("- {}", unit);
}

/// "34.1 % and 10.92 V (30.2 % at the high end)"
std::string landing_line(const live::LiveState& state) {
    if (!state.prediction) return "waits for: " + state.no_prediction_reason;
    const auto& prediction = *state.prediction;
    auto text = fmt::format("{:.2f} Wh to the landing ({:.2f} to {:.2f})", prediction.remaining_energy.energy_wh,
                            prediction.interval.low_wh, prediction.interval.high_wh);
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
    if (const auto& chance = state.battery->probability_below_reserve)
        text += fmt::format(", chance of landing below it {:.1f} %", units::percentage(*chance, 1.0));
    if (const auto& turn = state.turn_home) {
        text += !turn->latest_in_s        ? ", too late to turn home with it"
                : turn->path_can_be_flown ? ", home from anywhere on the path"
                                          : fmt::format(", turn home within {:.1f} min", *turn->latest_in_s / 60.0);
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
        text += fmt::format("; utility {:.4g} a second to the end", *decision.remaining_utility_per_s);
    if (!decision.keeps_reserve) text += "; no plan keeps the reserve";
    return text;
}

std::string charge_text(const live::LiveState& state) {
    if (!state.battery) return "";
    return fmt::format("{} by charge, {} by voltage", spare(state.battery->soc_percent, 1, "%"),
                       spare(state.battery->soc_by_voltage_percent, 1, "%"));
}

std::string variable_name(std::string text) {
    for (auto& c : text)
        c = std::isalnum(static_cast<unsigned char>(c)) != 0
                ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                : '_';
    return text;
}

constexpr auto replace_invalid = Json::error_handler_t::replace;

/// A line in lines of so many columns, broken at blanks; those below are indented as a screen's texts are.
std::string wrapped(std::string line, std::size_t columns) {
    const std::string indent(10, ' ');
    std::string text;
    while (line.size() > columns) {
        const auto blank = line.rfind(' ', columns);
        if (blank == std::string::npos || blank <= indent.size()) break;
        text += line.substr(0, blank) + "\n";
        line.replace(0, blank + 1, indent);
    }
    return text + line + "\n";
}

std::string without_numbers(std::string text) {
    std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
    return text;
}

}  // namespace

Json json_of(const live::LiveState& state, const compute::ComputeModel& compute) {
    Json json{{"time_s", state.time_s},
              {"aircraft", state.aircraft_id},
              {"phase", phase_text(state)},
              {"sortie", state.sortie},
              {"began_in_air", state.began_in_air},
              {"lift_off_s", optional_json(state.lift_off_s)},
              {"flight_s", state.flight_time_s},
              {"energy_wh", optional_json(state.energy_wh)},
              {"power_w", optional_json(state.power_w)},
              {"expected_power_w", optional_json(state.expected_power_w)},
              {"voltage_v", optional_json(state.voltage_v)},
              {"current_a", optional_json(state.current_a)},
              {"altitude_m", optional_json(state.altitude_m)},
              {"battery", state.battery ? battery_json(*state.battery) : Json()},
              {"prediction", state.prediction ? json_of(*state.prediction) : Json()},
              {"waits_for", state.prediction ? Json() : Json(state.no_prediction_reason)},
              {"turn_home", nullptr},
              {"decision", state.decision ? decision_json(*state.decision, compute) : Json()},
              {"alarms", Json::array()},
              {"warnings", state.warnings},
              {"messages", state.messages},
              {"restarts", state.restarts},
              {"silent_s", state.time_since_message_s},
              {"others", state.other_senders},
              {"unusable", state.unusable}};
    if (const auto& turn = state.turn_home)
        json["turn_home"] = {{"latest_in_s", optional_json(turn->latest_in_s)},
                             {"path_can_be_flown", turn->path_can_be_flown}};
    for (const auto& alarm : state.alarms) json["alarms"].push_back({{"kind", alarm.kind}, {"text", alarm.text}});
    return json;
}

PageEvent page_event(const live::LiveState& state, const compute::ComputeModel& compute, const live::TimeCurve& ahead) {
    const auto soc = state.battery ? state.battery->soc_percent : std::nullopt;
    const auto by_voltage = state.battery ? state.battery->soc_by_voltage_percent : std::nullopt;
    const Json point{{"t", state.time_s},
                     {"phase", phase_text(state)},
                     {"soc", optional_json(soc)},
                     {"soc_by_voltage", optional_json(by_voltage)},
                     {"power", optional_json(state.power_w)},
                     {"expected", optional_json(state.expected_power_w)},
                     {"altitude", optional_json(state.altitude_m)}};
    auto json = json_of(state, compute);
    json["ahead"] = {{"time_s", ahead.time_s}, {"soc_percent", ahead.value}};
    json["point"] = point;
    return {json.dump(-1, ' ', false, replace_invalid), point.dump(-1, ' ', false, replace_invalid)};
}

std::string line_of(const live::LiveState& state, const compute::ComputeModel& compute) {
    auto line = fmt::format("{:.0f} s  {} {:.0f} s  {}  {}", state.time_s, phase_text(state), state.flight_time_s,
                            spare(state.energy_wh, 3, "Wh"), spare(state.power_w, 1, "W"));
    for (const auto& text :
         {charge_text(state), landing_line(state), reserve_line(state), schedule_line(state, compute)})
        if (!text.empty()) line += "  " + text;
    for (const auto& alarm : state.alarms) line += fmt::format("  ALARM {}: {}", alarm.kind, alarm.text);
    return one_line(line) + "\n";
}

std::vector<std::string> screen_of(const live::LiveState& state, const compute::ComputeModel& compute) {
    const auto aircraft = state.aircraft_id.empty() ? std::string("no aircraft yet") : "aircraft " + state.aircraft_id;
    std::vector<std::string> lines{
        fmt::format("{}  {:.0f} s  {}{}", aircraft, state.time_s, phase_text(state),
                    state.flight_time_s > 0.0 ? fmt::format(", {:.1f} min in the air{}", state.flight_time_s / 60.0,
                                                            state.began_in_air ? " since the first message" : "")
                                              : ""),
        fmt::format("energy    {}, {} now{}, {}, {}", spare(state.energy_wh, 3, "Wh"), spare(state.power_w, 1, "W"),
                    state.expected_power_w ? fmt::format(" ({:.1f} W expected)", *state.expected_power_w) : "",
                    spare(state.voltage_v, 2, "V"), spare(state.altitude_m, 0, "m"))};
    if (const auto text = charge_text(state); !text.empty()) lines.push_back("charge    " + text);
    lines.push_back("landing   " + landing_line(state));
    if (const auto text = reserve_line(state); !text.empty()) lines.push_back("          " + text);
    if (const auto text = schedule_line(state, compute); !text.empty()) lines.push_back("schedule  " + text);
    for (const auto& alarm : state.alarms) lines.push_back("ALARM     " + alarm.text);
    for (auto& line : lines) line = one_line(line);
    return lines;
}

live::DecisionCommand::Environment decision_environment(const live::LiveState& state,
                                                        const compute::ComputeModel& compute) {
    const auto& decision = state.decision.value();
    const auto soc =
        state.battery && state.battery->state ? std::optional(state.battery->state->soc_percent) : std::nullopt;
    live::DecisionCommand::Environment variables{{"FLIGHTWATT_TIME_S", fmt::format("{}", state.time_s)},
                                                 {"FLIGHTWATT_PHASE", phase_text(state)},
                                                 {"FLIGHTWATT_SOC_PERCENT", soc ? fmt::format("{:.2f}", *soc) : ""},
                                                 {"FLIGHTWATT_RUN", run_json(decision.run, compute).dump()}};
    for (std::size_t c = 0; c < compute.components.size(); ++c) {
        const auto& component = compute.components[c];
        const auto name = "FLIGHTWATT_COMPONENT_" + variable_name(component.name);
        const auto running = std::ranges::find(decision.run, c, &compute::RunningComponent::component);
        variables[name] = running == decision.run.end() ? "0" : "1";
        if (running == decision.run.end()) continue;
        for (std::size_t i = 0; i < running->qos.size(); ++i)
            variables[name + "_" + variable_name(component.profile.parameters[i])] = fmt::format("{}", running->qos[i]);
    }
    return variables;
}

std::vector<std::string> WarningThrottle::due(const std::vector<std::string>& now) {
    std::vector<std::string> to_say;
    for (const auto& text : now)
        if (said_.size() < max_kinds && said_.emplace(without_numbers(text), text).second) to_say.push_back(text);
    return to_say;
}

std::vector<std::string> WarningThrottle::final_updates(const std::vector<std::string>& now) {
    std::vector<std::string> to_say;
    for (const auto& text : now) {
        const auto known = said_.find(without_numbers(text));
        if (known != said_.end() && std::exchange(known->second, text) != text) to_say.push_back(text);
    }
    return to_say;
}

WatchOutput::WatchOutput(const StageCall& call, const compute::ComputeModel& compute) : call_(call), compute_(compute) {
    const auto ability = standard_output_ability();
    if (ability.redraws && !call.output && !call.json) columns_ = ability.columns;
}

void WatchOutput::print_state(const live::LiveState& state) {
    warnings_ = state.warnings;
    const auto to_say = said_.due(warnings_);
    for (const auto& warning : to_say)
        if (!columns_) warn(call_, warning);
    if (columns_) {
        draw(state);
    } else if (call_.json) {
        is_read_ = print_flushed(json_of(state, compute_).dump(-1, ' ', false, replace_invalid) + "\n");
    } else {
        is_read_ = print_flushed(line_of(state, compute_));
    }
}

void WatchOutput::end(const live::LiveFlight& flight, const std::string& why) {
    for (const auto& warning : said_.final_updates(warnings_)) warn(call_, warning);
    const auto& last = flight.last_predicted();
    if (call_.json) {
        Json json{{"ended", why}, {"last_prediction", nullptr}};
        if (last) json["last_prediction"] = json_of(*last, compute_);
        print(json.dump(-1, ' ', false, replace_invalid) + "\n");
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
    for (const auto& warning : state.warnings) lines.push_back("          " + one_line(warning));
    std::string text = "\x1b[H\x1b[J";  // the whole screen anew
    for (const auto& line : lines) text += wrapped(line, *columns_);
    is_read_ = print_flushed(text);
}

}  // namespace flightwatt::cli
