#include "flight/power_check.h"

#include "flight/checks/power_record.h"
#include "flight/checks/power_rules.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {

PowerReport check_power_record(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options) {
    PowerReport report;
    report.origin = tracks.series().current_origin;
    const auto record = make_power_record(tracks, phases, options);
    report.energy_closure_percent = record.energy_wh.closure_percent;
    report.charge_closure_percent = record.charge_ah.closure_percent;
    if (record.has_throttle()) report.idle = record.at_rest;
    std::ranges::copy_if(record.gaps, std::back_inserter(report.gaps), &SampleGap::is_within);
    apply_power_rules(record, report);
    return report;
}

std::string describe_power_faults(const std::vector<std::string>& power_faults) {
    return fmt::format("power faults: {}; --keep overrides this", fmt::join(power_faults, ", "));
}

void correct_idle_offset(FlightSeries& series, const std::optional<IdleCurrent>& idle) {
    if (!idle) return;
    auto power = power_track(series);
    auto current = select_track(series, "current_a");
    const auto voltage_v = sample_selected_track(series, "voltage_v", power.time_s);
    const auto current_a = resample(current, power.time_s);
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        const double volts = !voltage_v.empty()    ? voltage_v[i]
                             : current_a[i] != 0.0 ? power.value[i] / current_a[i]
                                                   : 0.0;
        power.value[i] -= idle->mean_a * volts;
    }
    current.time_s = power.time_s;
    current.value = current_a;
    for (auto& value : current.value) value -= idle->mean_a;
    // Other candidates are removed, since their offset is unknown; warnings about the selection are kept.
    const auto before = warnings_of(series);
    replace_track(series, std::move(power));
    replace_track(series, std::move(current));
    const auto after = warnings_of(series);
    for (const auto& warning : before) {
        if (std::find(after.begin(), after.end(), warning) == after.end()) series.notes.push_back(warning);
    }
    series.notes.push_back(
        fmt::format("the idle current of {:.4f} A ({} samples at rest) was subtracted", idle->mean_a, idle->samples));
}

}  // namespace flightwatt::flight
