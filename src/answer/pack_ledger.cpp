#include "answer/pack_ledger.h"

#include "base/error.h"
#include "base/units.h"
#include "battery/identification.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace flightwatt::answer {
namespace {

using Numbers = std::vector<std::size_t>;

/// Of the capacity: a use that begins with less missing began full, and two charges this near are the same.
constexpr double same_charge_part = 0.1;

double end_s(const PackUse& use) { return *use.start_s + use.record.time_s.back() - use.record.time_s.front(); }

double half_width_ah(const PackUse& use) {
    const auto& interval = use.found->initial_charge_interval_ah;
    return (interval.high - interval.low) / 2.0;
}

double start_charge_percent(const PackUse& use) {
    return units::percent_per_whole - units::percentage(use.found->initial_depletion_ah, use.mean_capacity_ah);
}

/// Rest voltages more than this factor apart are of packs with other numbers of cells: one cell rests between 3.0 and
/// 4.35 V.
constexpr double other_cells_factor = 1.45;

std::vector<Numbers> divided_by_cells(const std::vector<PackUse>& uses, Numbers numbers) {
    const auto rest_v = [&](std::size_t i) { return uses[i].record.resting_voltage_v; };
    std::ranges::sort(numbers, {}, rest_v);
    std::vector<Numbers> parts(1);
    for (const auto i : numbers) {
        if (!parts.back().empty() && rest_v(i) > other_cells_factor * rest_v(parts.back().back())) parts.emplace_back();
        parts.back().push_back(i);
    }
    for (auto& part : parts) std::ranges::sort(part);
    return parts;
}

/// Two groups by resistance, where two packs were flown in turn: the groups' medians differ by more than one pack does
/// in the weather of a few days, each flight's interval excludes the other's median, and the order changes three times
/// within days. A pack that ages or meets a winter changes once. Empty where that is not so.
std::vector<Numbers> divided_by_resistance(const std::vector<PackUse>& uses, const Numbers& numbers) {
    constexpr double other_pack_factor = 1.5;
    constexpr std::size_t least_changes = 3;
    constexpr double same_weather_s = 2.0 * seconds_per_day;
    Numbers known;
    for (const auto i : numbers)
        if (uses[i].found && uses[i].found->resistance) known.push_back(i);
    if (known.size() < least_changes + 1 || known.size() < numbers.size()) return {};
    const auto ohm = [&](std::size_t i) { return uses[i].found->resistance->value_ohm; };
    auto sorted = known;
    std::ranges::sort(sorted, {}, ohm);
    std::size_t cut = 1;
    for (std::size_t i = 2; i < sorted.size(); ++i)
        if (ohm(sorted[i]) * ohm(sorted[cut - 1]) > ohm(sorted[cut]) * ohm(sorted[i - 1])) cut = i;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(cut);
    std::vector<Numbers> parts{{sorted.begin(), middle}, {middle, sorted.end()}};
    const double low_ohm = ohm(parts[0][parts[0].size() / 2]);
    const double high_ohm = ohm(parts[1][parts[1].size() / 2]);
    const auto& interval = [&](std::size_t i) -> const Interval& { return uses[i].found->resistance->interval_ohm; };
    const bool are_apart = high_ohm > other_pack_factor * low_ohm &&
                           std::ranges::all_of(parts[0], [&](std::size_t i) { return interval(i).high < high_ohm; }) &&
                           std::ranges::all_of(parts[1], [&](std::size_t i) { return interval(i).low > low_ohm; });
    if (!are_apart) return {};
    for (auto& part : parts) std::ranges::sort(part);
    const auto is_low = [&](std::size_t i) { return std::ranges::binary_search(parts[0], i); };
    std::size_t changes = 0;
    for (std::size_t i = 1; i < known.size(); ++i) {
        const auto& before_s = uses[known[i - 1]].start_s;
        const auto& start_s = uses[known[i]].start_s;
        if (before_s && start_s && *start_s - *before_s < same_weather_s && is_low(known[i - 1]) != is_low(known[i]))
            ++changes;
    }
    return changes >= least_changes ? parts : std::vector<Numbers>{};
}

/// A pack at rest keeps its charge for longer, but may then have been charged or stored.
constexpr double followed_s = seconds_per_day;

/// Whether `use` begins, at rest and minutes to hours later, at the charge at which `before` ended, not full.
bool goes_on_from(const PackUse& use, const PackUse& before) {
    if (!use.found || !before.found) return false;
    const double apart_s = *use.start_s - end_s(before);
    const double same_ah = same_charge_part * use.mean_capacity_ah;
    const double missing_ah = use.found->initial_depletion_ah;
    const double left_ah = before.found->initial_depletion_ah + before.found->drawn_ah;
    return apart_s >= 0.0 && apart_s < followed_s && half_width_ah(use) < same_ah && missing_ah > same_ah &&
           std::abs(missing_ah - left_ah) < same_ah;
}

/// Finds the uses that begin where exactly one other ended, of a named pack the one before.
void follow_charge(std::vector<PackUse>& uses, const Numbers& numbers, bool is_one_pack) {
    std::set<std::size_t> taken;
    for (std::size_t k = 1; k < numbers.size(); ++k) {
        auto& use = uses[numbers[k]];
        Numbers found;
        for (auto before = k; before-- > 0 && (!is_one_pack || before + 1 == k);) {
            const auto& other = uses[numbers[before]];
            if (!use.start_s || !other.start_s || *use.start_s - *other.start_s > 2.0 * followed_s) break;
            if (!taken.contains(numbers[before]) && goes_on_from(use, other)) found.push_back(numbers[before]);
        }
        if (found.size() != 1) continue;
        use.continues = uses[found.front()].flight;
        taken.insert(found.front());
    }
}

/// Whether an identification is of these records and this given capacity.
bool is_of(const battery::BatteryIdentification& found, const std::vector<battery::DischargeRecord>& records,
           const std::optional<double>& capacity_ah) {
    return capacity_ah == found.capacity.value_ah && found.capacity.origin == battery::CapacityOrigin::given &&
           std::ranges::equal(found.flights, records, {}, &battery::IdentifiedFlight::flight,
                              &battery::DischargeRecord::flight);
}

/// One group of uses, which is identified as a whole.
class Identifier {
  public:
    Identifier(PackLedger& ledger, const LedgerOptions& options) : ledger_(ledger), options_(options) {}

