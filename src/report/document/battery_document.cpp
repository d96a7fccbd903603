#include "report/document/battery_document.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "cli/output/battery_output.h"
#include "report/document/columns.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// The error's reason without the path of the series file.
std::string reason_of(const InputError& error, const std::string& flight) {
    const std::string text = error.what();
    const auto start = text.find(flight + ": ");
    return start == std::string::npos ? text : text.substr(start + flight.size() + 2);
}

void add_record(ReportBattery& battery, const ReportFlight& flight) {
    const auto exclude = [&](const std::string& reason) {
        battery.exclusions.push_back({flight.name, "for the battery", reason});
    };
    if (!flight.rejected.empty()) return exclude("no usable log: " + flight.rejected);
    if (!flight.unusable_power.empty()) return exclude(flight.unusable_power);
    try {
        auto found = battery::discharge_records(flight.data);
        for (const auto& note : found.notes) battery.notes.push_back(fmt::format("{}: {}", flight.name, note));
        std::ranges::move(found.records, std::back_inserter(battery.records));
    } catch (const InputError& error) {
        exclude(reason_of(error, flight.name));
    }
}

/// Parameters of the circuit, and the capacity.
TextTable parameters_table(const battery::BatteryIdentification& identified) {
    auto table = cli::pack_table(identified.battery);
    table.header.emplace_back("known from");
    for (auto& row : table.rows) row.emplace_back("voltage under load");
    table.rows.front().back() = to_string(identified.capacity.origin);
    return table;
}

std::string describe_basis(const ReportBattery& battery) {
    auto text = fmt::format(
        "A Th\u00e9venin circuit, identified from voltage, current and charge of {} flight{}, {} LiPo cells in series; "
        "RMS error {:.1f} mV.",
        battery.records.size(), battery.records.size() == 1 ? "" : "s", battery.identified->cells,
        units::mv_from_v(battery.identified->fit.rms_v));
    if (battery.records.size() < battery.usable)
        text += fmt::format(" They are selected evenly among the {} usable ones, as the work grows with the square.",
                            battery.usable);
    return text;
}

constexpr std::size_t voltage_columns = 130;  // pixels of a plot

/// Terminal voltage of each flight, null where its record is not used.
Json voltages_json(const ReportBattery& battery) {
    constexpr int volt_decimals = 3;
    auto voltages = Json::array();
    const auto& identified = *battery.identified;
    for (std::size_t f = 0; f < battery.records.size(); ++f) {
        const auto& record = battery.records[f];
        const auto model =
            predict_voltage(identified.battery, record, identified.flights[f].initial_depletion_ah).voltage_v;
        auto rows = downsample_m4(record.time_s, record.voltage_v, voltage_columns);
        std::ranges::copy(downsample_m4(record.time_s, model, voltage_columns), std::back_inserter(rows));
        std::ranges::sort(rows);
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        Json::array_t time_s;
        Json::array_t measured_v;
        Json::array_t model_v;
        for (const auto i : rows) {
            const bool used = record.used[i];
            time_s.push_back(rounded_json(record.time_s[i] - record.time_s.front(), 1));
            measured_v.push_back(used ? rounded_json(record.voltage_v[i], volt_decimals) : Json());
            model_v.push_back(used ? rounded_json(model[i], volt_decimals) : Json());
        }
        voltages.push_back(
            {{"flight", record.flight}, {"time_s", time_s}, {"measured_v", measured_v}, {"model_v", model_v}});
    }
    return voltages;
}

/// The knots with their 95 % intervals, where those are known.
Json open_circuit_json(const battery::BatteryIdentification& identified) {
    const auto& curve = identified.battery.thevenin->open_circuit;
    const auto& errors_v = identified.battery.intervals.open_circuit_standard_error_v;
    constexpr int decimals = 4;
    Json json{{"soc_percent", column_of(curve.soc_percent)},
              {"voltage_v", rounded_column(curve.voltage_v, decimals)},
              {"low_v", Json::array()},
              {"high_v", Json::array()},
              {"from_flights", Json::array()},
              {"text", ""}};
    for (std::size_t i = 0; i < curve.soc_percent.size(); ++i) {
        const double reach_v = errors_v.empty() ? std::nan("") : normal_half_width() * errors_v[i];
        json["low_v"].push_back(rounded_json(curve.voltage_v[i] - reach_v, decimals));
        json["high_v"].push_back(rounded_json(curve.voltage_v[i] + reach_v, decimals));
        // The last observed knot, whose state of charge is rounded, is from flights.
        json["from_flights"].push_back(curve.soc_percent[i] >= identified.observed_min_soc_percent - 1e-6);
    }
    if (identified.observed_min_soc_percent > 0.0)
        json["text"] = fmt::format(
            "Below {:.0f} %, the range of the flights, it is parallel to the chart of {} {} cells, with growing "
            "uncertainty.",
            identified.observed_min_soc_percent, identified.cells, to_string(identified.chemistry));
    return json;
}

