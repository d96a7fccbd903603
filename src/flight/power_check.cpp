#include "flight/power_check.h"

#include "flight/checks/power_record.h"
#include "flight/checks/power_rules.h"
#include "flight/checks/unusual_rules.h"
#include "flight/select.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {

PowerReport check_power_record(const FlightData& data, const FlightPhases& phases, const SegmentationOptions& options) {
    PowerReport report;
    report.origin = data.current_origin;
    const auto record = make_power_record(data, phases, options);
    report.energy_closure_percent = record.energy_wh.closure_percent;
    report.charge_closure_percent = record.charge_ah.closure_percent;
    if (record.has_throttle()) report.idle = record.at_rest;
    std::ranges::copy_if(record.gaps, std::back_inserter(report.gaps), &SampleGap::is_within);
    apply_power_rules(record, report);
    return report;
}

std::optional<SampleGap> clock_jump_fault(const FlightData& data, const FlightPhases& phases,
                                          const PowerReport& report) {
    const auto is_fault = [](const std::optional<double>& closure_percent) {
        return closure_percent && *closure_percent > max_counter_difference_percent;
    };
    if (!is_fault(report.energy_closure_percent) && !is_fault(report.charge_closure_percent)) return std::nullopt;
    const auto record = make_power_record(data, phases, {});
    for (const auto* counter : record.counters())
        if (const auto jump = find_clock_jump(record, *counter); jump && is_fault(counter->closure_percent))
            return jump->gap;
    return std::nullopt;
}

std::string describe_power_faults(const std::vector<std::string>& power_faults) {
    return fmt::format("power faults: {}; --keep overrides this", fmt::join(power_faults, ", "));
}

void correct_idle_offset(FlightSeries& series, const FlightData& data, const std::optional<IdleCurrent>& idle) {
    if (!idle) return;
    Track power = data.power_w;
    Track current = data.current_a;
    const auto voltage_v = resample(data.voltage_v, power.time_s);
    current.value = resample(current, power.time_s);
    current.time_s = power.time_s;
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        const double volts = !voltage_v.empty()        ? voltage_v[i]
                             : current.value[i] != 0.0 ? power.value[i] / current.value[i]
                                                       : 0.0;
        power.value[i] -= idle->mean_a * volts;
        current.value[i] -= idle->mean_a;
    }
    // Other candidates are removed, since their offset is unknown; warnings about the selection are kept.
    replace_track(series, std::move(power));
    replace_track(series, std::move(current));
    for (const Track* track : {&data.voltage_v, &data.charge_ah, &data.energy_wh})
        if (!track->empty()) replace_track(series, *track);
    const auto after = texts_of(selection_diagnostics(select_tracks(series)));
    for (const auto& warning : texts_of(selection_diagnostics(data)))
        if (std::ranges::find(after, warning) == after.end()) series.notes.push_back(warning);
    series.notes.push_back(
        fmt::format("the idle current of {:.4f} A ({} samples at rest) was subtracted", idle->mean_a, idle->samples));
}

}  // namespace flightwatt::flight
