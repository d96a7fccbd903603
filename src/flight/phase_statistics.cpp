#include "flight/phase_statistics.h"

#include "base/units.h"
#include "flight/chosen_track.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

std::size_t first_at_or_after(const std::vector<double>& time_s, double t) {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t) - time_s.begin());
}

/// Linear between samples, the first and last value outside of them.
double interpolated(const std::vector<double>& time_s, const std::vector<double>& values, double t) {
    const auto after = first_at_or_after(time_s, t);
    if (after == 0) return values.front();
    if (after == time_s.size()) return values.back();
    const double part = (t - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
    return std::lerp(values[after - 1], values[after], part);
}

std::string optional_cell(const auto& value) { return value ? fmt::format("{}", *value) : ""; }

std::string edge_cells(const PhaseEdge& edge) {
    return fmt::format("{:.2f},{},{},{},{},{}", edge.altitude_m, edge.gap_s,
                       optional_cell(edge.throttle_percent), optional_cell(edge.mode),
                       optional_cell(edge.block), optional_cell(edge.takeoff_after_s));
}

}  // namespace

double usual_interval_s(const std::vector<double>& time_s) {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < time_s.size(); ++i) intervals.push_back(time_s[i] - time_s[i - 1]);
    if (intervals.empty()) return 0.0;
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::nth_element(intervals.begin(), middle, intervals.end());
    return *middle;
}

double gap_threshold_s(const std::vector<double>& time_s) { return 3.0 * usual_interval_s(time_s); }

double integrated(const std::vector<double>& time_s, const std::vector<double>& values, double start_s,
                  double end_s) {
    double integral = 0.0;
    double last_s = start_s;
    double last = interpolated(time_s, values, start_s);
    for (auto i = first_at_or_after(time_s, start_s); i < time_s.size() && time_s[i] < end_s; ++i) {
        integral += 0.5 * (last + values[i]) * (time_s[i] - last_s);
        last_s = time_s[i];
        last = values[i];
    }
    return integral + 0.5 * (last + interpolated(time_s, values, end_s)) * (end_s - last_s);
}

double integrated_energy_wh(const FlightSeries& series, double start_s, double end_s) {
    const auto power = power_track(series);
    return units::wh_from_joule(integrated(power.time_s, power.value, start_s, end_s));
}

PhaseStatistics phase_statistics(const FlightSeries& series, double start_s, double end_s) {
    PhaseStatistics statistics;
    const auto power = power_track(series);
    const auto& time_s = power.time_s;
    const double gap_s = gap_threshold_s(time_s);
    double last_s = start_s;
    const auto count_gap = [&](double until_s) {
        const double interval_s = until_s - last_s;
        statistics.longest_gap_s = std::max(statistics.longest_gap_s, interval_s);
        if (interval_s > gap_s) ++statistics.gaps;
        last_s = until_s;
    };
    double sum_w = 0.0;
    for (auto i = first_at_or_after(time_s, start_s); i < time_s.size() && time_s[i] <= end_s; ++i) {
        count_gap(time_s[i]);
        sum_w += power.value[i];
        ++statistics.samples;
    }
    count_gap(end_s);
    if (statistics.samples > 0) statistics.mean_power_w = sum_w / static_cast<double>(statistics.samples);
    statistics.energy_wh = units::wh_from_joule(integrated(time_s, power.value, start_s, end_s));
    if (const auto counter = chosen_at(series, "energy_wh", time_s); !counter.empty()) {
        statistics.counter_energy_wh =
            interpolated(time_s, counter, end_s) - interpolated(time_s, counter, start_s);
    }
    return statistics;
}

std::string phases_csv(const FlightSeries& series, const FlightPhases& phases) {
    std::string text =
        "sortie,phase,start_s,end_s,duration_s,samples,mean_power_w,energy_wh,counter_energy_wh,gaps,"
        "longest_gap_s,complete";
    for (const auto* edge : {"start", "end"}) {
        text += fmt::format(
            ",{0}_altitude_m,{0}_gap_s,{0}_throttle_percent,{0}_mode,{0}_block,{0}_to_takeoff_message_s",
            edge);
    }
    text += '\n';
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            const auto statistics = phase_statistics(series, span.start.time_s, span.end.time_s);
            text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", sortie.number,
                                to_string(span.phase), span.start.time_s, span.end.time_s, span.duration_s(),
                                statistics.samples, statistics.mean_power_w, statistics.energy_wh,
                                optional_cell(statistics.counter_energy_wh), statistics.gaps,
                                statistics.longest_gap_s, span.complete, edge_cells(span.start),
                                edge_cells(span.end));
        }
    }
    return text;
}

}  // namespace flightwatt::flight
