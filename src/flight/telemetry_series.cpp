#include "flight/telemetry_series.h"

#include "base/error.h"
#include "base/units.h"
#include "flight/segmentation.h"
#include "flight/sources/power_source.h"
#include "flight/track.h"
#include "telemetry/data_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

using units::Quantity;

/// A channel that may come from several fields, the best first.
struct Candidate {
    const char* message;
    const char* field;
    Quantity quantity;
};

struct FoundTrack {
    Track track;
    std::string source;
};

/// The column of a candidate, if the sender sent it with that quantity.
std::optional<FoundTrack> find_track(const telemetry::SenderLog& sender, const Candidate& candidate,
                                     Merge merge) {
    const auto* table = sender.table(candidate.message);
    const auto* column = table == nullptr ? nullptr : table->column(candidate.field);
    if (column == nullptr || column->quantity != candidate.quantity) return std::nullopt;
    auto track = make_track(table->time_s, column->values, merge);
    if (track.empty()) return std::nullopt;
    return FoundTrack{std::move(track), fmt::format("{}.{}", candidate.message, candidate.field)};
}

/// The first candidate that varies, else the first that is there at all.
FoundTrack choose_track(const telemetry::SenderLog& sender, const std::vector<Candidate>& candidates,
                        Merge merge) {
    FoundTrack constant;
    for (const auto& candidate : candidates) {
        auto found = find_track(sender, candidate, merge);
        if (!found) continue;
        if (!is_constant(found->track)) return std::move(*found);
        if (constant.source.empty()) constant = std::move(*found);
    }
    return constant;
}

FoundTrack altitude_of(const telemetry::SenderLog& sender) {
    return choose_track(sender,
                        {{"ESTIMATOR", "z", Quantity::metre},
                         {"ROTORCRAFT_FP", "up", Quantity::metre},
                         {"GPS", "alt", Quantity::metre},
                         {"GPS_INT", "hmsl", Quantity::metre},
                         {"AIR_DATA", "amsl_baro", Quantity::metre}},
                        Merge::mean);
}

FoundTrack throttle_of(const telemetry::SenderLog& sender) {
    auto found = choose_track(
        sender, {{"ENERGY", "throttle", Quantity::percent}, {"BAT", "throttle", Quantity::percent}},
        Merge::mean);
    if (!found.source.empty()) return found;
    // Rotorcraft before 2018: thrust, without a unit, on Paparazzi's command scale.
    const auto* table = sender.table("ROTORCRAFT_FP");
    const auto* thrust = table == nullptr ? nullptr : table->column("thrust");
    if (thrust == nullptr) return {};
    auto track = make_track(table->time_s, thrust->values, Merge::mean);
    for (auto& value : track.value) value = units::percent_from_pprz(value);
    return {std::move(track), "ROTORCRAFT_FP.thrust"};
}

FoundTrack ground_speed_of(const telemetry::SenderLog& sender) {
    if (auto speed = find_track(sender, {"GPS", "speed", Quantity::metre_per_second}, Merge::mean)) {
        return std::move(*speed);
    }
    const auto* table = sender.table("GPS_INT");
    if (table == nullptr) return {};
    const auto* x = table->column("ecef_xd");
    const auto* y = table->column("ecef_yd");
    const auto* z = table->column("ecef_zd");
    if (x == nullptr || y == nullptr || z == nullptr) return {};
    std::vector<double> speed(x->values.size());
    for (std::size_t i = 0; i < speed.size(); ++i) {
        speed[i] = std::hypot(x->values[i], y->values[i], z->values[i]);
    }
    return {make_track(table->time_s, speed, Merge::mean), "GPS_INT.ecef velocity"};
}

/// The wind's speed as the aircraft estimates it; 0 east and 0 north says that it does not know yet.
Track wind_of(const telemetry::SenderLog& sender) {
    const auto* table = sender.table("WIND_INFO");
    if (table == nullptr) return {};
    const auto* east = table->column("east");
    const auto* north = table->column("north");
    if (east == nullptr || north == nullptr) return {};
    if (east->quantity != Quantity::metre_per_second || north->quantity != Quantity::metre_per_second) {
        return {};
    }
    std::vector<double> speed;
    for (std::size_t i = 0; i < east->values.size(); ++i) {
        const double value = std::hypot(east->values[i], north->values[i]);
        speed.push_back(value > 0.0 ? value : std::numeric_limits<double>::quiet_NaN());  // nan is dropped
    }
    return make_track(table->time_s, speed, Merge::mean);
}

