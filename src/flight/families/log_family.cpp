#include "flight/families/log_family.h"

#include "flight/families/derived_tracks.h"
#include "flight/flight_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

using telemetry::Column;
using telemetry::MessageTable;

/// Tracks of which each battery has its own.
bool is_of_battery(std::string_view track) {
    constexpr std::string_view names[] = {"voltage_v", "current_a", "power_w",
                                          "charge_ah", "energy_wh", "battery_temperature_c"};
    return std::ranges::find(names, track) != std::end(names);
}

/// The instance of each row of a table. `numbered`: the log numbers them.
struct Instances {
    std::vector<double> of_row;
    std::vector<bool> counts;  ///< the row has a value: false for a position without a fix
    std::set<double> all = {};
    bool numbered = false;
};

Instances instances_of(const MessageTable& table, const LogFamily& family) {
    constexpr std::size_t max_instances = 16;
    const auto rows = table.time_s.size();
    Instances instances{std::vector<double>(rows, 0.0), std::vector<bool>(rows, true)};
    for (const auto& rule : family.messages) {
        if (table.message != rule.message) continue;
        const auto* number = rule.instance == nullptr ? nullptr : table.column(rule.instance);
        const auto* valid = rule.valid == nullptr ? nullptr : table.column(rule.valid);
        if (number != nullptr && !instances.numbered) instances.of_row = number->values;
        instances.numbered = instances.numbered || number != nullptr;
        for (std::size_t i = 0; valid != nullptr && i < rows; ++i)
            instances.counts[i] = instances.counts[i] && valid->values[i] >= rule.min_valid;
    }
    for (const double number : instances.of_row)
        if (!std::isnan(number) && instances.all.size() < max_instances) instances.all.insert(number);
    return instances;
}

/// A column of a log, and what turns its numbers into the track's unit.
struct BoundSource {
    const Column* column;
    double factor;
    double absent;
    std::string unit;  ///< that is assumed, as the log states none
};

/// The sources of a track in a table; empty if it lacks one, or has another quantity there.
std::vector<BoundSource> bound_sources(const MessageTable& table, const FamilyTrack& of, LogFamily::Unstated unstated) {
    std::vector<BoundSource> bound;
    for (const auto& source : of.sources) {
        const auto* column = table.column(source.field);
        if (column == nullptr) return {};
        const bool is_other = column->is_integer && source.integer_unit != nullptr;
        const auto* const text = is_other ? source.integer_unit : source.unit;
        const auto unit = units::parse_unit(text);
        const bool is_unused = !column->quantity && unstated == LogFamily::Unstated::unused;
        if (unit && (is_unused || column->quantity.value_or(unit->quantity) != unit->quantity)) return {};
        const double factor = !unit ? 1.0 : column->quantity ? std::copysign(1.0, unit->factor) : unit->factor;
        bound.push_back({column, factor, source.absent, column->quantity ? "" : text});
    }
    return bound;
}

/// "BARO.Alt", of further instances "BARO[1].Alt", of power "BAT.Volt * BAT.Curr". Batteries have their device.
std::string source_name(const FamilyTrack& of, const std::string& instance) {
    if (of.source != nullptr) return of.source;
    const bool is_further = !instance.empty() && instance != "0" && !is_of_battery(of.track);
    const auto message = of.message + (is_further ? fmt::format("[{}]", instance) : "");
    if (of.sources.size() < 2 || std::string_view(of.track) != "power_w")
        return fmt::format("{}.{}", message, of.sources.front().field);
    return fmt::format("{0}.{1} * {0}.{2}", message, of.sources[0].field, of.sources[1].field);
}

/// Adds the state 1 while one of the receivers has a 3D fix, and 0 while none has.
void add_fix(const FamilyTrack& of, const MessageTable& table, const Instances& receivers,
             const std::vector<double>& fix, std::vector<Track>& tracks) {
    std::set<double> fixed;
    std::vector<double> values(fix.size(), no_value);
    for (std::size_t i = 0; i < fix.size(); ++i) {
        const double receiver = receivers.of_row[i];
        if (std::isnan(fix[i]) || std::isnan(receiver)) continue;
        if (fix[i] >= min_fix)
            fixed.insert(receiver);
        else
            fixed.erase(receiver);
        values[i] = fixed.empty() ? 0.0 : 1.0;
    }
    tracks.push_back(make_candidate(of.track, source_name(of, ""), table, values, of.merge));
}

