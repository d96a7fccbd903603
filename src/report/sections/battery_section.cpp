#include "report/sections/battery_section.h"

#include "base/error.h"
#include "base/units.h"
#include "cli/output/battery_output.h"
#include "report/figures/flight_figures.h"
#include "report/figures/model_figures.h"

#include <algorithm>
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

void add_identified(Section& section, const ReportBattery& battery) {
    const auto& identified = *battery.identified;
    section.html += paragraph(describe_basis(battery));
    std::vector<std::string> notes;
    for (const auto& [text, is_warning] : cli::battery_remarks(identified)) {
        if (is_warning)
            section.html += paragraph("Warning: " + text + ".", "warning");
        else
            notes.push_back(text + ".");
    }
    add_table(section, {parameters_table(identified), "Parameters of the battery", "tab:identified-battery"});
    add_figure(section, voltage_figure(identified, battery.records, "battery-voltage"));
    add_table(section,
              {cli::flights_table(identified, battery.leave_one_out), "Flights in the fit of the battery",
               "tab:battery-flights"},
              {.sortable = true});
    section.html += paragraph(
        "Missing: charge below full at the start of the flight, with its 95 % interval; own ohm: series resistance of "
        "this flight alone, with its interval. Leave-one-out: RMS error of this flight's voltage by the battery of the "
        "other flights; beyond the others: fraction of its samples with more charge drawn than in any other flight.",
        "soft");
    section.html += list_html(notes, "soft");
    add_figure(section, open_circuit_figure(identified, "battery-open-circuit"));
    if (!battery.leave_one_out.empty()) return;
    section.html += paragraph(battery.no_result_reason.empty()
                                  ? "A single flight: there is no other one to check the battery with."
                                  : "The battery was not checked by leave-one-out: " + battery.no_result_reason,
                              "soft");
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

Section battery_section(const ReportBattery& battery) {
    Section section{"battery", "Battery"};
    if (battery.identified)
        add_identified(section, battery);
    else
        section.html += paragraph("The battery was not identified: " + battery.no_result_reason + ".", "warning");
    section.html += list_html(battery.notes);
    if (battery.exclusions.empty()) return section;
    section.html += heading("Not used for the battery");
    add_table(section,
              {exclusions_table(battery.exclusions), "Flights not used for the battery", "tab:battery-excluded"});
    return section;
}

}  // namespace flightwatt::report