/// Puts a channel onto the power clock and remembers where it came from.
void add_channel(FlightSeries& series, std::vector<double> FlightSeries::*channel, const char* name,
                 const FoundTrack& found) {
    if (found.track.empty()) return;
    series.*channel = resample(found.track, series.time_s);
    series.sources[name] = found.source;
}

/// The pack's current, or else the sum of what its consumers report.
FoundTrack current_of(const telemetry::SenderLog& sender) {
    auto found = choose_track(sender,
                              {{"ENERGY", "current", Quantity::ampere},
                               {"ENERGY", "amp", Quantity::ampere},
                               {"BAT", "amps", Quantity::ampere}},
                              Merge::mean);
    if (!found.track.empty()) return found;
    auto sum = summed_current(sender);
    return {std::move(sum.current_a), std::move(sum.source)};
}

void add_channels(FlightSeries& series, const telemetry::SenderLog& sender) {
    const auto altitude = altitude_of(sender);
    series.altitude_track = altitude.track;
    add_channel(series, &FlightSeries::altitude_m, "altitude_m", altitude);
    add_channel(series, &FlightSeries::throttle_percent, "throttle_percent", throttle_of(sender));
    add_channel(series, &FlightSeries::voltage_v, "voltage_v",
                choose_track(sender,
                             {{"ENERGY", "voltage", Quantity::volt},
                              {"ENERGY", "bat", Quantity::volt},
                              {"BAT", "voltage", Quantity::volt},
                              {"ESC", "bat_volts", Quantity::volt},
                              {"POWER_DEVICE", "voltage", Quantity::volt}},
                             Merge::mean));
    add_channel(series, &FlightSeries::current_a, "current_a", current_of(sender));
    add_channel(series, &FlightSeries::charge_ah, "charge_ah",
                choose_track(sender,
                             {{"ENERGY", "charge", Quantity::ampere_hour},
                              {"ENERGY", "energy", Quantity::ampere_hour},
                              {"BAT", "energy", Quantity::ampere_hour}},
                             Merge::latest));
    add_channel(series, &FlightSeries::energy_wh, "energy_wh",
                choose_track(sender, {{"ENERGY", "energy", Quantity::watt_hour}}, Merge::latest));
    add_channel(series, &FlightSeries::east_m, "east_m",
                choose_track(sender,
                             {{"NAVIGATION", "pos_x", Quantity::metre},
                              {"ROTORCRAFT_FP", "east", Quantity::metre},
                              {"GPS", "utm_east", Quantity::metre}},
                             Merge::mean));
    add_channel(series, &FlightSeries::north_m, "north_m",
                choose_track(sender,
                             {{"NAVIGATION", "pos_y", Quantity::metre},
                              {"ROTORCRAFT_FP", "north", Quantity::metre},
                              {"GPS", "utm_north", Quantity::metre}},
                             Merge::mean));
    const auto speed = ground_speed_of(sender);
    series.ground_speed_track = speed.track;
    add_channel(series, &FlightSeries::ground_speed_m_per_s, "ground_speed_m_per_s", speed);
    auto airspeed = choose_track(sender,
                                 {{"AIRSPEED", "airspeed", Quantity::metre_per_second},
                                  {"AIR_DATA", "airspeed", Quantity::metre_per_second}},
                                 Merge::mean);
    // An aircraft without a sensor says the same throughout: 0 or -1.
    if (!is_constant(airspeed.track)) series.airspeed_track = std::move(airspeed.track);
    series.wind_speed_track = wind_of(sender);
}

/// Modes and blocks have no unit.
Track state_track(const telemetry::SenderLog& sender, const char* message, const char* field) {
    const auto* table = sender.table(message);
    const auto* column = table == nullptr ? nullptr : table->column(field);
    return column == nullptr ? Track{} : make_track(table->time_s, column->values, Merge::latest);
}

void add_witnesses(FlightSeries& series, const telemetry::SenderLog& sender) {
    if (const auto* takeoff = sender.table("TAKEOFF")) series.witnesses.takeoff_s = takeoff->time_s;
    series.witnesses.mode = state_track(sender, "PPRZ_MODE", "ap_mode");
    series.witnesses.block = state_track(sender, "NAVIGATION", "cur_block");
    if (const auto ground =
            find_track(sender, {"NAVIGATION_REF", "ground_alt", Quantity::metre}, Merge::latest)) {
        series.ground_altitude_m = ground->track.value.back();
    }
}

