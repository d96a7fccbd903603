#include "answer/pack_answer.h"

#include "base/error.h"
#include "battery/identification.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::answer {
namespace {

/// The mean voltage of the cruises, each counting the same.
std::optional<double> mean_voltage_v(const std::vector<FlightFacts>& facts) {
    double sum_v = 0.0;
    double count = 0.0;
    for (const auto& flight : facts) {
        if (!flight.mean_voltage_v) continue;
        sum_v += *flight.mean_voltage_v;
        count += 1.0;
    }
    return count > 0.0 ? std::optional(sum_v / count) : std::nullopt;
}

/// A pack of constant voltage, as the flights determine no circuit for that reason.
FoundPack constant_pack(const std::string& reason, const CapacityChoice& capacity,
                        const std::vector<FlightFacts>& facts) {
    const auto voltage_v = mean_voltage_v(facts);
    if (!voltage_v)
        throw NoResultError(reason + "; no log has the pack's voltage, which a flight with a battery monitor shows");
    if (!capacity.value_ah) throw NoResultError(reason + "; give the capacity on the pack's label: --capacity AH");
    FoundPack pack;
    pack.battery.name = "pack";
    pack.battery.voltage_v = *voltage_v;
    pack.battery.capacity_ah = *capacity.value_ah;
    std::vector<std::vector<flight::MonitorShare>> monitors;
    monitors.reserve(facts.size());
    for (const auto& flight : facts) monitors.push_back(flight.monitors);
    pack.battery.monitors = battery::common_monitors(monitors);
    pack.answer.capacity_ah = known(*capacity.value_ah, capacity.basis);
    pack.answer.resistance_ohm = unknown(reason);
    pack.warnings.push_back(
        fmt::format("the pack is assumed to have {:.1f} V until it is empty: {}", *voltage_v, reason));
    return pack;
}

/// The lowest and the highest of a temperature of the flights; absent where no log states it.
std::optional<Interval> range_c(const battery::BatteryIdentification& identified,
                                std::optional<double> battery::IdentifiedFlight::*temperature_c) {
    std::optional<Interval> range;
    for (const auto& flight : identified.flights) {
        if (const auto& own_c = flight.*temperature_c)
            range = range ? Interval{std::min(range->low, *own_c), std::max(range->high, *own_c)}
                          : Interval{*own_c, *own_c};
    }
    return range;
}

/// Flights that leave more than this factor between the ends of its interval do not determine a capacity.
constexpr double max_capacity_ratio = 3.0;

/// The default of ArduPilot's BATT_CAPACITY.
constexpr double factory_capacity_ah = 3.3;

/// Without a basis the flights' own estimate is the capacity, where they determine one.
FoundPack identified_pack(battery::BatteryIdentification identified, const std::string& basis = {}) {
    FoundPack pack;
    pack.battery = identified.battery;
    if (const auto& estimate = identified.battery.flight_estimate)
        pack.answer.flights_capacity_ah = estimate->capacity_interval_ah;
    const auto& interval = pack.answer.flights_capacity_ah;
    const bool is_unknown = basis.empty() && (!interval || interval->high > max_capacity_ratio * interval->low);
    pack.answer.capacity_ah =
        is_unknown ? unknown(
                         "the flights use too little of the pack; one from a full pack to below a third shows its "
                         "capacity, or give that on its label: --capacity AH")
                   : known(identified.battery.capacity_ah, basis.empty() ? "estimated from the flights" : basis);
    const auto flights = identified.flights.size();
    pack.answer.resistance_interval_ohm = identified.errors.resistance_ohm;
    pack.answer.resistance_ohm =
        identified.errors.resistance_ohm.low > 0.0
            ? known(identified.fit.resistance_ohm,
                    fmt::format("measured on {} flight{}", flights, flights == 1 ? "" : "s"))
            : unknown("its interval reaches 0; a log from before take-off, with a climb at full power, shows it");
    pack.answer.air_temperature_c = range_c(identified, &battery::IdentifiedFlight::air_temperature_c);
    pack.answer.battery_start_c = range_c(identified, &battery::IdentifiedFlight::battery_start_c);
    pack.answer.known_down_to_percent = identified.observed_min_soc_percent;
    if (auto warning = capacity_warning(identified.battery); !warning.empty())
        pack.warnings.push_back(std::move(warning));
    pack.identified = std::move(identified);
    return pack;
}

/// The pack by the flights alone, whose capacity is unknown where most of them do not agree with what they indicate
/// together.
FoundPack estimated_pack(std::span<const battery::DischargeRecord> records,
                         const battery::IdentificationOptions& options) {
    auto pack = identified_pack(identify_battery(records, options));
    auto& capacity = pack.answer.capacity_ah;
    if (!capacity.value || do_most_agree(records, *capacity.value).value_or(true)) return pack;
    capacity = unknown(
        fmt::format("together the flights indicate {:.3g} Ah, with which most of them alone disagree: they are of "
                    "several packs, or of one that aged; give the capacity on the pack's label: --capacity AH",
                    *capacity.value));
    pack.answer.flights_capacity_ah.reset();
    pack.battery.flight_estimate = nullptr;
    if (pack.identified) pack.identified->battery.flight_estimate = nullptr;
    return pack;
}

/// The pack with a stated capacity, with which most flights alone agree, though not all together.
FoundPack stated_pack(battery::BatteryIdentification identified, const CapacityChoice& capacity) {
    const auto together = std::exchange(identified.battery.flight_estimate, nullptr);
    auto pack = identified_pack(std::move(identified), capacity.basis);
    pack.warnings.push_back(fmt::format(
        "the flights together indicate {:.3g} Ah, but most of them alone agree with {:.3g} Ah, which is used: they are "
        "of several packs, or of one that aged; --since and --pack choose flights of one",
        together->capacity_ah, *capacity.value_ah));
    return pack;
}

}  // namespace