    void add(Pack pack) {
        const auto found = identify(pack);
        const auto parts =
            pack.named_by == PackNaming::none ? divided_by_resistance(ledger_.uses, pack.uses) : std::vector<Numbers>{};
        if (parts.empty()) return finish(pack, found);
        note(pack, "two packs, flown in turn, are divided by their resistances");
        for (const auto& part : parts) {
            auto one = pack;
            one.uses = part;
            one.name = fmt::format("unnamed, {:.3g} mohm", median_ohm(part) / units::milli);
            const auto own = identify(one);
            finish(one, own);
        }
    }

  private:
    double median_ohm(const Numbers& numbers) {
        std::vector<double> ohm;
        for (const auto i : numbers) ohm.push_back(ledger_.uses[i].found->resistance->value_ohm);
        return median(std::move(ohm));
    }

    void note(const Pack& pack, const std::string& text) {
        ledger_.notes.push_back(fmt::format(
            "{}: {}", pack.named_by == PackNaming::none ? pack.aircraft.front() : "pack " + pack.name, text));
    }

    std::optional<battery::BatteryIdentification> identify(Pack& pack) {
        std::vector<battery::DischargeRecord> records;
        for (const auto i : pack.uses) records.push_back(ledger_.uses[i].record);
        Numbers numbers;
        for (const auto k : identified_records(records, options_.max_uses)) {
            if (k > numbers.size()) records[numbers.size()] = std::move(records[k]);
            numbers.push_back(pack.uses[k]);
        }
        records.resize(numbers.size());
        if (numbers.size() < pack.uses.size())
            note(pack,
                 fmt::format("resistance and capacity are of {} of its {} flights: some evenly chosen, the fullest "
                             "and the deepest",
                             numbers.size(), pack.uses.size()));
        battery::IdentificationOptions options{pack.label_ah ? pack.label_ah : options_.capacity_ah, {}, "", true};
        std::optional<battery::BatteryIdentification> found;
        const bool is_known = options_.known != nullptr && is_of(*options_.known, records, options.capacity_ah);
        try {
            found = is_known ? *options_.known : identify_battery(records, options);
        } catch (const NoResultError& error) {
            note(pack, fmt::format("no resistances and no capacities: {}", error.what()));
            return std::nullopt;
        } catch (const UsageError&) {
            if (!pack.label_ah) throw;
            note(pack, fmt::format("its flights drew more than the {} Ah of its label: the label is wrong, or a flight "
                                   "is of another pack",
                                   *pack.label_ah));
            options.capacity_ah.reset();
            found = identify_battery(records, options);
        }
        if (!is_known) leave_out_mixed_capacity(pack, records, *found);
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            ledger_.uses[numbers[k]].found = found->flights.at(k);
            ledger_.uses[numbers[k]].mean_capacity_ah = found->capacity.value_ah;
        }
        note_capacities(pack, *found);
        return found;
    }

