#include "cli/output/moment_option.h"

#include "base/error.h"
#include "base/number.h"
#include "cli/numeric_options.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace flightwatt::cli {

RequestedTime read_requested_time(const StageCall& call) {
    const auto log_time_s = positive_option(call, "until-log-time", "s");
    if (log_time_s && !call.options["until"].defaulted()) {
        throw UsageError("--until and --until-log-time exclude each other: give one of them");
    }
    const auto text = call.get<std::string>("until");
    if (text == "now") return {std::nullopt, log_time_s};
    const auto since_s = parse_number(text);
    if (!since_s || !(*since_s > 0.0) || !std::isfinite(*since_s)) {
        throw UsageError(fmt::format("--until {}: expected now, or seconds since lift-off, more than 0", text));
    }
    return {since_s, std::nullopt};
}

double resolve_log_time(const RequestedTime& moment, const std::vector<flight::FlightSeries>& candidates,
                        std::size_t sortie, const flight::SegmentationOptions& options) {
    if (moment.log_time_s) return *moment.log_time_s;
    if (!moment.since_lift_off_s) {
        double last_s = 0.0;
        for (const auto& series : candidates) last_s = std::max(last_s, mechanical::last_time_s(series));
        return last_s;
    }
    std::optional<double> first_s;
    std::optional<NoResultError> refusal;
    for (const auto& series : candidates) {
        try {
            const double time_s =
                mechanical::log_time_after_lift_off(series, *moment.since_lift_off_s, sortie, options);
            first_s = std::min(first_s.value_or(time_s), time_s);
        } catch (const NoResultError& error) {
            if (!refusal) refusal = error;
        }
    }
    if (!first_s) throw NoResultError(*refusal);
    return *first_s;
}

}  // namespace flightwatt::cli
