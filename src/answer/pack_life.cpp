#include "answer/pack_life.h"

#include "base/error.h"
#include "base/units.h"
#include "mission/sampled_flights.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::answer {
namespace {

constexpr auto not_shown = "not within what the flights show";

/// Which end of the trends' intervals.
enum class Pace { slowest, median, fastest };

/// The pack's battery on a day: its own resistance, and the mission's capacity less what is lost since the mean flight.
battery::Battery battery_on(const Pack& pack, battery::Battery battery, double day, Pace pace) {
    const auto slope = [&](const PackTrend& of, bool rises) {
        const auto& trend = of.answer.trend;
        if (!trend || !is_significant(*trend)) return 0.0;
        if (pace == Pace::median) return trend->per_day;
        return (pace == Pace::fastest) == rises ? trend->high_per_day : trend->low_per_day;
    };
    const auto& resistance = pack.resistance;
    const double ohm = resistance.answer.trend
                           ? resistance.last_value + slope(resistance, true) * (day - resistance.last_day)
                           : *pack.resistance_ohm;
    const double more_ohm = std::max(ohm, 0.0) - battery.resistance_ohm;
    battery.resistance_ohm += more_ohm;
    if (auto& interval = battery.intervals.resistance_ohm)
        interval = Interval{std::max(0.0, interval->low + more_ohm), interval->high + more_ohm};
    const double middle_day = (pack.capacity.first_day + pack.capacity.last_day) / 2.0;
    const double left = 1.0 + slope(pack.capacity, false) * (day - middle_day) / units::percent_per_whole;
    const double part = std::clamp(left, 0.01, 2.0);
    battery.capacity_ah *= part;
    if (auto& interval = battery.intervals.capacity_ah)
        interval = Interval{interval->low * part, interval->high * part};
    battery.flight_estimate = nullptr;
    return battery;
}

/// The first day between two on which the reserve is not kept; none up to the second.
std::optional<double> first_day(const Pack& pack, const mission::PreparedMission& mission, Interval days, Pace pace) {
    constexpr double accepted = 0.05;
    constexpr double exact_days = 1.0;
    const auto fails = [&](double day) {
        auto worn = mission;
        worn.setup.battery = battery_on(pack, mission.setup.battery, day, pace);
        const auto flights = mission::sample_flights(worn, {}, {});
        if (!flights.variability_is_known) throw NoResultError("nothing shows how flights differ in power");
        return flights.probability_below_reserve > accepted;
    };
    if (fails(days.low)) return days.low;
    if (!fails(days.high)) return std::nullopt;
    while (days.high - days.low > exact_days) {
        const double middle = (days.low + days.high) / 2.0;
        (fails(middle) ? days.high : days.low) = middle;
    }
    return days.high;
}

}  // namespace

std::string mission_life(const Pack& pack, const mission::PreparedMission& mission) {
    const auto worsens = [](const PackTrend& of, double sign) {
        return of.answer.trend && is_significant(*of.answer.trend) && sign * of.answer.trend->per_day > 0.0;
    };
    if (!pack.resistance_ohm || !pack.last_s) return "unknown: no resistance of dated flights";
    if (mission.adaptive) return "unknown: its schedule is made in flight";
    const auto& cells = mission.setup.battery.cells;
    if (cells && pack.cells && *cells != *pack.cells)
        return fmt::format("unknown: its battery has {} cells, and the pack {}", *cells, *pack.cells);
    if (!worsens(pack.resistance, 1.0) && !worsens(pack.capacity, -1.0)) return not_shown;
    const double last_day = *pack.last_s / seconds_per_day;
    const double shown_days = last_day - *pack.first_s / seconds_per_day;
    const Interval days{last_day, last_day + shown_days};
    try {
        const auto day = first_day(pack, mission, days, Pace::median);
        if (!day) return fmt::format("{} (until {})", not_shown, day_text(days.high));
        const auto earliest = first_day(pack, mission, days, Pace::fastest);
        const auto latest = first_day(pack, mission, days, Pace::slowest);
        return fmt::format("until {} ({} to {})", day_text(*day), day_text(earliest.value_or(*day)),
                           latest ? day_text(*latest) : "later than " + day_text(days.high));
    } catch (const std::runtime_error& error) {  // of input, usage or result
        return fmt::format("unknown: {}", error.what());
    }
}

}  // namespace flightwatt::answer
