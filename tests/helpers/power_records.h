#pragma once

#include "flight/checks/power_record.h"
#include "flight/checks/power_rules.h"
#include "flight/power_report.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace flightwatt::test {

/// A record of a sample a second, of which the first and last hundred are on the ground, that is sound: 20 W in flight,
/// 0.4 W at rest, no two neighbours equal.
inline flight::PowerRecord sound_record(std::size_t flown = 1000) {
    constexpr std::size_t ground = 100;
    flight::PowerRecord record;
    for (std::size_t i = 0; i < ground + flown + ground; ++i) {
        const bool flies = i >= ground && i < ground + flown;
        const double ripple = 1.0 + 0.01 * std::sin(static_cast<double>(i));
        record.time_s.push_back(static_cast<double>(i));
        record.power_w.push_back((flies ? 20.0 : 0.4) * ripple);
        record.current_a.push_back((flies ? 2.0 : 0.04) * ripple);
        record.throttle_percent.push_back(flies ? 50.0 : 0.0);
        record.altitude_m.push_back(flies ? 100.0 : 0.0);
    }
    record.power_source = "ESC";
    record.in_flight = {{ground, ground + flown}};
    record.energy_j = 20.0 * static_cast<double>(flown);
    record.duration_s = static_cast<double>(flown);
    return record;
}

/// The first samples of that, at rest.
inline std::vector<std::size_t> resting(std::size_t count = 100) {
    std::vector<std::size_t> samples(count);
    std::iota(samples.begin(), samples.end(), std::size_t{0});
    return samples;
}

/// A sortie of the samples in flight that is all cruise, or begins with a take-off of so many seconds.
inline flight::Sortie sortie_of(const flight::PowerRecord& record, double takeoff_s = 0.0) {
    flight::Sortie sortie;
    const auto& [begin, end] = record.in_flight.front();
    const double start_s = record.time_s[begin];
    const auto add = [&](flight::Phase phase, double from_s, double to_s) {
        sortie.phases.emplace_back();
        sortie.phases.back().phase = phase;
        sortie.phases.back().start.time_s = from_s;
        sortie.phases.back().end.time_s = to_s;
    };
    if (takeoff_s > 0.0) add(flight::Phase::takeoff, start_s, start_s + takeoff_s);
    add(flight::Phase::cruise, start_s + takeoff_s, record.time_s[end - 1]);
    return sortie;
}

struct FoundTexts {
    std::vector<std::string> power_faults;
    std::vector<std::string> warnings;
};

inline FoundTexts found_in(flight::PowerRecord record, const std::vector<std::size_t>& at_rest = resting()) {
    flight::PowerReport report;
    derive_facts(record, at_rest);
    apply_power_rules(record, report);
    return {report.power_faults, texts_of(report.warnings)};
}

}  // namespace flightwatt::test
