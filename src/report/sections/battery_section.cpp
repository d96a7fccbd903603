#include "base/error.h"
#include "base/units.h"
#include "cli/output/battery_output.h"
#include "report/figures/flight_figures.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// What the error says, without the place of a file that the reader did not write.
std::string reason_of(const InputError& error, const std::string& flight) {
    const std::string text = error.what();
    const auto start = text.find(flight + ": ");
    return start == std::string::npos ? text : text.substr(start + flight.size() + 2);
}

/// The flight's record, or why it has none.
void add_record(ReportBattery& battery, const ReportFlight& flight) {
    const auto unusable = flight.rejected.empty() ? flight.unusable_power : "rejected: " + flight.rejected;
    if (!unusable.empty()) {
        battery.excluded.push_back({flight.name, unusable});
        return;
    }
    try {
        auto found = battery::discharge_records(flight.series);
        for (const auto& note : found.notes) battery.notes.push_back(fmt::format("{}: {}", flight.name, note));
        std::ranges::move(found.records, std::back_inserter(battery.records));
    } catch (const InputError& error) {
        battery.excluded.push_back({flight.name, reason_of(error, flight.name)});
    }
}

/// `most` of the records, the first and the last among them.
std::vector<battery::DischargeRecord> spread_evenly(std::vector<battery::DischargeRecord> records, std::size_t most) {
    if (records.size() <= most) return records;
    std::vector<battery::DischargeRecord> chosen;
    for (std::size_t i = 0; i < most; ++i) {
        chosen.push_back(std::move(records[most == 1 ? 0 : i * (records.size() - 1) / (most - 1)]));
    }
    return chosen;
}

/// The circuit's parameters, and the capacity.
TextTable parameters_table(const battery::BatteryIdentification& identified) {
    auto table = cli::pack_table(identified.battery);
    table.header.emplace_back("known from");
    for (auto& row : table.rows) row.emplace_back("voltage under load");
    table.rows.front().back() = to_string(identified.capacity.origin);
    return table;
}

std::string rests_on(const ReportBattery& battery) {
    auto text = fmt::format(
        "A Th\u00e9venin circuit, identified from voltage, current and charge of {} flight{}, {} LiPo cells "
        "in series: voltages are met within {:.1f} mV RMS.",
        battery.records.size(), battery.records.size() == 1 ? "" : "s", battery.identified->cells,
        units::mv_from_v(battery.identified->fit.rms_v));
    if (battery.records.size() < battery.usable) {
        text += fmt::format(
            " They are spread evenly among the {} that could be used, because the work grows with "
            "their square.",
            battery.usable);
    }
    return text;
}

/// The first names, and how many more there are.
std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t most = 10;
    const auto shown = std::min(most, names.size());
    auto text = fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
    return text;
}

TextTable excluded_table(const ReportBattery& battery) {
    std::map<std::string, std::vector<std::string>> flights_of_reason;
    for (const auto& [flight, reason] : battery.excluded) flights_of_reason[reason].push_back(flight);
    TextTable table{{"flights", "number", "why"}, {}};
    for (const auto& [reason, flights] : flights_of_reason) {
        table.rows.push_back({some_of(flights), fmt::format("{}", flights.size()), reason});
    }
    return table;
}

void add_identified(Section& section, const ReportBattery& battery, const SectionScope& of) {
    const auto& identified = *battery.identified;
    section.html += paragraph(rests_on(battery));
    if (identified.capacity.origin == battery::CapacityOrigin::given) {
        const auto warning = capacity_warning(identified.battery);
        section.html += warning.empty() ? paragraph(cli::describe_given_capacity(identified.battery) + ".")
                                        : paragraph("Warning: " + warning + ".", "warning");
    }
    if (const auto warning = cli::cells_warning(identified); !warning.empty())
        section.html += paragraph("Warning: " + warning + ".", "warning");
    if (identified.capacity.origin == battery::CapacityOrigin::chart) {
        section.html += paragraph(
            "No flight tells the capacity, as none runs empty: it is a guess after the usual charts of "
            "lithium cells. Give what the pack says with --capacity.",
            "warning");
    }
    if (identified.fit.rc_resistance_ohm == 0.0) {
        section.html += paragraph("No RC pair explains anything: the battery has none.");
    } else if (identified.errors.rc_resistance_ohm.low == 0.0) {
        section.html += paragraph("The RC pair may be none: its resistance's interval reaches down to 0.");
    }
    add_table(section, {parameters_table(identified), "Parameters of the battery", "tab:identified-battery"});
    add_figure(section, voltage_figure(identified, battery.records, of.id("battery-voltage")));
    add_table(section,
              {cli::flights_table(identified, battery.leave_one_out), "Flights in the fit of the battery",
               "tab:battery-flights"},
              true);
    section.html += paragraph(
        "Missing: from the full pack when the flight began, with its 95 % interval; own ohm: the series resistance that "
        "this flight alone shows, with its own.",
        "soft");
    for (const auto& flight : identified.flights)
        if (flight.link) section.html += paragraph(cli::describe_link(flight) + ".", "soft");
    if (identified.trend)
        section.html += paragraph("State of health: " + cli::describe(*identified.trend) + ".", "soft");
    section.html += paragraph(
        "Leave-one-out: RMS error of this flight's voltage by the battery of the other flights; beyond the others: "
        "part of its samples with more charge drawn than in any other flight.",
        "soft");
    add_figure(section, open_circuit_figure(identified, of.id("battery-open-circuit")));
}