CapacityChoice choose_capacity(const std::optional<double>& given_ah, const std::vector<FlightFacts>& facts) {
    if (given_ah) return {given_ah, "as given"};
    std::set<double> logged_ah;
    for (const auto& flight : facts)
        if (flight.stated_capacity_ah) logged_ah.insert(*flight.stated_capacity_ah);
    if (logged_ah.empty()) return {};
    if (logged_ah == std::set{factory_capacity_ah}) {
        CapacityChoice unset;
        unset.warning = fmt::format(
            "the logs' parameters state {} Ah, the default of ArduPilot's BATT_CAPACITY: it is not used; "
            "--capacity AH states that on the pack's label",
            factory_capacity_ah);
        return unset;
    }
    if (logged_ah.size() == 1)
        return {*logged_ah.begin(), "by the logs' parameters (BATT_CAPACITY, BAT1_CAPACITY)", true};
    CapacityChoice none;
    none.warning =
        fmt::format("the logs' parameters state capacities of {:.4g} Ah: none is used; --capacity AH states it",
                    fmt::join(logged_ah, " and "));
    return none;
}

std::vector<std::size_t> identified_records(std::span<const battery::DischargeRecord> records, std::size_t most) {
    std::set<std::size_t> kept;
    for (std::size_t i = 0; i < std::min(records.size(), most); ++i)
        kept.insert(records.size() <= most ? i : i * (records.size() - 1) / (most - 1));
    if (records.size() > most) {
        const auto drawn_ah = [](const battery::DischargeRecord& record) { return record.charge_ah.back(); };
        const auto fullest = std::ranges::max_element(records, {}, &battery::DischargeRecord::resting_voltage_v);
        kept.insert({static_cast<std::size_t>(fullest - records.begin()),
                     static_cast<std::size_t>(std::ranges::max_element(records, {}, drawn_ah) - records.begin())});
    }
    return {kept.begin(), kept.end()};
}

std::optional<bool> do_most_agree(std::span<const battery::DischargeRecord> records, double capacity_ah) {
    constexpr std::size_t most_asked = 5;
    if (records.size() < 2) return std::nullopt;
    std::size_t indicating = 0;
    std::size_t agreeing = 0;
    for (const auto i : identified_records(records, most_asked)) {
        try {
            const auto alone = identify_battery(records.subspan(i, 1), {});
            const auto& estimate = alone.battery.flight_estimate;
            if (!estimate) continue;
            const auto& [low_ah, high_ah] = estimate->capacity_interval_ah;
            ++indicating;
            if (low_ah <= capacity_ah && capacity_ah <= high_ah) ++agreeing;
        } catch (const NoResultError&) {
            continue;
        } catch (const UsageError&) {
            continue;
        }
    }
    return indicating == 0 ? std::nullopt : std::optional(2 * agreeing >= indicating);
}

FoundPack find_pack(std::span<const battery::DischargeRecord> all, const std::string& no_records_reason,
                    CapacityChoice capacity, const std::vector<FlightFacts>& facts) {
    if (all.empty()) return constant_pack(no_records_reason, capacity, facts);
    std::vector<battery::DischargeRecord> records;
    for (const auto i : identified_records(all)) records.push_back(all[i]);
    battery::IdentificationOptions options;
    options.capacity_ah = capacity.value_ah;
    options.name = "pack";
    options.with_capacities = true;
    std::string contradiction;
    try {
        try {
            if (!capacity.value_ah) return estimated_pack(records, options);
            auto identified = identify_battery(records, options);
            const bool is_contradicted = estimated_by_flights(identified.battery).has_value();
            if (is_contradicted && do_most_agree(records, *capacity.value_ah).value_or(false))
                return stated_pack(std::move(identified), capacity);
            if (!capacity.is_logged || !is_contradicted) return identified_pack(std::move(identified), capacity.basis);
            contradiction = capacity_warning(identified.battery);
        } catch (const UsageError& error) {
            if (!capacity.is_logged) throw;
            contradiction = error.what();
        }
        options.capacity_ah.reset();
        auto pack = estimated_pack(records, options);
        pack.warnings.push_back(
            fmt::format("the logs' capacity of {:.3g} Ah is not used: {}", *capacity.value_ah, contradiction));
        return pack;
    } catch (const NoResultError& error) {
        return constant_pack(error.what(), capacity, facts);
    }
}

}  // namespace flightwatt::answer
