#pragma once

#include "answer/pack_answer.h"
#include "answer/pack_names.h"
#include "base/statistics.h"
#include "batch/trend.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::answer {

/// Flights are like each other within so many kelvins, the range of default_scatter_fraction, where logs state a
/// temperature (battery::resistance_fall_per_k).
inline constexpr double like_temperature_k = 8.0;
/// And within this of the state of charge at their start: over that range the series resistance is almost flat.
inline constexpr double like_charge_percent = 35.0;
/// A pack whose resistance has doubled delivers half the power at the same sag: the usual end of its life in flight.
inline constexpr double retire_rise_percent = 100.0;
/// Twice what one pack differs from flight to flight (default_scatter_fraction).
inline constexpr double watch_rise_percent = 30.0;
/// The usual end of life of traction batteries: 80 % of the label.
inline constexpr double retire_capacity_percent = 80.0;
/// Packs are often sold a few percent below their label.
inline constexpr double watch_capacity_percent = 90.0;

enum class PackHealth { unknown, healthy, watch, retire };

std::string to_string(PackHealth health);

/// The health of a pack with its reason.
struct PackCondition {
    PackHealth health = PackHealth::unknown;
    std::string reason;
};

/// A quantity over the dates of a pack's uses.
struct PackTrend {
    batch::TrendResult answer;
    double first_day = 0.0;  ///< since 1970
    double last_day = 0.0;
    double last_value = 0.0;                          ///< of the trend's line on the last day
    std::optional<double> change_percent;             ///< from the first day to the last
    std::optional<Interval> change_interval_percent;  ///< 95 %
};

/// One pack, or flights that may be of several.
struct Pack {
    std::string name;  ///< "unnamed" where nothing names it
    PackNaming named_by = PackNaming::none;
    bool may_be_several = false;
    std::vector<std::string> aircraft;
    std::vector<std::size_t> uses;  ///< numbers in PackLedger::uses, by date
    std::optional<double> first_s;  ///< Unix times of the first and last dated use
    std::optional<double> last_s;
    double energy_wh = 0.0;  ///< drawn in these uses
    double charge_ah = 0.0;
    std::optional<double> cycles;             ///< as the last log states
    std::optional<double> equivalent_cycles;  ///< charge drawn over the capacity
    std::size_t partly_used = 0;              ///< uses that begin where another one ended
    std::optional<int> cells;
    std::optional<double> resistance_ohm;  ///< mean of the last like uses, five at most
    std::optional<Interval> resistance_interval_ohm;
    std::optional<double> temperature_c;         ///< in these; unknown where no log states it
    std::string temperature_of;                  ///< "battery" (at take-off) or "air"; empty where unknown
    std::optional<double> start_charge_percent;  ///< at their start
    PackTrend resistance;                        ///< of like uses
    std::optional<double> label_ah;
    std::optional<double> capacity_ah;  ///< by the flights, not by the label
    std::optional<Interval> capacity_interval_ah;
    PackTrend capacity;                           ///< of percentages of the mean
    std::optional<double> rest_voltage_v;         ///< before uses that begin full: mean
    std::optional<double> rest_voltage_spread_v;  ///< highest less lowest
    PackCondition condition;
    std::string mission_until;  ///< see mission_life(); empty without a mission
};

struct LedgerOptions {
    std::optional<double> capacity_ah;  ///< the label of packs without one
    std::size_t max_uses = max_identified_uses;
    /// One of the same uses, with the capacities of its flights, by capacity_ah; it is not made again.
    const battery::BatteryIdentification* known = nullptr;
};

struct PackLedger {
    std::vector<PackUse> uses;  ///< by date; those of an unknown date first
    std::vector<Pack> packs;
    std::vector<std::string> notes;  ///< why something is unknown
};

/// The packs of uses that name_packs() has named, each with its history and health. Unnamed uses of an aircraft are
/// one entry that may be of several packs, divided only where voltage or resistance prove two (docs/guide.md). Throws
/// UsageError where flights draw more than LedgerOptions::capacity_ah.
PackLedger make_pack_ledger(std::vector<PackUse> uses, const LedgerOptions& options = {});

/// Returns what to add to the basis of a capacity that flights indicate: flights of packs that differ by 8 % can indicate
/// half more than either has. Empty where they are of one pack, or a single flight.
std::string capacity_doubt(const std::vector<Pack>& packs);

/// "pack A1: watch: resistance 31 mohm (29 to 33) ..." in one line.
std::string describe(const Pack& pack);

/// "2026-03-05".
std::string day_text(double day);

inline constexpr double seconds_per_day = 86400.0;

}  // namespace flightwatt::answer