    /// Of flights that together indicate what most of them alone do not.
    void leave_out_mixed_capacity(const Pack& pack, const std::vector<battery::DischargeRecord>& records,
                                  battery::BatteryIdentification& found) {
        const auto estimate = found.battery.flight_estimate;
        if (!estimate || do_most_agree(records, estimate->capacity_ah).value_or(true)) return;
        note(pack, fmt::format("its capacity is unknown: together its flights indicate {:.3g} Ah, with which most of "
                               "them alone disagree, as where a pack aged",
                               estimate->capacity_ah));
        found.battery.flight_estimate = nullptr;
    }

    void note_capacities(const Pack& pack, const battery::BatteryIdentification& found) {
        const auto unknown = std::ranges::count_if(found.flights, [](const auto& flight) { return !flight.capacity; });
        if (found.flights.size() == 1 && unknown > 0)
            note(pack, "a single flight does not determine a capacity");
        else if (unknown > 0)
            note(pack, fmt::format("no capacity of {} of {} flights: their charge does not determine it within 15 %",
                                   unknown, found.flights.size()));
        else if (found.flights.size() > 1 && found.capacity.origin == battery::CapacityOrigin::chart)
            note(pack, "the mean capacity is a guess from charts of lithium cells; give it with --capacity");
    }

    void finish(Pack& pack, const std::optional<battery::BatteryIdentification>& found);

    PackLedger& ledger_;
    const LedgerOptions& options_;
};

/// The temperature by which uses are compared: the battery's where one of them states it, else the air's.
std::optional<double> battery::IdentifiedFlight::*temperature_of(const std::vector<PackUse>& uses,
                                                                 const Numbers& numbers) {
    const bool is_of_battery =
        std::ranges::any_of(numbers, [&](std::size_t i) { return uses[i].found && uses[i].found->battery_start_c; });
    return is_of_battery ? &battery::IdentifiedFlight::battery_start_c : &battery::IdentifiedFlight::air_temperature_c;
}

/// The coldest of those temperatures, at most like_temperature_k from each other, that are the most, of as many the
/// warmest: over a wider span a pack that cools over the weeks, its resistance rising by some 3 % a kelvin, looks worn.
double coldest_of_like(std::vector<double> temperatures_c) {
    std::ranges::sort(temperatures_c);
    double coldest_c = 0.0;
    std::ptrdiff_t most = 0;
    for (auto first = temperatures_c.begin(); first != temperatures_c.end(); ++first) {
        const auto count = std::upper_bound(first, temperatures_c.end(), *first + like_temperature_k) - first;
        if (count < most) continue;
        most = count;
        coldest_c = *first;
    }
    return coldest_c;
}

/// The uses that are like each other in temperature and charge.
Numbers like_uses(const std::vector<PackUse>& uses, const Numbers& numbers) {
    const auto temperature_c = temperature_of(uses, numbers);
    std::vector<double> temperatures_c;
    std::vector<double> charges_percent;
    for (const auto i : numbers) {
        if (!uses[i].found || !uses[i].found->resistance) continue;
        charges_percent.push_back(start_charge_percent(uses[i]));
        if (const auto& own_c = (*uses[i].found).*temperature_c) temperatures_c.push_back(*own_c);
    }
    Numbers like;
    if (charges_percent.empty()) return like;
    const double charge_percent = median(charges_percent);
    const double coldest_c = coldest_of_like(std::move(temperatures_c));
    for (const auto i : numbers) {
        if (!uses[i].found || !uses[i].found->resistance) continue;
        const auto& own_c = (*uses[i].found).*temperature_c;
        if (std::abs(start_charge_percent(uses[i]) - charge_percent) <= like_charge_percent &&
            (!own_c || (*own_c >= coldest_c && *own_c <= coldest_c + like_temperature_k)))
            like.push_back(i);
    }
    return like;
}