void add_identified(Json& json, const ReportBattery& battery, LatexTables& tables) {
    const auto& identified = *battery.identified;
    json["text"] = describe_basis(battery);
    for (const auto& [text, is_warning] : cli::battery_remarks(identified))
        json[is_warning ? "warnings" : "notes"].push_back(text + ".");
    const auto parameters = parameters_table(identified);
    tables.add({parameters, "Parameters of the battery", "tab:identified-battery"});
    tables.add({cli::flights_table(identified, battery.leave_one_out), "Flights in the fit of the battery",
                "tab:battery-flights"});
    json["parameters"] = printed_json(parameters, "Parameters of the battery");
    json["identified"] = record_json(cli::BatteryOutput{
        &identified, battery.leave_one_out.empty() ? nullptr : &battery.leave_one_out, std::nullopt});
    json["voltages"] = voltages_json(battery);
    json["open_circuit"] = open_circuit_json(identified);
    if (battery.leave_one_out.empty())
        json["not_checked"] = battery.no_result_reason.empty()
                                  ? "A single flight: there is no other one to check the battery with."
                                  : "The battery was not checked by leave-one-out: " + battery.no_result_reason;
}

ReportBattery identify_with(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                            std::size_t max_flights) {
    ReportBattery battery;
    for (const auto& flight : flights) add_record(battery, flight);
    battery.usable = battery.records.size();
    battery.records = evenly_chosen(battery.records, max_flights);
    if (battery.records.empty()) {
        battery.no_result_reason = "no flight has both voltage and current";
        return battery;
    }
    try {
        battery.identified = identify_battery(battery.records, options);
        battery.leave_one_out = leave_one_out(battery.records, options);
    } catch (const NoResultError& error) {
        battery.no_result_reason = error.what();
    }
    return battery;
}

/// The first pack of the missions that `flightwatt battery` identified from any of the flights.
const battery::Battery* find_pack(std::span<const mission::MissionVariant> missions,
                                  std::span<const ReportFlight> flights) {
    const auto is_known = [&](const std::string& name) {
        return std::ranges::any_of(flights, [&](const auto& flight) { return flight.data.flight == name; });
    };
    for (const auto& mission : missions) {
        const auto& setup = setup_of(mission);
        const auto& estimate = setup.battery.flight_estimate;
        if (!setup.capacity_is_stated && estimate && std::ranges::any_of(estimate->flights, is_known))
            return &setup.battery;
    }
    return nullptr;
}

}  // namespace

ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t max_flights, std::span<const mission::MissionVariant> missions) {
    const auto* pack = find_pack(missions, flights);
    if (pack == nullptr) return identify_with(flights, options, max_flights);
    if (options.capacity_ah && *options.capacity_ah != pack->capacity_ah)
        throw UsageError(fmt::format(
            "--capacity {:g}: the missions' pack '{}' has {:g} Ah; give the capacity to `flightwatt battery` only",
            *options.capacity_ah, pack->name, pack->capacity_ah));
    auto of_pack = options;
    of_pack.capacity_ah = pack->capacity_ah;
    of_pack.cells = pack->cells;
    try {
        auto battery = identify_with(flights, of_pack, max_flights);
        if (battery.identified) battery.identified->battery.flight_estimate = pack->flight_estimate;
        battery.notes.push_back(fmt::format("The capacity is that of the missions' pack '{}'.", pack->name));
        return battery;
    } catch (const UsageError& error) {  // flights newer than the pack drew more than its capacity
        auto battery = identify_with(flights, options, max_flights);
        battery.notes.push_back(
            fmt::format("The capacity of the missions' pack '{}' is not used: {}", pack->name, error.what()));
        return battery;
    }
}

Json battery_json(const ReportBattery& battery, LatexTables& tables) {
    Json json{{"text", ""},
              {"warnings", Json::array()},
              {"notes", Json::array()},
              {"no_result_reason", battery.identified ? "" : battery.no_result_reason},
              {"not_checked", ""},
              {"identified", nullptr},
              {"parameters", nullptr},
              {"voltages", Json::array()},
              {"open_circuit", nullptr}};
    if (battery.identified) add_identified(json, battery, tables);
    for (const auto& note : battery.notes) json["notes"].push_back(note);
    tables.add(
        {table_of(group_exclusions(battery.exclusions)), "Flights not used for the battery", "tab:battery-excluded"});
    return json;
}

}  // namespace flightwatt::report