void add_configuration(FlightSeries& series, const telemetry::TelemetryLog& log) {
    if (!log.configuration) {
        if (!log.assumed_definitions.empty()) {
            series.warnings.push_back(fmt::format("no .log beside it: message layouts assumed: {}",
                                                  fmt::join(log.assumed_definitions, ", ")));
        }
        return;
    }
    const auto found = log.configuration->aircraft.find(series.aircraft_id);
    if (found == log.configuration->aircraft.end()) return;
    const auto& aircraft = found->second;
    series.aircraft_name = aircraft.name;
    series.witnesses.block_names = aircraft.block_names;
    if (!series.ground_altitude_m) series.ground_altitude_m = aircraft.ground_altitude_m;
    if (series.sources.contains("altitude_m") &&
        series.sources.at("altitude_m").starts_with("ROTORCRAFT_FP")) {
        series.ground_altitude_m = 0.0;  // its heights are above the reference on the ground
    }
    if (aircraft.current_origin == telemetry::CurrentOrigin::sensor)
        series.current_origin = "measured by a sensor";
    if (aircraft.current_origin == telemetry::CurrentOrigin::throttle) {
        series.current_origin = "computed from throttle";
        series.warnings.emplace_back(
            "the airframe defines MILLIAMP_AT_FULL_THROTTLE and no current sensor: its current was computed "
            "from "
            "throttle, so a power model fitted to it is circular");
    }
}

/// "ENERGY: another number of fields than the .log defines: 3 lines, first at line 17".
std::string describe(const telemetry::SkippedLines& skip) {
    return fmt::format("{}: {} line{}, first at line {}", skip.reason, skip.count, skip.count == 1 ? "" : "s",
                       skip.first_line);
}

[[noreturn]] void refuse_without_power(const telemetry::TelemetryLog& log, const std::string& aircraft_id,
                                       const std::vector<std::string>& passed_over) {
    std::vector<std::string> names;
    for (const auto& [name, count] :
         telemetry::census_of_messages(telemetry::DataFile(log.data_file).text())) {
        names.push_back(fmt::format("{} {}", name, count));
    }
    std::vector<std::string> reasons = passed_over;
    for (const auto& skip : log.skipped) reasons.push_back(describe(skip));
    for (const auto& assumed : log.assumed_definitions) reasons.push_back("assumed " + assumed);
    std::string reason;
    if (!reasons.empty()) reason = fmt::format(" ({})", fmt::join(reasons, "; "));
    constexpr std::size_t shown = 12;
    const bool more = names.size() > shown;
    names.resize(std::min(names.size(), shown));
    throw InputError(
        {log.data_file.string()},
        fmt::format("holds no measured power of aircraft {}{}", aircraft_id, reason),
        fmt::format("expected ENERGY with power, BAT or ENERGY with current, ESC or POWER_DEVICE; it "
                    "holds {}{}",
                    fmt::join(names, ", "), more ? ", ..." : ""));
}

/// Altitude and throttle alone, on the altitude's clock: enough to see whether an aircraft flew.
bool flew(const telemetry::SenderLog& sender) {
    FlightSeries series;
    auto altitude = altitude_of(sender).track;
    if (altitude.time_s.size() < 2) return false;
    series.time_s = altitude.time_s;
    series.altitude_m = std::move(altitude.value);
    series.power_w.assign(series.time_s.size(), 0.0);
    if (const auto throttle = throttle_of(sender).track; !throttle.empty()) {
        series.throttle_percent = resample(throttle, series.time_s);
    }
    series.ground_speed_track = ground_speed_of(sender).track;
    return !segment(series).sorties.empty();
}

/// Times may come a little late; a jump back of a minute is another log, or another boot, behind the first
/// one.
void refuse_restarted_clock(const telemetry::TelemetryLog& log, const telemetry::SenderLog& sender) {
    constexpr double late_s = 60.0;
    for (const auto& table : sender.tables) {
        for (std::size_t i = 1; i < table.time_s.size(); ++i) {
            if (table.time_s[i - 1] - table.time_s[i] <= late_s) continue;
            throw InputError({log.data_file.string()},
                             fmt::format("its clock runs back from {:.3f} to {:.3f} s (aircraft {}, {})",
                                         table.time_s[i - 1], table.time_s[i], sender.id, table.message),
                             "it holds several recordings: split it where the time begins anew");
        }
    }
}