/// The trend of a value; its change is of the sum with a value that all uses have in common.
PackTrend trend_of(const std::vector<PackUse>& uses, const Numbers& numbers,
                   const std::function<std::optional<double>(const PackUse&)>& value_of, double in_common = 0.0) {
    std::vector<batch::DatedValue> values;
    std::vector<double> days;
    for (const auto i : numbers) {
        const auto value = value_of(uses[i]);
        if (!value || !uses[i].start_s) continue;
        days.push_back(*uses[i].start_s / seconds_per_day);
        values.push_back({days.back(), *value});
    }
    PackTrend trend{batch::estimate_trend(values), 0.0, 0.0, 0.0, {}, {}};
    if (values.empty()) trend.answer.no_trend_reason = "no flight with a date determines it";
    if (!trend.answer.trend) return trend;
    const auto& slope = *trend.answer.trend;
    trend.first_day = days.front();
    trend.last_day = days.back();
    const double middle_day = median(days);
    std::vector<double> levels;
    levels.reserve(values.size());
    for (const auto& [day, value] : values) levels.push_back(value - slope.per_day * (day - middle_day));
    const double level = median(std::move(levels));
    const auto change = [&](double per_day) {
        const double first = in_common + level + per_day * (trend.first_day - middle_day);
        return units::percentage(per_day * (trend.last_day - trend.first_day),
                                 std::max(first, 1e-3 * (in_common + level)));
    };
    trend.last_value = level + slope.per_day * (trend.last_day - middle_day);
    trend.change_percent = change(slope.per_day);
    trend.change_interval_percent = Interval{change(slope.low_per_day), change(slope.high_per_day)};
    return trend;
}

/// All flights have one resistance of the RC pair, so that their own series resistances change by what it changes too:
/// the change is of the sum. Of the series resistance alone, a rise of both by 58 % was one by 101 %.
void add_resistance(const std::vector<PackUse>& uses, double rc_resistance_ohm, Pack& pack) {
    constexpr std::size_t last_uses = 5;
    const auto like = like_uses(uses, pack.uses);
    pack.resistance = trend_of(
        uses, like, [](const PackUse& use) { return use.found->resistance->value_ohm; }, rc_resistance_ohm);
    if (like.empty()) return;
    std::vector<double> ohm;
    const auto temperature_c = temperature_of(uses, pack.uses);
    std::vector<double> temperatures_c;
    std::vector<double> charge_percent;
    double variance = 0.0;
    for (auto k = like.size() - std::min(last_uses, like.size()); k < like.size(); ++k) {
        const auto& found = *uses[like[k]].found;
        ohm.push_back(found.resistance->value_ohm);
        variance += std::pow(found.resistance->standard_error_ohm, 2);
        charge_percent.push_back(start_charge_percent(uses[like[k]]));
        if (const auto& own_c = found.*temperature_c) temperatures_c.push_back(*own_c);
    }
    const auto n = static_cast<double>(ohm.size());
    pack.resistance_ohm = mean(ohm);
    pack.start_charge_percent = mean(charge_percent);
    if (!temperatures_c.empty()) {
        pack.temperature_c = mean(temperatures_c);
        pack.temperature_of = temperature_c == &battery::IdentifiedFlight::battery_start_c ? "battery" : "air";
    }
    if (ohm.size() == 1) {
        pack.resistance_interval_ohm = uses[like.back()].found->resistance->interval_ohm;
        return;
    }
    const double half_ohm =
        student_t_half_width(n - 1.0) * std::sqrt(std::max(variance / (n * n), sample_variance(ohm) / n));
    pack.resistance_interval_ohm =
        Interval{std::max(0.0, *pack.resistance_ohm - half_ohm), *pack.resistance_ohm + half_ohm};
}

