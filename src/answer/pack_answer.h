#pragma once

#include "answer/answered.h"
#include "answer/flight_facts.h"
#include "base/statistics.h"
#include "battery/battery.h"
#include "battery/discharge_record.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

/// The pack that flights were flown on: from their voltage and current, and the capacity that is given or logged.
namespace flightwatt::answer {

/// What is known of a pack.
struct PackAnswer {
    Answered capacity_ah;
    std::optional<Interval> flights_capacity_ah = {};  ///< by the flights themselves, 95 %
    Answered resistance_ohm = {};
    std::optional<Interval> resistance_interval_ohm = {};  ///< 95 %
    std::optional<Interval> air_temperature_c = {};        ///< of the flights' means; absent where no log states one
    std::optional<Interval> battery_start_c = {};          ///< of the battery at take-off; likewise
    std::optional<double> asked_temperature_c = {};        ///< for set_temperature()
    Answered resistance_at_ohm = {};                       ///< at that temperature
    std::optional<Interval> resistance_at_interval_ohm = {};
    std::optional<double> known_down_to_percent = {};  ///< of its charge; below, the voltage is assumed
};

/// Returns why no time in the air is known with a pack: its capacity, or its resistance at the temperature that is asked
/// for. Empty where both are known.
inline const std::string& missing_of(const PackAnswer& pack) {
    return pack.capacity_ah.value ? pack.resistance_at_ohm.unknown : pack.capacity_ah.unknown;
}

/// A pack for missions, with the answer about it.
struct FoundPack {
    battery::Battery battery;
    PackAnswer answer;
    std::optional<battery::BatteryIdentification> identified = {};  ///< absent for a constant voltage
    std::vector<std::string> warnings = {};
};

/// A pack's capacity, and where it is from.
struct CapacityChoice {
    std::optional<double> value_ah = {};
    std::string basis = {};
    bool is_logged = false;    ///< stated by the logs, not by the user
    std::string warning = {};  ///< of logs that state different ones
};

/// Returns the given capacity, else what the logs state where all agree, else none.
CapacityChoice choose_capacity(const std::optional<double>& given_ah, const std::vector<FlightFacts>& facts);

/// Uses of a pack that are identified together, which takes time with their square.
inline constexpr std::size_t max_identified_uses = 60;

/// Returns the numbers of the discharges that a pack is identified from: all, or of more than `most` (two or more)
/// so many evenly chosen ones, the fullest and the one that drew the most.
std::vector<std::size_t> identified_records(std::span<const battery::DischargeRecord> records,
                                            std::size_t most = max_identified_uses);

/// Returns whether most of the flights that alone indicate a capacity, of some evenly chosen ones, agree with this one;
/// absent where none indicates one. Flights of several packs, or of one that aged, together indicate what none has.
std::optional<bool> do_most_agree(std::span<const battery::DischargeRecord> records, double capacity_ah);

/// Returns the pack that the discharges of flights determine. A logged capacity that contradicts them is not used, with
/// a warning, unless most flights alone agree with it; without one it is unknown where most flights alone disagree with
/// what they indicate together. Where they determine no circuit, it has the flights' mean voltage until it is empty.
/// Throws NoResultError where that needs a capacity or a voltage that is unknown, and UsageError for a given capacity
/// below what was drawn.
FoundPack find_pack(std::span<const battery::DischargeRecord> records, const std::string& no_records_reason,
                    CapacityChoice capacity, const std::vector<FlightFacts>& facts);

}  // namespace flightwatt::answer
