#pragma once

#include "battery/identification.h"
#include "helpers/sample_columns.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace flightwatt::test {

/// A flight as a telemetry log would show it, of a battery that is known.
struct SyntheticDischarge {
    double duration_s = 1400.0;
    double cruise_a = 2.5;
    double gusts_a = 0.9;            ///< standard deviation of the current in cruise
    double gust_s = 8.0;             ///< how long a gust lasts
    double interval_s = 1.1;         ///< of the telemetry
    double voltage_noise_v = 0.010;  ///< standard deviation
    double voltage_step_v = 0.006;   ///< what the voltage is rounded to
    double current_noise_a = 0.02;
    double current_step_a = 0.004;
    double lost_fraction = 0.1;        ///< of the samples, and a gap of 15 s now and then
    double initial_charge_ah = 0.0;    ///< missing when it begins
    double slow_resistance_ohm = 0.0;  ///< a second RC pair, as packs relax for an hour
    double slow_time_constant_s = 900.0;
    double initial_slow_v = 0.0;  ///< not yet relaxed from the flight before
};

/// Rest, run-up, take-off at 8 A, a cruise in gusts, a descent with the motor off, and rest; the battery is
/// stepped every 0.1 s through exact solutions for constant current.
inline SampleColumns discharge_columns(const battery::Battery& battery, const SyntheticDischarge& settings,
                                       std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    SampleColumns series;
    constexpr double step_s = 0.1;
    constexpr double as_per_ah = 3600.0;
    const auto& circuit = battery.thevenin.value();
    const double decay = std::exp(-step_s / circuit.rc_time_constant_s);
    const double gust_decay = std::exp(-step_s / settings.gust_s);
    double charge_ah = 0.0;
    double rc_v = 0.0;
    double slow_v = settings.initial_slow_v;
    const double slow_decay = std::exp(-step_s / settings.slow_time_constant_s);
    double gust_a = 0.0;
    double due_s = 0.0;
    double lost_until_s = 0.0;
    const auto rounded = [](double value, double to) { return std::round(value / to) * to; };
    for (double time_s = 0.0; time_s < settings.duration_s; time_s += step_s) {
        gust_a = gust_a * gust_decay + settings.gusts_a * std::sqrt(1.0 - gust_decay * gust_decay) * normal(random);
        const double left_s = settings.duration_s - time_s;
        double current_a = 0.03;
        if (time_s > 40.0 && time_s < 43.0) current_a = 4.0;
        if (time_s > 80.0 && time_s < 105.0) current_a = 8.0;
        if (time_s >= 105.0 && left_s > 160.0) current_a = std::max(0.2, settings.cruise_a + gust_a);
        if (time_s >= due_s) {
            due_s += settings.interval_s;
            if (uniform(random) < 0.005) lost_until_s = time_s + 15.0;
            if (time_s > lost_until_s && uniform(random) > settings.lost_fraction) {
                const double soc = 100.0 - 100.0 * (settings.initial_charge_ah + charge_ah) / battery.capacity_ah;
                const double voltage_v = terminal_voltage_v(battery, {soc, rc_v + slow_v}, current_a);
                series.time_s.push_back(time_s);
                series.voltage_v.push_back(
                    rounded(voltage_v + settings.voltage_noise_v * normal(random), settings.voltage_step_v));
                series.current_a.push_back(
                    rounded(current_a + settings.current_noise_a * normal(random), settings.current_step_a));
                series.power_w.push_back(series.voltage_v.back() * series.current_a.back());
                series.charge_ah.push_back(rounded(charge_ah, 1e-6));
            }
        }
        charge_ah += current_a * step_s / as_per_ah;
        slow_v = slow_v * slow_decay + settings.slow_resistance_ohm * current_a * (1.0 - slow_decay);
        rc_v = rc_v * decay + circuit.rc_resistance_ohm * current_a * (1.0 - decay);
    }
    return series;
}

/// The same as a series "synthetic_SEED".
inline flight::FlightSeries synthetic_discharge(const battery::Battery& battery, const SyntheticDischarge& settings,
                                                std::uint64_t seed) {
    return series_of(discharge_columns(battery, settings, seed), "synthetic_" + std::to_string(seed));
}

/// A pack of three cells, smoothly curved as LiPo is: knots every 2 %.
inline battery::Battery known_pack() {
    battery::Battery pack{"known", 0.0, 0.08, 2.4};
    battery::TheveninCircuit circuit;
    for (int i = 0; i <= 50; ++i) {
        const double s = i / 50.0;
        circuit.open_circuit.soc_percent.push_back(100.0 * s);
        circuit.open_circuit.voltage_v.push_back(3.0 *
                                                 (3.62 + 0.20 * s + 0.30 * s * s * s - 0.35 * std::exp(-s / 0.05)));
    }
    circuit.rc_resistance_ohm = 0.05;
    circuit.rc_time_constant_s = 35.0;
    pack.thevenin = circuit;
    return pack;
}

/// The one record of a log in which one pack was flown.
inline battery::DischargeRecord discharge_record(const flight::FlightSeries& series) {
    return battery::discharge_records(select_tracks(series)).records.at(0);
}

}  // namespace flightwatt::test