/// Adds wing flight where the message that is sent while lift motors run is absent for a second before the log ends.
void add_wing_flight(double log_end_s, Track& lifted) {
    constexpr double sent_s = 1.0;
    const auto times_s = std::exchange(lifted.time_s, {});
    lifted.value.clear();
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        lifted.time_s.push_back(times_s[i]);
        lifted.value.push_back(static_cast<double>(VtolState::hover));
        const double rests_s = times_s[i] + sent_s;
        if (rests_s >= (i + 1 < times_s.size() ? times_s[i + 1] : log_end_s)) continue;
        lifted.time_s.push_back(rests_s);
        lifted.value.push_back(static_cast<double>(VtolState::wing));
    }
}

double last_time_s(const telemetry::SenderLog& sender) {
    double last_s = -std::numeric_limits<double>::infinity();
    for (const auto& table : sender.tables)
        for (const double time_s : table.time_s) last_s = std::max(last_s, time_s);
    return last_s;
}

/// Adds the track of each instance.
void add_tracks(const FamilyTrack& of, const MessageTable& table, const Instances& instances,
                const std::vector<BoundSource>& sources, std::vector<Track>& tracks) {
    std::vector<double> row(sources.size());
    for (const double number : instances.all) {
        std::vector<double> values(table.time_s.size(), no_value);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (instances.of_row[i] != number || !instances.counts[i]) continue;
            std::ranges::transform(sources, row.begin(), [&](const BoundSource& source) {
                const double value = source.column->values[i];
                return value == source.absent ? no_value : value * source.factor;
            });
            values[i] = of.compute == nullptr ? row.front() : of.compute(row);
        }
        const auto instance = instances.numbered ? fmt::format("{}", number) : "";
        auto track = make_candidate(of.track, source_name(of, instance), table, values, of.merge);
        if (of.compute == if_stated_temperature || of.compute == if_vtol_state || of.compute == if_vtol_status) {
            if (track.empty()) continue;
            track.since_s = track.time_s.front();
        }
        if (is_of_battery(of.track)) track.device = of.device != nullptr ? of.device : instance;
        tracks.push_back(std::move(track));
    }
}

}  // namespace

std::map<std::string, double> monitor_parameters(const std::map<std::string, double>& parameters,
                                                 const std::vector<std::string>& first, const std::string& others) {
    constexpr int max_monitors = 9;
    std::map<std::string, double> values;
    const auto add = [&](int number, const std::string& name) {
        const auto found = parameters.find(name);
        if (found != parameters.end() && found->second > 0.0)
            values.emplace(fmt::format("{}", number - 1), found->second);
    };
    for (const auto& name : first) add(1, name);
    for (int number = 2; number <= max_monitors; ++number) {
        auto name = others;
        name.replace(name.find('N'), 1, std::to_string(number));
        add(number, name);
    }
    return values;
}

std::map<std::string, double> monitor_capacities_ah(const std::map<std::string, double>& parameters,
                                                    const std::vector<std::string>& first, const std::string& others) {
    constexpr double mah_per_ah = 1000.0;
    auto capacities_ah = monitor_parameters(parameters, first, others);
    for (auto& [id, capacity] : capacities_ah) capacity /= mah_per_ah;
    return capacities_ah;
}

