#include "mission/planning/voltage_course.h"

#include "mission/simulation.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mission {
namespace {

constexpr double point_every_s = 0.1;
constexpr double same_time_s = 1e-9;

/// How much the lines bend, in voltage over the longer of two neighbours: an interpolated smooth curve is off
/// by an eighth of that, one with a corner by less than all of it.
double greatest_bend_v(const SourceVoltage& source) {
    double bend_v = 0.0;
    for (std::size_t i = 2; i < source.time_s.size(); ++i) {
        const double before_s = source.time_s[i - 1] - source.time_s[i - 2];
        const double after_s = source.time_s[i] - source.time_s[i - 1];
        const double before_v_per_s = (source.voltage_v[i - 1] - source.voltage_v[i - 2]) / before_s;
        const double after_v_per_s = (source.voltage_v[i] - source.voltage_v[i - 1]) / after_s;
        bend_v = std::max(bend_v, std::abs(after_v_per_s - before_v_per_s) * std::max(before_s, after_s));
    }
    return bend_v;
}

}  // namespace

double voltage_v(const SourceVoltage& source, double time_s) {
    const auto above = std::upper_bound(source.time_s.begin(), source.time_s.end(), time_s);
    if (above == source.time_s.begin()) return source.voltage_v.front();
    if (above == source.time_s.end()) return source.voltage_v.back();
    const auto i = static_cast<std::size_t>(above - source.time_s.begin());
    const double part = (time_s - source.time_s[i - 1]) / (source.time_s[i] - source.time_s[i - 1]);
    return std::lerp(source.voltage_v[i - 1], source.voltage_v[i], part);
}

std::optional<SourceVoltage> source_voltage_of(const Mission& mission) {
    auto uncut = mission;
    uncut.cutoff_voltage_v = 0.0;
    const auto simulation = simulate(uncut, {point_every_s, point_every_s});
    if (!simulation.summary.feasible) return std::nullopt;
    SourceVoltage source;
    for (const auto& row : simulation.curve.rows) {
        // At a jump the current changes, the source does not.
        if (!source.time_s.empty() && row.time_s - source.time_s.back() < same_time_s) continue;
        source.time_s.push_back(row.time_s);
        source.voltage_v.push_back(row.terminal_voltage_v + mission.battery.resistance_ohm * row.current_a);
    }
    source.error_v = greatest_bend_v(source);
    return source;
}

}  // namespace flightwatt::mission
