#include "exchange/log_slices.h"

#include "base/error.h"
#include "base/number.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr double no_bound_s = std::numeric_limits<double>::infinity();

/// Where a piece begins whose ground may begin at `earliest_s`: at the sample from there to half-way to lift-off that
/// is nearest to a time at which the segmentation of the whole log looks.
double aligned_start_s(const std::vector<double>& clock_s, double earliest_s, double lift_off_s) {
    if (clock_s.empty() || earliest_s <= clock_s.front()) return -no_bound_s;
    const auto off_grid_s = [&](double time_s) {
        return std::abs(std::remainder(time_s - clock_s.front(), flight::segmentation_step_s));
    };
    const auto first = std::ranges::lower_bound(clock_s, earliest_s);
    const auto last = std::upper_bound(first, clock_s.end(), 0.5 * (earliest_s + lift_off_s));
    if (first == last) return earliest_s;
    return *std::ranges::min_element(first, last, {}, off_grid_s);
}

}  // namespace

std::vector<LogSlice> sortie_slices(const flight::FlightSeries& series, const flight::FlightPhases& phases) {
    const auto power = flight::power_track(series);
    const auto clock_s = power.empty() ? flight::select_track(series, "altitude_m").time_s : power.time_s;
    std::vector<LogSlice> pieces;
    const auto& sorties = phases.sorties;
    for (std::size_t i = 0; i < sorties.size(); ++i) {
        const double start_s = sorties[i].start_s();
        const double end_s = sorties[i].end_s();
        const double earliest_s = i == 0 ? -no_bound_s : std::midpoint(sorties[i - 1].end_s(), start_s);
        const double latest_s = i + 1 == sorties.size() ? no_bound_s : std::midpoint(end_s, sorties[i + 1].start_s());
        pieces.push_back({fmt::format("sortie{}", sorties[i].number),
                          aligned_start_s(clock_s, std::max(earliest_s, start_s - ground_margin_s), start_s),
                          std::min(latest_s, end_s + ground_margin_s)});
    }
    return pieces;
}

std::vector<LogSlice> phase_slices(const flight::FlightPhases& phases) {
    std::vector<LogSlice> pieces;
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            pieces.push_back(
                {fmt::format("sortie{}_{}", sortie.number, to_string(span.phase)), span.start.time_s, span.end.time_s});
        }
    }
    return pieces;
}

std::string text_of_log(const flight::FlightFile& file) {
    if (file.is_series()) {
        throw InputError({file.path().string()}, "is a series, which has no lines of telemetry to cut",
                         "give the log that it was made from");
    }
    if (!file.framing()) return std::string(file.text());
    return with_binary_log(file, [](const telemetry::BinaryLog& log) {
        telemetry::LinkDecoder decoder(*log.messages, log.framing, link_version(log));
        std::string text;
        const auto sink = [&](const telemetry::LinkMessage& message) {
            if (message.time_s) fmt::format_to(std::back_inserter(text), "{:.4f} {}\n", *message.time_s, message.text);
        };
        decoder.push(log.bytes, sink);
        decoder.flush(sink);
        return text;
    });
}

std::string lines_in_slice(std::string_view text, const LogSlice& piece) {
    std::string lines;
    bool inside = false;
    for (std::size_t begin = 0; begin < text.size();) {
        const auto end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        const auto line = text.substr(begin, end - begin);
        if (const auto time_s = parse_number(line.substr(0, line.find(' '))))
            inside = *time_s >= piece.time.start_s && *time_s <= piece.time.end_s;
        const bool says_synthetic = begin == 0 && line.find("INFO_MSG \"SYNTHETIC:") != std::string_view::npos;
        if (inside || says_synthetic) lines += line;
        begin = end;
    }
    return lines;
}

}  // namespace flightwatt::exchange