void add_totals(const std::vector<PackUse>& uses, Pack& pack) {
    std::set<std::string> aircraft;
    std::vector<double> rest_v;
    for (const auto i : pack.uses) {
        const auto& use = uses[i];
        const auto& record = use.record;
        aircraft.insert(use.aircraft);
        if (use.start_s) {
            pack.first_s = pack.first_s.value_or(*use.start_s);
            pack.last_s = *use.start_s;
        }
        for (std::size_t k = 1; k < record.time_s.size(); ++k)
            pack.energy_wh +=
                0.5 * (record.voltage_v[k - 1] + record.voltage_v[k]) * (record.charge_ah[k] - record.charge_ah[k - 1]);
        pack.charge_ah += record.charge_ah.back() - record.charge_ah.front();
        if (use.cycles) pack.cycles = use.cycles;
        if (!use.continues.empty()) ++pack.partly_used;
        if (use.found && use.found->initial_depletion_ah < same_charge_part * use.mean_capacity_ah)
            rest_v.push_back(use.found->resting_voltage_v);
    }
    pack.aircraft.assign(aircraft.begin(), aircraft.end());
    if (rest_v.empty()) return;
    pack.rest_voltage_v = mean(rest_v);
    pack.rest_voltage_spread_v = std::ranges::max(rest_v) - std::ranges::min(rest_v);
}

std::string interval_text(const Interval& interval, int decimals) {
    return fmt::format("{:.{}f} to {:.{}f}", interval.low, decimals, interval.high, decimals);
}

/// "+24 % in 120 days (12 to 37)".
std::string change_text(const PackTrend& trend) {
    return fmt::format("{:+.0f} % in {:.0f} days ({})", *trend.change_percent, trend.last_day - trend.first_day,
                       interval_text(*trend.change_interval_percent, 0));
}

PackCondition condition_of_resistance(const Pack& pack) {
    if (!pack.resistance_ohm) return {PackHealth::unknown, "no resistance is known"};
    if (!pack.resistance.change_percent) {
        const auto& why = pack.resistance.answer.no_trend_reason;
        return {PackHealth::unknown, "whether its resistance rises is unknown: " + why};
    }
    const auto& [low, high] = *pack.resistance.change_interval_percent;
    const auto text = "resistance " + change_text(pack.resistance);
    if (low >= retire_rise_percent) return {PackHealth::retire, text};
    if (low > 0.0 && *pack.resistance.change_percent >= watch_rise_percent) return {PackHealth::watch, text};
    if (high < retire_rise_percent) return {PackHealth::healthy, text};
    return {PackHealth::unknown, text + ": the flights do not exclude that it has doubled"};
}

/// What the capacity adds; healthy where it is unknown or proves nothing.
PackCondition condition_of_capacity(const Pack& pack) {
    const auto graded = [](double percent, double high_percent, std::string text) -> PackCondition {
        if (high_percent < retire_capacity_percent) return {PackHealth::retire, std::move(text)};
        const bool is_low = percent < watch_capacity_percent && high_percent < units::percent_per_whole;
        return {is_low ? PackHealth::watch : PackHealth::healthy, std::move(text)};
    };
    PackCondition by_trend{PackHealth::healthy, ""};
    if (pack.capacity.change_percent)
        by_trend = graded(units::percent_per_whole + *pack.capacity.change_percent,
                          units::percent_per_whole + pack.capacity.change_interval_percent->high,
                          "capacity " + change_text(pack.capacity));
    constexpr double vague_factor = 2.0;  // between the ends of an interval that is too wide for a comparison
    const auto& interval_ah = pack.capacity_interval_ah;
    if (!pack.label_ah || !interval_ah || interval_ah->high > vague_factor * interval_ah->low) return by_trend;
    auto by_label = graded(units::percentage(*pack.capacity_ah, *pack.label_ah),
                           units::percentage(pack.capacity_interval_ah->high, *pack.label_ah),
                           fmt::format("capacity {:.3g} Ah ({}) of {:g} Ah", *pack.capacity_ah,
                                       interval_text(*pack.capacity_interval_ah, 2), *pack.label_ah));
    return by_label.health < by_trend.health ? by_trend : by_label;
}

PackCondition condition_of(const Pack& pack) {
    auto condition = condition_of_resistance(pack);
    const auto capacity = condition_of_capacity(pack);
    if (capacity.health > PackHealth::healthy && capacity.health >= condition.health)
        condition = {capacity.health, capacity.reason + "; " + condition.reason};
    else if (!capacity.reason.empty())
        condition.reason += "; " + capacity.reason;
    if (!pack.may_be_several) return condition;
    if (condition.health == PackHealth::retire) condition.health = PackHealth::watch;
    if (pack.uses.size() > 1) condition.reason += "; if these flights are of one pack: nothing names their packs";
    return condition;
}

