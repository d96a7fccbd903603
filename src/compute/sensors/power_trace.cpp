#include "compute/sensors/power_trace.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/statistics.h"
#include "compute/powprofiler/powprofiler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

PowerTrace trace_of_csv(const CsvTable& table) {
    const auto time = column_index(table, "time_s");
    const auto power = column_index(table, "power_w");
    PowerTrace trace;
    for (const auto& row : table.rows) {
        const double time_s = cell_number(table, row, time);
        if (!trace.time_s.empty() && time_s <= trace.time_s.back()) {
            throw InputError({table.file, row.line}, fmt::format("time_s = {} follows {}", time_s, trace.time_s.back()),
                             "sort the recording by time");
        }
        trace.add(time_s, cell_number(table, row, power));
    }
    if (trace.time_s.empty()) throw InputError({table.file}, "has a header and no samples");
    return trace;
}

PowerTrace trace_of_layer1(const CsvTable& table, std::optional<double> interval_s) {
    if (!interval_s) {
        throw InputError({table.file}, "has no time stamps", "give the sampler's interval_s");
    }
    PowerTrace trace;
    trace.power_w = layer1_power_w(table);
    for (std::size_t i = 0; i < trace.power_w.size(); ++i) trace.time_s.push_back(static_cast<double>(i) * *interval_s);
    return trace;
}

std::vector<double> intervals_of(const PowerTrace& run) {
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < run.time_s.size(); ++i) intervals_s.push_back(run.time_s[i] - run.time_s[i - 1]);
    return intervals_s;
}

/// 1 + 2 sum rho: correlated samples for one independent sample; at least 1.
double correlation_time(const std::vector<double>& deviations) {
    const auto covariance = [&](std::size_t lag) {
        double sum = 0.0;
        for (std::size_t i = lag; i < deviations.size(); ++i) sum += deviations[i] * deviations[i - lag];
        return sum;
    };
    const double variance = covariance(0);
    if (variance <= 0.0) return 1.0;
    double time = -1.0;
    for (std::size_t lag = 0; lag + 1 < deviations.size(); lag += 2) {
        const double pair = (covariance(lag) + covariance(lag + 1)) / variance;
        if (pair <= 0.0) break;
        time += 2.0 * pair;
    }
    return std::max(time, 1.0);
}

double standard_error_of(const std::vector<double>& values) {
    if (values.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    const double average = mean(values);
    std::vector<double> deviations;
    deviations.reserve(values.size());
    for (const double value : values) deviations.push_back(value - average);
    return std::sqrt(sample_variance(values) / static_cast<double>(values.size()) * correlation_time(deviations));
}

}  // namespace

PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s) {
    const auto text = read_file(path);
    const auto file = path.string();
    const auto table = parse_csv(text, file, CsvHeader::absent);
    const auto& first = table.rows.front();
    if (std::ranges::count(first.cells, "time_s", &CsvTable::Cell::text) > 0)
        return trace_of_csv(parse_csv(text, file));
    if (powprofiler_columns(table)) return trace_of_layer1(table, interval_s);
    throw InputError({file, first.line}, "is not a recording of power: neither time_s,power_w nor 100,...");
}

std::string to_csv(const PowerTrace& trace, const std::vector<std::string>& comments) {
    std::string text;
    for (const auto& comment : comments) text += fmt::format("# {}\n", comment);
    text += "time_s,power_w\n";
    for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
        text += fmt::format("{:.6f},{:.6g}\n", trace.time_s[i], trace.power_w[i]);
    }
    return text;
}

SamplingJitter jitter_of(const std::vector<PowerTrace>& runs) {
    std::vector<double> all;
    for (const auto& run : runs) {
        const auto intervals = intervals_of(run);
        all.insert(all.end(), intervals.begin(), intervals.end());
    }
    if (all.empty()) return {};
    SamplingJitter jitter{mean(all), 0.0, std::ranges::max(all)};
    for (const double interval : all) jitter.sd_s += (interval - jitter.mean_s) * (interval - jitter.mean_s);
    jitter.sd_s = std::sqrt(jitter.sd_s / static_cast<double>(all.size()));
    return jitter;
}

PowerEstimate estimate_run(const PowerTrace& run, double duration_s) {
    auto weights = intervals_of(run);
    weights.insert(weights.begin(), weights.empty() ? 1.0 : median_high(weights));
    const double power_w = std::inner_product(weights.begin(), weights.end(), run.power_w.begin(), 0.0) /
                           std::accumulate(weights.begin(), weights.end(), 0.0);
    return {power_w, standard_error_of(run.power_w), duration_s, power_w * duration_s, run.power_w.size(), 1};
}

PowerEstimate combine_repeats(const std::vector<PowerEstimate>& repeats) {
    const auto count = static_cast<double>(repeats.size());
    PowerEstimate all;
    double own_squares = 0.0;
    std::vector<double> means_w;
    for (const auto& repeat : repeats) {
        means_w.push_back(repeat.power_w);
        all.power_w += repeat.power_w / count;
        all.duration_s += repeat.duration_s / count;
        all.samples += repeat.samples;
        own_squares += repeat.standard_error_w * repeat.standard_error_w;
    }
    all.standard_error_w = std::sqrt(own_squares) / count;
    // fmax: repeats of single samples have only the error between them.
    if (repeats.size() > 1)
        all.standard_error_w = std::fmax(sample_sd(means_w) / std::sqrt(count), all.standard_error_w);
    all.energy_j = all.power_w * all.duration_s;
    all.repeats = repeats.size();
    return all;
}

}  // namespace flightwatt::compute
