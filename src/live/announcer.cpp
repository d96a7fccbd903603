#include "live/announcer.h"

#include "base/units.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr std::size_t text_bytes = 50;  // of a STATUSTEXT

/// What an alarm asks for, as far as it fits behind the prefix: without its reason, "Land now: the reserve ...", else to
/// the end of a word.
std::string fitting(const std::string& prefix, const std::string& action) {
    const auto bytes = text_bytes - prefix.size();
    if (action.size() <= bytes) return prefix + action;
    const auto reason = action.rfind(": ", bytes);
    const auto end = reason == std::string::npos ? action.rfind(' ', bytes) : reason;
    return prefix + action.substr(0, end == std::string::npos ? bytes : end);
}

/// What an action asks for without its reason and numbers: "Turn home within  min", then "Turn home now".
std::string request_of(std::string_view action) {
    std::string request(action.substr(0, action.find(": ")));
    std::erase_if(request, [](char c) { return c >= '0' && c <= '9'; });
    return request;
}

double severity_of(std::string_view grade) {
    constexpr double critical = 2.0;
    constexpr double warning = 4.0;
    constexpr double notice = 5.0;
    return grade == "alarm" ? critical : grade == "caution" ? warning : notice;
}

}  // namespace

std::vector<std::string> Announcer::packets(const LiveState& state, double now_s) {
    std::vector<std::string> packets;
    if (now_s >= values_due_s_) {
        values_due_s_ = now_s + 1.0;
        packets.push_back(sender_.heartbeat());
        add_values(state, now_s, packets);
    }
    add_texts(state, now_s, packets);
    return packets;
}

void Announcer::add_values(const LiveState& state, double now_s, std::vector<std::string>& packets) {
    const auto add = [&](const char* name, std::optional<double> value) {
        if (value)
            packets.push_back(
                sender_.packet("NAMED_VALUE_FLOAT", {{"time_boot_ms", now_s / units::milli}, {"value", *value}}, name));
    };
    const bool is_silent = std::ranges::find(state.alarms, "silence", &LiveAlarm::kind) != state.alarms.end();
    if (!state.prediction || state.landed || is_silent) return;
    if (state.prediction->battery) add("fw_land", state.prediction->battery->expected.soc_percent);
    if (state.turn_home)
        add("fw_home", units::minute_from_second(std::max(0.0, state.turn_home->latest_in_s.value_or(0.0))));
    if (state.battery && state.battery->time_to_reserve_s)
        add("fw_resv", units::minute_from_second(*state.battery->time_to_reserve_s));
}

/// A higher grade, and what is due now, is announced at once, any other change after a while, so that one that flickers
/// does not fill a screen.
void Announcer::add_texts(const LiveState& state, double now_s, std::vector<std::string>& packets) {
    constexpr double min_interval_s = 5.0;
    constexpr double min_request_interval_s = 10.0;
    const auto announce = [&](const std::string& kind, const std::string& grade, const std::string& request,
                              const std::string& text) {
        auto& last = announced_[kind];
        if (grade == last.grade && request == last.request) return;
        const bool is_worse =
            last.grade.empty() || (grade == "alarm" && (last.grade != grade || request.ends_with(" now")));
        const double interval_s = grade == last.grade ? min_request_interval_s : min_interval_s;
        if (!is_worse && now_s < last.at_s + interval_s) return;
        last = {grade, request, now_s};
        packets.push_back(sender_.packet("STATUSTEXT", {{"severity", severity_of(grade)}}, text));
    };
    for (const auto& alarm : state.alarms)
        announce(alarm.kind, alarm.grade, request_of(alarm.action),
                 fitting(fmt::format("FlightWatt {}: ", alarm.grade), alarm.action));
    for (const auto& [kind, last] : announced_) {
        const bool is_raised = std::ranges::find(state.alarms, kind, &LiveAlarm::kind) != state.alarms.end();
        if (!is_raised && !last.grade.empty())
            announce(kind, "", "", fmt::format("FlightWatt: no {} alarm any more", kind));
    }
}

}  // namespace flightwatt::live
