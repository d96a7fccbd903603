#pragma once

#include "helpers/synthetic_discharge.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace flightwatt::test {

/// How a pack ages, from a resistance of 80 mohm and a capacity of 2.4 Ah.
struct Ageing {
    double ohm_a_day = 0.0;
    double part_a_day = 0.0;  ///< of its first capacity, that it loses
    std::size_t flights = 12;
    double days = 120.0;
};

/// Flights of a pack that ages, by their dates, and what was true of it in each.
struct AgedFlights {
    std::vector<double> day;
    std::vector<double> resistance_ohm;
    std::vector<double> capacity_ah;
    std::vector<battery::DischargeRecord> records;
};

/// Each begins with a full pack and draws 40 to 80 % of it.
inline AgedFlights aged_flights(const Ageing& ageing, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    AgedFlights aged;
    for (std::size_t f = 0; f < ageing.flights; ++f) aged.day.push_back(ageing.days * uniform(random));
    std::ranges::sort(aged.day);
    for (std::size_t f = 0; f < ageing.flights; ++f) {
        auto pack = known_pack();
        pack.resistance_ohm += ageing.ohm_a_day * aged.day[f];
        pack.capacity_ah *= 1.0 - ageing.part_a_day * aged.day[f];
        aged.resistance_ohm.push_back(pack.resistance_ohm);
        aged.capacity_ah.push_back(pack.capacity_ah);
        SyntheticDischarge settings;
        settings.duration_s = 265.0 + (0.4 + 0.4 * uniform(random)) * 2.4 * 3600.0 / 2.5;
        settings.interval_s = 2.2;
        aged.records.push_back(discharge_record(synthetic_discharge(pack, settings, 1000 * seed + f)));
    }
    return aged;
}

}  // namespace flightwatt::test
