#include "flight/segment/motor_record.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/flight_phases.h"
#include "flight/select/throttle.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double glitch_s = 10.0;  // throttle without power for a shorter time is an error of the record

struct PowerLevels {
    double idle_w;
    double running_w;
    double percent(double power_w) const { return units::percentage(power_w - idle_w, running_w - idle_w); }
    double power_w(double percent) const { return std::lerp(idle_w, running_w, percent / units::percent_per_whole); }
};

std::string describe(const PowerLevels& levels) {
    return fmt::format("power: idle {:.1f} W, running {:.1f} W", levels.idle_w, levels.running_w);
}

Track percent_of(const Track& power, const PowerLevels& levels) {
    Track percent{.time_s = power.time_s, .value = power.value};
    for (double& value : percent.value) value = levels.percent(value);
    return percent;
}

/// Idle and running power, of a rotorcraft by its current; std::nullopt if they do not differ enough.
std::optional<PowerLevels> power_levels(const FlightData& data, const Track& altitude_m) {
    const auto& power = data.power_w;
    constexpr std::size_t enough = 20;
    if (power.time_s.size() < enough) return std::nullopt;
    const double low_m = quantile_of(altitude_m.value, 0.02);
    const double ground_m = low_m + std::max(3.0, 0.1 * (quantile_of(altitude_m.value, 0.98) - low_m));
    const auto at_m = resample(altitude_m, power.time_s);
    std::vector<double> on_ground_w;
    for (std::size_t i = 0; i < at_m.size(); ++i) {
        if (at_m[i] <= ground_m) on_ground_w.push_back(power.value[i]);
    }
    const double running_w = quantile_of(power.value, 0.98);
    if (data.firmware == "rotorcraft" && usual_effort(data.current_a.value) >= min_lifting_a)
        return PowerLevels{0.0, running_w};
    if (on_ground_w.size() < enough / 2) return std::nullopt;
    const PowerLevels levels{quantile_of(std::move(on_ground_w), 0.25), running_w};
    const bool differ = levels.running_w >= min_running_to_idle_ratio * levels.idle_w &&
                        levels.running_w >= levels.idle_w + min_running_above_idle_w;
    return differ ? std::optional(levels) : std::nullopt;
}

/// The motor's speed in percent of its full speed; empty if it is not measured, constant or too low.
MotorRecord record_of_motor_speed(const FlightData& data) {
    MotorRecord record;
    Track speed = data.motor_speed_rpm;
    if (speed.empty() || is_constant(speed)) return record;
    const double full_rpm = quantile_of(speed.value, 0.98);
    if (full_rpm < min_running_rpm) return record;
    for (auto& value : speed.value) value = std::min(units::percentage(value, full_rpm), units::percent_per_whole);
    record.indicator = MotorIndicator::motor_speed;
    record.evidence = fmt::format("{}: full {:.0f} rpm", speed.source, full_rpm);
    record.percent = std::move(speed);
    return record;
}

/// The power, if it is slow on the clock of a throttle that is not, linear between its samples.
Track power_of(const FlightData& data) {
    Track power = data.power_w;
    const auto& throttle_s = data.throttle_percent.time_s;
    if (!(median_interval_s(power.time_s) > slow_power_s) || throttle_s.empty() ||
        median_interval_s(throttle_s) > slow_power_s)
        return power;
    power.value = resample(power, throttle_s);
    power.time_s = throttle_s;
    return power;
}

/// The throttle on the clock of the power, or without power on its own.
Track throttle_of(const FlightData& data, const Track& power) {
    Track throttle = data.throttle_percent;
    if (throttle.empty() || power.empty()) return throttle;
    throttle.value = resample(throttle, power.time_s);
    throttle.time_s = power.time_s;
    return throttle;
}

/// Closes a throttle that opens for less than ten seconds while the power is idle. Returns the number of samples.
std::size_t remove_glitches(Track& throttle, const Track& power, const PowerLevels& levels, double idle_percent) {
    std::size_t count = 0;
    const auto& time_s = throttle.time_s;
    const auto opens = [&](std::size_t i) { return throttle.value[i] > idle_percent; };
    for (const auto& run : runs_of({0, time_s.size()}, opens)) {
        const auto has_power = [&](double power_w) { return levels.percent(power_w) > idle_power_percent; };
        const bool is_powered = std::ranges::any_of(part_of(power.value, run), has_power);
        if (time_s[run.end - 1] - time_s[run.begin] > glitch_s || is_powered) continue;
        set_part(throttle.value, run, 0.0);
        count += run.size();
    }
    return count;
}