/// The 4-field ENERGY stood without a .log, so the order of its last two fields was assumed. Where they fit
/// the other way round (power is voltage times current), they are exchanged. True if they were.
bool exchange_energy_and_power(telemetry::SenderLog& sender) {
    for (auto& table : sender.tables) {
        if (table.message != "ENERGY" || table.columns.size() != 4) continue;
        const auto column = [&](std::string_view name) -> telemetry::Column* {
            const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                            [&](const telemetry::Column& c) { return c.field == name; });
            return found == table.columns.end() ? nullptr : &*found;
        };
        auto* energy = column("energy");
        auto* power = column("power");
        const auto* voltage = column("bat");
        const auto* current = column("amp");
        if (energy == nullptr || power == nullptr || voltage == nullptr || current == nullptr) return false;
        constexpr double raw_per_ah = 1000.0;  // the column was read as mAh
        std::size_t as_read = 0;
        std::size_t exchanged = 0;
        for (std::size_t i = 0; i < table.time_s.size(); ++i) {
            const double product = voltage->values[i] * current->values[i];
            if (!(std::abs(product) > 1.0)) continue;
            // Power may be a whole number.
            const double tolerance = 0.05 * std::abs(product) + 1.0;
            if (std::abs(power->values[i] - product) <= tolerance) ++as_read;
            if (std::abs(energy->values[i] * raw_per_ah - product) <= tolerance) ++exchanged;
        }
        if (exchanged <= 2 * as_read || exchanged < 10) return false;
        for (std::size_t i = 0; i < table.time_s.size(); ++i) {
            const double watts = energy->values[i] * raw_per_ah;
            energy->values[i] = power->values[i] / raw_per_ah;
            power->values[i] = watts;
        }
        return true;
    }
    return false;
}

}  // namespace

std::vector<telemetry::MessageRequest> flight_messages() {
    return {
        {"ENERGY", {"throttle", "voltage", "bat", "current", "amp", "power", "charge", "energy"}},
        {"BAT", {"throttle", "voltage", "amps", "energy"}},
        {"ESC", {"amps", "bat_volts", "power", "node_id", "motor_id"}},
        {"POWER_DEVICE", {"node_id", "circuit", "current", "voltage"}},
        {"ESTIMATOR", {"z"}},
        {"GPS", {"utm_east", "utm_north", "alt", "speed"}},
        {"GPS_INT", {"hmsl", "ecef_xd", "ecef_yd", "ecef_zd"}},
        {"AIR_DATA", {"amsl_baro", "airspeed"}},
        {"AIRSPEED", {"airspeed"}},
        {"ROTORCRAFT_FP", {"east", "north", "up", "thrust"}},
        {"NAVIGATION", {"cur_block", "pos_x", "pos_y"}},
        {"NAVIGATION_REF", {"ground_alt"}},
        {"PPRZ_MODE", {"ap_mode"}},
        {"TAKEOFF", {"cpu_time"}},
        {"WIND_INFO", {"east", "north"}},
    };
}

std::vector<std::string> flown_aircraft(const telemetry::TelemetryLog& log) {
    std::vector<std::string> sent;
    std::vector<std::string> flown;
    for (const auto& sender : log.senders) {
        const bool telemetry = std::any_of(sender.tables.begin(), sender.tables.end(), [](const auto& table) {
            return table.message != "TAKEOFF" && table.message != "PPRZ_MODE" &&
                   table.message != "NAVIGATION_REF";
        });
        if (!telemetry) continue;
        sent.push_back(sender.id);
        if (flew(sender)) flown.push_back(sender.id);
    }
    return flown.empty() ? sent : flown;
}

FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id) {
    FlightSeries series;
    series.file = log.data_file.string();
    series.flight = log.flight;
    series.aircraft_id = aircraft_id;
    const auto sender = std::find_if(log.senders.begin(), log.senders.end(),
                                     [&](const telemetry::SenderLog& s) { return s.id == aircraft_id; });
    std::vector<std::string> passed_over;
    if (sender == log.senders.end()) refuse_without_power(log, aircraft_id, passed_over);
    refuse_restarted_clock(log, *sender);
    telemetry::SenderLog exchanged;
    const telemetry::SenderLog* own = &*sender;
    if (!log.configuration) {
        exchanged = *sender;
        if (exchange_energy_and_power(exchanged)) {
            own = &exchanged;
            series.warnings.emplace_back("ENERGY holds its power before its energy: the two were exchanged");
        }
    }
    auto power = choose_power(*own, passed_over);
    if (power.power_w.empty()) refuse_without_power(log, aircraft_id, passed_over);
    series.time_s = std::move(power.power_w.time_s);
    series.power_w = std::move(power.power_w.value);
    series.power_source = power.source;
    series.sources["power_w"] = power.source;
    add_channels(series, *own);
    add_witnesses(series, *own);
    add_configuration(series, log);
    for (const auto& reason : passed_over) {
        series.warnings.push_back(fmt::format("{}: power is taken from {}", reason, power.source));
    }
    for (const auto& skip : log.skipped) series.warnings.push_back(describe(skip));
    return series;
}

}  // namespace flightwatt::flight
