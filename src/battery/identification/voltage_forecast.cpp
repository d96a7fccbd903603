#include "battery/identification/voltage_forecast.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"
#include "battery/identified_battery.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace flightwatt::battery {
namespace {

constexpr double step_between_forecasts_s = 30.0;

/// Offset, resistance and slope of a flight against the battery's, from its samples so far.
class FlownCorrection {
  public:
    explicit FlownCorrection(const ModelledRecord& modelled, double resistance_sd = default_scatter_fraction)
        : modelled_(modelled), heat_a2s_(heat_a2s(*modelled.record)) {
        constexpr double slope_sd_v = 0.2;  // a cell, of the fall of the curve from full to empty
        const auto& battery = *modelled.battery;
        cells_ = battery.cells.value_or(1);
        const Eigen::Vector3d prior_sd(cells_ * chart_sd_v, resistance_sd, cells_ * slope_sd_v / battery.capacity_ah);
        prior_ = prior_sd.cwiseAbs2().cwiseInverse().asDiagonal();
        settled_a_ = rc_branch_current_a(*modelled.record, battery.thevenin.value().rc_time_constant_s);
        next_ = modelled.record->rest_samples;
    }

    /// Takes in the samples up to a time, from the first load on; returns whether there are any.
    bool follow(double until_s) {
        constexpr double memory_s = 20.0;          // a sample counts by exp(-age / memory_s)
        constexpr double sample_sd_v = 0.01;       // a cell, of the voltage about the circuit
        constexpr double sample_settling_s = 3.0;  // for which neighbours share that error
        const auto& record = *modelled_.record;
        for (; next_ < record.time_s.size() && record.time_s[next_] <= until_s; ++next_) {
            const double step_s = record.time_s[next_] - record.time_s[std::max<std::size_t>(next_, 1) - 1];
            const double decay = std::exp(-step_s / memory_s);
            const double share = record.used[next_] ? std::min(step_s / sample_settling_s, 1.0) : 0.0;
            const auto row = derivatives(next_);
            const Eigen::Vector3d weighted = share / std::pow(cells_ * sample_sd_v, 2) * row;
            information_ = decay * information_ + weighted * row.transpose();
            score_ = decay * score_ + (record.voltage_v[next_] - modelled_.voltage_v[next_]) * weighted;
        }
        return next_ > record.rest_samples;
    }

    Eigen::Matrix3d covariance() const { return (prior_ + information_).inverse(); }
    Eigen::Vector3d parameters() const { return covariance() * score_; }

    /// Derivatives of the voltage by offset [V], relative resistance and slope [V/Ah].
    Eigen::Vector3d derivatives(double load_v, double charge_ah) const {
        return {1.0, -load_v, modelled_.record->charge_ah[modelled_.record->rest_samples] - charge_ah};
    }
    Eigen::Vector3d derivatives(std::size_t i) const {
        return derivatives(load_voltage_v(i), modelled_.record->charge_ah[i]);
    }

    /// Over both resistances.
    double load_voltage_v(std::size_t i) const {
        const double warmed_ohm = warmed_resistance_ohm(*modelled_.battery, modelled_.warming_per_j, heat_a2s_[i]);
        return warmed_ohm * modelled_.record->current_a[i] + rc_voltage_v(i);
    }

    double heat(std::size_t i) const { return heat_a2s_[i]; }

    double rc_voltage_v(std::size_t i) const { return modelled_.battery->thevenin->rc_resistance_ohm * settled_a_[i]; }

  private:
    const ModelledRecord& modelled_;
    int cells_ = 1;
    std::vector<double> heat_a2s_;
    std::vector<double> settled_a_;
    Eigen::Matrix3d prior_;
    Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d score_ = Eigen::Vector3d::Zero();
    std::size_t next_ = 0;  ///< the first sample that is not known yet
};

/// Of a course: its parts end 5, 10, 20, 40 ... s after the first load.
std::size_t part_of_course(double since_s) {
    constexpr double first_s = 5.0;
    return static_cast<std::size_t>(std::ceil(std::max(0.0, std::log2(since_s / first_s))));
}

double course_power_w(const std::vector<double>& course_w, double since_s) {
    return course_w[std::min(part_of_course(since_s), course_w.size() - 1)];
}

/// Mean |error| [V] of a forecast from the sample `from` on, with a part of the course of others' power.
double forecast_error_v(const ModelledRecord& modelled, const FlownCorrection& flown, std::size_t from,
                        const std::vector<double>& course_w, double part) {
    auto battery = *modelled.battery;
    const auto& record = *modelled.record;
    const auto correction = flown.parameters();
    BatteryState state{modelled.soc_percent[from], flown.rc_voltage_v(from)};
    double charge_ah = record.charge_ah[from];
    double heat_a2s = flown.heat(from);
    double sum_v = 0.0;
    double count = 0.0;
    for (std::size_t i = from + 1; i < end_of_load(record); ++i) {
        const double step_s = record.time_s[i] - record.time_s[i - 1];
        battery.resistance_ohm = warmed_resistance_ohm(*modelled.battery, modelled.warming_per_j, heat_a2s);
        const double since_s = record.time_s[i] - record.time_s[record.rest_samples];
        const double current_a = limited_current_a(battery, part * course_power_w(course_w, since_s), state);
        heat_a2s += current_a * current_a * step_s;
        const double drawn_ah = units::ah_from_coulomb(current_a * step_s);
        charge_ah += drawn_ah;
        state.soc_percent -= units::percentage(drawn_ah, battery.capacity_ah);
        const double decay = std::exp(-step_s / battery.thevenin->rc_time_constant_s);
        state.rc_voltage_v =
            state.rc_voltage_v * decay + battery.thevenin->rc_resistance_ohm * current_a * (1.0 - decay);
        if (!record.used[i]) continue;
        const double predicted_v =
            terminal_voltage_v(battery, state, current_a) +
            flown.derivatives(battery.resistance_ohm * current_a + state.rc_voltage_v, charge_ah).dot(correction);
        sum_v += std::abs(record.voltage_v[i] - predicted_v);
        ++count;
    }
    return count > 0.0 ? sum_v / count : 0.0;
}

}  // namespace