/// Opens a VTOL's throttle, which is that of its wing's or of its lift motors alone, as far as the power shows that any
/// of them runs.
void add_other_motors(Track& throttle, const Track& power, const PowerLevels& levels) {
    for (std::size_t i = 0; i < throttle.value.size(); ++i)
        if (const double percent = levels.percent(power.value[i]); percent > idle_power_percent)
            throttle.value[i] = std::max(throttle.value[i], percent);
}

/// Replaces an idle throttle by the power if its levels are known, else by the motor's speed. Returns a warning.
std::string follow_motor(const FlightData& data, Track& throttle, const std::optional<PowerLevels>& levels,
                         double idle_percent) {
    MotorRecord motor;
    if (levels)
        motor.percent = percent_of(data.power_w, *levels);
    else
        motor = record_of_motor_speed(data);
    if (motor.percent.empty()) return "";
    motor.percent = {.time_s = throttle.time_s, .value = resample(motor.percent, throttle.time_s)};
    const SegmentationOptions limits;
    const auto replaced = replace_idle_throttle(
        throttle, idle_percent,
        levels ? MotorEvidence{motor.percent, idle_power_percent, flight_power_percent, data.ground_speed_m_per_s}
               : MotorEvidence{motor.percent, limits.idle_throttle_percent, limits.flight_throttle_percent,
                               data.ground_speed_m_per_s});
    if (!replaced) return "";
    const auto running = levels
                             ? fmt::format("the power is that of a running motor ({:.1f} W; idle {:.1f} W)",
                                           levels->power_w(replaced->mean_percent), levels->idle_w)
                             : fmt::format("the motor turns at {:.0f} % ({})", replaced->mean_percent, motor.evidence);
    return fmt::format("{} is idle while {}, for {:.0f} s in all, first from {:.0f} s: the latter is used there",
                       throttle.source, running, replaced->together_s, replaced->first_s);
}

}  // namespace

double usual_effort(std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::ranges::sort(values);
    const double half = 0.5 * quantile(values, 0.9);
    const auto high = std::ranges::upper_bound(values, half);
    return high == values.end() ? half : *(high + (values.end() - high) / 2);
}

MotorRecord motor_record(const FlightData& data, const Track& altitude_m) {
    MotorRecord record;
    const auto power = power_of(data);
    auto throttle = throttle_of(data, power);
    const auto levels = altitude_m.empty() ? std::nullopt : power_levels(data, altitude_m);
    const bool is_unused = is_constant(throttle);  // as of an autopilot without a throttle
    if (!throttle.empty() && !(is_unused && levels)) {
        record.indicator = MotorIndicator::throttle;
        record.evidence = throttle.source;
        const SegmentationOptions limits;
        const double idle_percent =
            std::min(std::max(*std::ranges::min_element(throttle.value), 0.0) + limits.idle_throttle_percent,
                     limits.flight_throttle_percent);
        if (levels) {
            const auto glitches = remove_glitches(throttle, power, *levels, idle_percent);
            if (glitches > 0) {
                record.warnings.push_back(
                    fmt::format("{} samples of the throttle are removed: it is open, but the power idle", glitches));
            }
            if (!data.vtol_state.empty()) {
                add_other_motors(throttle, power, *levels);
                record.evidence += fmt::format(" and {}", describe(*levels));
            }
        }
        auto contradiction = follow_motor(data, throttle, levels, idle_percent);
        if (!contradiction.empty()) record.warnings.push_back(std::move(contradiction));
        record.percent = std::move(throttle);
        return record;
    }
    const std::string no_throttle = throttle.empty() ? "no throttle" : "the throttle never changes";
    if (!levels) {
        record = record_of_motor_speed(data);
        if (!record.percent.empty()) {
            record.warnings.push_back(
                fmt::format("{} and no clear power: the motor runs by its speed ({})", no_throttle, record.evidence));
            return record;
        }
        record.evidence = "nothing";
        record.warnings.push_back(no_throttle + ": segmented by altitude only");
        return record;
    }
    record.indicator = MotorIndicator::power;
    record.evidence = describe(*levels);
    const double above_w = levels->power_w(idle_power_percent);
    if (data.firmware != "rotorcraft")  // in the air, these always draw much
        record.warnings.push_back(
            fmt::format("{}: the motor runs above {:.1f} W ({})", no_throttle, above_w, record.evidence));
    record.percent = percent_of(power, *levels);
    return record;
}

}  // namespace flightwatt::flight
