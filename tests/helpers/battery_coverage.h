#pragma once

#include "base/error.h"
#include "battery/identification.h"
#include "helpers/synthetic_discharge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// How often the intervals of identified batteries hold the truth, over synthetic flights of packs that begin at 40 to
/// 100 % of their charge.
namespace flightwatt::test {

/// Whose open-circuit voltage a pack has.
enum class PackCurve {
    known,    ///< known_pack's
    polymer,  ///< Chen and Rincon-Mora 2006, a cell
    nmc,      ///< LG M50, Chen et al. 2020: both electrodes' potentials between 2.5 and 4.2 V
    high,     ///< ours: the polymer cell charged to 4.35 V
    straight  ///< of the synthetic logs: 12.5 V falling by 1.4 V
};

inline std::string to_string(PackCurve curve) {
    return std::array{"known", "polymer", "nmc", "high", "straight"}.at(static_cast<std::size_t>(curve));
}

inline double nmc_cell_v(double s) {
    const double anode = std::lerp(0.0279, 0.9014, s);
    const double cathode = std::lerp(0.9084, 0.2661, s);
    const auto step = [](double x, double height, double steepness, double at) {
        return height * std::tanh(steepness * (x - at));
    };
    return 4.4875 - 0.8090 * cathode - step(cathode, 0.0428, 18.5138, 0.5542) -
           step(cathode, 17.7326, 15.7890, 0.3117) + step(cathode, 17.5842, 15.9308, 0.3120) -
           (1.9793 * std::exp(-39.3631 * anode) + 0.2482 - step(anode, 0.0909, 29.8538, 0.1234) -
            step(anode, 0.04478, 14.9159, 0.2769) - step(anode, 0.0205, 30.4444, 0.6103));
}

inline double polymer_cell_v(double s) {
    return -1.031 * std::exp(-35.0 * s) + 3.685 + 0.2156 * s - 0.1178 * s * s + 0.3201 * s * s * s;
}

inline double pack_voltage_v(PackCurve curve, double s) {
    if (curve == PackCurve::straight) return 11.1 + 1.4 * s;
    if (curve == PackCurve::polymer) return 3.0 * polymer_cell_v(s);
    if (curve == PackCurve::nmc) return 3.0 * nmc_cell_v(s);
    if (curve == PackCurve::high) return 3.0 * (polymer_cell_v(s) + 0.247 * s * s * s);
    return open_circuit_voltage_v(known_pack(), 100.0 * s);
}

struct BatteryCase {
    PackCurve curve = PackCurve::known;
    std::size_t flights = 3;
    bool begins_full = false;  ///< the first of them
    bool capacity_given = false;
    double resistance_spread = 0.0;    ///< of a flight's resistances, as a part: standard deviation
    double slow_resistance_ohm = 0.0;  ///< of a second RC pair of 900 s that no model has
};

/// Counts over packs, sums over flights.
struct BatteryCoverage {
    std::size_t packs = 0;
    std::size_t flights = 0;
    std::size_t capacities_held = 0;
    std::size_t initial_charges_held = 0;
    std::size_t all_initial_charges_held = 0;  ///< of packs: of all their flights
    std::size_t without_answer = 0;
    std::vector<double> capacity_width_percent;  ///< of the interval, of the capacity
    std::vector<double> capacity_error_percent;
    std::vector<double> initial_width_percent;
};

inline battery::Battery drawn_pack(PackCurve curve, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform;
    auto pack = known_pack();
    pack.capacity_ah = 1.6 + 1.6 * uniform(random);
    pack.resistance_ohm = 0.05 + 0.08 * uniform(random);
    pack.thevenin->rc_resistance_ohm = 0.02 + 0.05 * uniform(random);
    pack.thevenin->rc_time_constant_s = 15.0 + 45.0 * uniform(random);
    auto& [soc, volts] = pack.thevenin->open_circuit;
    for (std::size_t i = 0; i < soc.size(); ++i) volts[i] = pack_voltage_v(curve, soc[i] / 100.0);
    return pack;
}

/// The flights of a seed's pack, and what was missing when each began.
struct DrawnFlights {
    battery::Battery pack;
    std::vector<battery::DischargeRecord> records;
    std::vector<double> initial_charge_ah;
};

inline DrawnFlights drawn_flights(const BatteryCase& made, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> normal;
    DrawnFlights drawn;
    drawn.pack = drawn_pack(made.curve, random);
    for (std::size_t f = 0; f < made.flights; ++f) {
        const bool is_full = f == 0 && made.begins_full;
        const double left = is_full ? 1.0 : 0.4 + 0.6 * uniform(random);
        const double flown = std::min(left - 0.05, 0.15 + 0.3 * uniform(random));
        SyntheticDischarge settings;
        settings.initial_charge_ah = (1.0 - left) * drawn.pack.capacity_ah;
        settings.duration_s = 265.0 + std::max(200.0, (flown * drawn.pack.capacity_ah - 0.06) * 3600.0 / 2.5);
        settings.slow_resistance_ohm = made.slow_resistance_ohm;
        auto pack = drawn.pack;
        pack.resistance_ohm *= std::max(0.3, 1.0 + made.resistance_spread * normal(random));
        drawn.records.push_back(discharge_record(synthetic_discharge(pack, settings, 1000 * seed + f)));
        drawn.initial_charge_ah.push_back(settings.initial_charge_ah);
    }
    return drawn;
}

inline BatteryCoverage battery_coverage(const BatteryCase& made, std::uint64_t first_seed, std::size_t seeds) {
    BatteryCoverage coverage;
    for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
        const auto drawn = drawn_flights(made, seed);
        battery::IdentificationOptions options;
        options.cells = 3;
        if (made.capacity_given) options.capacity_ah = drawn.pack.capacity_ah;
        ++coverage.packs;
        const double whole_ah = drawn.pack.capacity_ah;
        const auto width_percent = [&](const Interval& range) { return 100.0 * (range.high - range.low) / whole_ah; };
        const auto holds = [](const Interval& range, double truth) {
            return truth >= range.low - 1e-9 && truth <= range.high + 1e-9;
        };
        try {
            const auto found = identify_battery(drawn.records, options);
            if (const auto& range = found.capacity.interval_ah) {
                coverage.capacities_held += holds(*range, whole_ah) ? 1 : 0;
                coverage.capacity_width_percent.push_back(width_percent(*range));
                coverage.capacity_error_percent.push_back(100.0 * (found.capacity.value_ah / whole_ah - 1.0));
            }
            bool all = true;
            for (std::size_t f = 0; f < drawn.records.size(); ++f) {
                const auto& range = found.flights[f].initial_charge_interval_ah;
                const bool held = holds(range, drawn.initial_charge_ah[f]);
                all = all && held;
                coverage.initial_charges_held += held ? 1 : 0;
                coverage.initial_width_percent.push_back(width_percent(range));
                ++coverage.flights;
            }
            coverage.all_initial_charges_held += all ? 1 : 0;
        } catch (const NoResultError&) {
            ++coverage.without_answer;
        }
    }
    return coverage;
}

}  // namespace flightwatt::test