std::size_t end_of_load(const DischargeRecord& record) {
    constexpr double loaded_fraction = 0.15;
    const double least_a = loaded_fraction * std::ranges::max(record.current_a);
    auto end = record.time_s.size();
    while (end > record.rest_samples && record.current_a[end - 1] < least_a) --end;
    return end;
}

std::vector<double> load_power_course_w(std::span<const DischargeRecord* const> records) {
    std::vector<double> energy_j;
    std::vector<double> duration_s;
    for (const auto* record : records) {
        for (auto i = record->rest_samples + 1; i < end_of_load(*record); ++i) {
            const double step_s = record->time_s[i] - record->time_s[i - 1];
            const auto part = part_of_course(record->time_s[i] - record->time_s[record->rest_samples]);
            energy_j.resize(std::max(energy_j.size(), part + 1));
            duration_s.resize(energy_j.size());
            energy_j[part] += record->voltage_v[i] * record->mean_current_a[i] * step_s;
            duration_s[part] += step_s;
        }
    }
    std::vector<double> course_w;
    for (std::size_t part = 0; part < energy_j.size(); ++part) {
        const double before_w = course_w.empty() ? 0.0 : course_w.back();
        course_w.push_back(duration_s[part] > 0.0 ? energy_j[part] / duration_s[part] : before_w);
    }
    return course_w;
}

std::vector<double> predict_voltage_ahead(const ModelledRecord& modelled, double ahead_s) {
    const auto& record = *modelled.record;
    FlownCorrection flown(modelled);
    auto voltage_v = modelled.voltage_v;
    for (auto i = record.rest_samples; i < voltage_v.size(); ++i)
        if (flown.follow(record.time_s[i] - ahead_s)) voltage_v[i] += flown.derivatives(i).dot(flown.parameters());
    return voltage_v;
}

RelativeResistance starting_resistance(const ModelledRecord& modelled) {
    const auto& battery = *modelled.battery;
    const auto& record = *modelled.record;
    const auto& scatter = battery.intervals.resistance_scatter;
    const double sd =
        scatter && battery.resistance_ohm > 0.0 ? scatter->sd_ohm / battery.resistance_ohm : default_scatter_fraction;
    const double flights = scatter ? static_cast<double>(scatter->flights) : 1.0;
    FlownCorrection started(modelled, sd * std::sqrt(1.0 + 1.0 / flights));
    started.follow(record.time_s[record.rest_samples] + start_s);
    constexpr double min_value = 0.1;
    const double value = std::max(min_value, 1.0 + started.parameters()[1]);
    const double error = std::sqrt(started.covariance()(1, 1)) / value;
    return {value, std::hypot(student_t_half_width(flights) * error, normal_half_width() * default_scatter_fraction)};
}

std::vector<double> voltage_half_widths_v(const ModelledRecord& modelled, const RelativeResistance& own) {
    const auto& battery = *modelled.battery;
    const auto& record = *modelled.record;
    const auto& [knots_percent, knots_v] = battery.thevenin.value().open_circuit;
    const FlownCorrection unknown(modelled);
    const auto& errors_v = battery.intervals.open_circuit_standard_error_v;
    const double charge_sd_percent = units::percentage(modelled.initial_charge_sd_ah, battery.capacity_ah);
    std::vector<double> half_v;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double soc_percent = modelled.soc_percent[i];
        const double charge_v = 0.5 * (interpolate_clamped(knots_percent, knots_v, soc_percent + charge_sd_percent) -
                                       interpolate_clamped(knots_percent, knots_v, soc_percent - charge_sd_percent));
        const double curve_v = errors_v.empty() ? 0.0 : interpolate_clamped(knots_percent, errors_v, soc_percent);
        half_v.push_back(std::hypot(normal_half_width() * std::hypot(charge_v, curve_v),
                                    own.half_width * unknown.load_voltage_v(i)));
    }
    return half_v;
}

std::optional<ForecastErrors> forecast_errors(const ModelledRecord& modelled, const std::vector<double>& course_w) {
    const auto& record = *modelled.record;
    const auto first = record.rest_samples;
    const auto end = end_of_load(record);
    if (end <= first || record.time_s[end - 1] - record.time_s[first] < 2.0 * step_between_forecasts_s)
        return std::nullopt;
    FlownCorrection flown(modelled);
    const auto started = flight::first_at_or_after(record.time_s, record.time_s[first] + start_s);
    ForecastErrors errors{forecast_error_v(modelled, flown, started, course_w, 1.0)};
    double forecasts = 0.0;
    double flown_j = course_w.back() * step_between_forecasts_s;
    double others_j = flown_j;
    for (auto i = first + 1; i + 1 < end; ++i) {
        const double step_s = record.time_s[i] - record.time_s[i - 1];
        flown_j += record.voltage_v[i] * record.mean_current_a[i] * step_s;
        const double since_s = record.time_s[i] - record.time_s[first];
        others_j += course_power_w(course_w, since_s) * step_s;
        if (since_s < (forecasts + 1.0) * step_between_forecasts_s) continue;
        flown.follow(record.time_s[i]);
        errors.updated_v += forecast_error_v(modelled, flown, i, course_w, flown_j / others_j);
        ++forecasts;
    }
    errors.updated_v /= std::max(1.0, forecasts);
    return errors;
}

}  // namespace flightwatt::battery