void Identifier::finish(Pack& pack, const std::optional<battery::BatteryIdentification>& found) {
    auto& uses = ledger_.uses;
    follow_charge(uses, pack.uses, pack.named_by != PackNaming::none);
    add_totals(uses, pack);
    if (pack.named_by == PackNaming::none) pack.may_be_several = pack.partly_used + 1 < pack.uses.size();
    if (found) {
        pack.cells = found->cells;
        if (const auto& estimate = found->battery.flight_estimate) {
            pack.capacity_ah = estimate->capacity_ah;
            pack.capacity_interval_ah = estimate->capacity_interval_ah;
        }
        pack.equivalent_cycles = pack.charge_ah / found->capacity.value_ah;
    }
    const auto* circuit = found && found->battery.thevenin ? &*found->battery.thevenin : nullptr;
    add_resistance(uses, circuit != nullptr ? circuit->rc_resistance_ohm : 0.0, pack);
    pack.capacity = trend_of(uses, like_uses(uses, pack.uses), [](const PackUse& use) -> std::optional<double> {
        if (!use.found || !use.found->capacity) return std::nullopt;
        return use.found->capacity->ratio * units::percent_per_whole;
    });
    pack.condition = condition_of(pack);
    ledger_.packs.push_back(std::move(pack));
}

}  // namespace

std::string to_string(PackHealth health) {
    switch (health) {
        case PackHealth::healthy:
            return "healthy";
        case PackHealth::watch:
            return "watch";
        case PackHealth::retire:
            return "retire";
        case PackHealth::unknown:
            break;
    }
    return "unknown";
}

std::string day_text(double day) {
    return fmt::format("{:%Y-%m-%d}", fmt::gmtime(static_cast<std::time_t>(day * seconds_per_day)));
}

PackLedger make_pack_ledger(std::vector<PackUse> uses, const LedgerOptions& options) {
    PackLedger ledger{std::move(uses), {}, {}};
    std::ranges::stable_sort(ledger.uses, {}, &PackUse::start_s);
    std::map<std::pair<std::string, std::string>, Numbers> groups;  // by pack, or aircraft of an unnamed one
    for (std::size_t i = 0; i < ledger.uses.size(); ++i) {
        const auto& use = ledger.uses[i];
        groups[{use.pack, use.pack.empty() ? use.aircraft : ""}].push_back(i);
    }
    for (const auto& [key, numbers] : groups) {
        const auto& first = ledger.uses[numbers.front()];
        Pack pack;
        pack.name = key.first.empty() ? "unnamed" : key.first;
        pack.named_by = first.named_by;
        pack.label_ah = first.label_ah;
        pack.aircraft = {first.aircraft};
        auto parts = key.first.empty() ? divided_by_cells(ledger.uses, numbers) : std::vector<Numbers>{numbers};
        for (auto& part : parts) {
            pack.uses = std::move(part);
            Identifier(ledger, options).add(pack);
        }
    }
    return ledger;
}

std::string capacity_doubt(const std::vector<Pack>& packs) {
    if (packs.size() > 1) return " of several packs, which may have much less: --pack NAME answers for one";
    const bool is_doubtful = !packs.empty() && packs.front().may_be_several && packs.front().uses.size() > 1;
    return is_doubtful ? ", if of one pack" : "";
}

std::string describe(const Pack& pack) {
    const bool is_named = pack.named_by != PackNaming::none;
    auto text = fmt::format("pack {}{}: {}: ", pack.name, is_named ? "" : " of " + pack.aircraft.front(),
                            to_string(pack.condition.health));
    if (pack.resistance_ohm)
        text += fmt::format(
            "{:.3g} mohm ({:.3g} to {:.3g}{}), ", *pack.resistance_ohm / units::milli,
            pack.resistance_interval_ohm->low / units::milli, pack.resistance_interval_ohm->high / units::milli,
            pack.temperature_c ? fmt::format(", {} {:.0f} degC", pack.temperature_of, *pack.temperature_c)
                               : ", temperature unknown");
    text += pack.condition.reason;
    if (!pack.mission_until.empty()) text += "; the mission: " + pack.mission_until;
    return text;
}

}  // namespace flightwatt::answer