std::set<std::string> add_family_tracks(const telemetry::SenderLog& sender, const LogFamily& family,
                                        const std::string& firmware, std::vector<Track>& tracks) {
    std::set<std::string> assumed;
    for (const auto& of : family.tracks) {
        const auto* table = sender.table(of.message);
        if (table == nullptr || (of.firmware != nullptr && of.firmware != firmware)) continue;
        const auto sources = bound_sources(*table, of, family.unstated_units);
        if (std::string_view(of.track) == "fix" && !sources.empty())
            add_fix(of, *table, instances_of(*table, family), sources.front().column->values, tracks);
        else if (!sources.empty())
            add_tracks(of, *table, instances_of(*table, family), sources, tracks);
        if (of.compute == lift_motors_run && !sources.empty() && !table->empty())
            add_wing_flight(last_time_s(sender), tracks.back());
        for (const auto& source : sources)
            if (std::string_view(of.track) == "power_w" && !source.unit.empty())
                assumed.insert(fmt::format("{}.{} is read in {}", of.message, source.column->field, source.unit));
    }
    return assumed;
}

double correct_week_rollover(double utc_s) {
    constexpr double gps_epoch_s = 315'964'800.0;
    constexpr double first_logs_s = 1'262'304'000.0;  // 2010
    constexpr double overflow_s = 1024.0 * 604'800.0;
    if (!(utc_s >= gps_epoch_s)) return no_value;
    return utc_s + overflow_s * std::max(std::ceil((first_logs_s - utc_s) / overflow_s), 0.0);
}

double if_stated_temperature(const std::vector<double>& row) {
    return row[0] == 0.0 || row[0] == -1.0 ? no_value : row[0];
}

double if_vtol_state(const std::vector<double>& row) { return row[0] > 0.0 ? row[0] : no_value; }

double if_vtol_status(const std::vector<double>& row) {
    if (row[0] == 0.0) return no_value;
    const auto state = row[2] != 0.0   ? row[3] != 0.0 ? VtolState::transition_to_wing : VtolState::transition_to_hover
                       : row[1] == 1.0 ? VtolState::hover
                                       : VtolState::wing;
    return static_cast<double>(state);
}

double lift_motors_run(const std::vector<double>& /*row*/) { return static_cast<double>(VtolState::hover); }

double product(const std::vector<double>& values) { return values[0] * values[1]; }

std::string firmware_of_type(double mav_type) {
    constexpr std::array rotorcraft{2.0, 3.0, 4.0, 13.0, 14.0, 15.0, 29.0, 35.0, 43.0};
    constexpr double fixed_wing = 1.0;
    constexpr double ground_rover = 10.0;
    constexpr double boat = 11.0;
    if (std::ranges::find(rotorcraft, mav_type) != rotorcraft.end()) return "rotorcraft";
    if (mav_type == fixed_wing) return "fixedwing";
    return mav_type == ground_rover || mav_type == boat ? "rover" : "";
}

double speed_of(const std::vector<double>& north_east) { return std::hypot(north_east[0], north_east[1]); }

void sort_tracks(std::vector<Track>& tracks) {
    const auto& names = track_names();
    std::ranges::stable_sort(tracks, {},
                             [&](const Track& track) { return std::ranges::find(names, track.name) - names.begin(); });
}

bool is_stated(double number) {
    constexpr double unknown_16_bit = 65535.0;
    return number > 0.0 && number != unknown_16_bit;
}

std::string joined_serials(const std::vector<double>& serials) {
    std::string joined;
    for (const auto serial : serials)
        if (is_stated(serial)) joined += fmt::format("{}{:.0f}", joined.empty() ? "" : "+", serial);
    return joined;
}

std::vector<telemetry::MessageRequest> family_messages(const LogFamily& family) {
    auto requests = family.more;
    const auto add = [&](const char* message, const char* field) {
        if (field == nullptr) return;
        auto found = std::ranges::find(requests, message, &telemetry::MessageRequest::message);
        if (found == requests.end()) found = requests.insert(found, {message, {}});
        if (std::ranges::find(found->fields, field) == found->fields.end()) found->fields.emplace_back(field);
    };
    for (const auto& track : family.tracks)
        for (const auto& source : track.sources) add(track.message, source.field);
    for (const auto& rule : family.messages) {
        add(rule.message, rule.instance);
        add(rule.message, rule.valid);
    }
    return requests;
}

}  // namespace flightwatt::flight