ReportBattery identify_with(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                            std::size_t most) {
    ReportBattery battery;
    for (const auto& flight : flights) add_record(battery, flight);
    battery.usable = battery.records.size();
    battery.records = spread_evenly(std::move(battery.records), most);
    if (battery.records.empty()) {
        battery.no_result_reason = "no flight has a voltage and a current to identify it from";
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

/// The packs of the missions that `flightwatt battery` identified from any of the flights: each capacity once.
std::vector<battery::Battery> packs_of_flights(std::span<const mission::MissionVariant> missions,
                                               std::span<const ReportFlight> flights) {
    std::set<std::string> names;
    for (const auto& flight : flights) names.insert(flight.series.flight);
    std::vector<battery::Battery> packs;
    for (const auto& mission : missions) {
        const auto& setup = setup_of(mission);
        const auto& pack = setup.battery;
        const auto is_theirs = [&](const std::string& flight) { return names.contains(flight); };
        if (setup.capacity_is_stated || !pack.flight_estimate) continue;
        if (std::ranges::none_of(pack.flight_estimate->flights, is_theirs)) continue;
        if (std::ranges::find(packs, pack.capacity_ah, &battery::Battery::capacity_ah) == packs.end())
            packs.push_back(pack);
    }
    return packs;
}

}  // namespace

ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t most, std::span<const mission::MissionVariant> missions) {
    const auto packs = packs_of_flights(missions, flights);
    if (packs.size() != 1) {
        auto battery = identify_with(flights, options, most);
        if (!packs.empty())
            battery.notes.emplace_back("The missions fly on packs of these flights with different capacities.");
        return battery;
    }
    const auto& pack = packs.front();
    if (options.capacity_ah && *options.capacity_ah != pack.capacity_ah) {
        throw UsageError(fmt::format(
            "--capacity {:g}: the missions fly on '{}' of {:g} Ah; give the capacity to `flightwatt battery` alone",
            *options.capacity_ah, pack.name, pack.capacity_ah));
    }
    const bool is_given = pack.capacity_ah != pack.flight_estimate->capacity_ah;
    auto of_pack = options;
    if (is_given) of_pack.capacity_ah = pack.capacity_ah;
    of_pack.cells = pack.cells;
    try {
        auto battery = identify_with(flights, of_pack, most);
        if (is_given)
            battery.notes.push_back(fmt::format("The capacity is that of '{}', which the missions fly on.", pack.name));
        return battery;
    } catch (const UsageError& error) {  // flights that are newer than the pack drew more than its capacity
        auto battery = identify_with(flights, options, most);
        battery.notes.push_back(
            fmt::format("The capacity of '{}', which the missions fly on, is not used: {}", pack.name, error.what()));
        return battery;
    }
}

Section battery_section(const ReportBattery& battery, const SectionScope& of) {
    Section section{of.id("battery"), of.title("Battery")};
    if (battery.identified) {
        add_identified(section, battery, of);
        if (battery.leave_one_out.empty()) {
            section.html += paragraph(battery.no_result_reason.empty()
                                          ? "A single flight: there is no other one to check the battery with."
                                          : "The battery was not checked by leave-one-out: " + battery.no_result_reason,
                                      "soft");
        }
    } else {
        section.html += paragraph("The battery was not identified: " + battery.no_result_reason + ".", "warning");
    }
    if (!battery.notes.empty()) section.html += list_html(battery.notes);
    if (battery.excluded.empty()) return section;
    section.tables.push_back(
        {excluded_table(battery), "Flights not used for the battery, and why", "tab:battery-excluded"});
    section.html += "<h3>Not used for the battery</h3>\n" +
                    table_html(section.tables.back().table, {"Flights that were excluded, and why"});
    return section;
}

}  // namespace flightwatt::report
