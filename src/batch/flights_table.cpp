#include "base/csv.h"
#include "batch/batch_run.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::batch {
namespace {

bool is_used(const BatchFlight& flight, const RecordedPhase& phase) {
    const auto name = mechanical::sortie_name(flight.record.flight, phase.sortie);
    return std::ranges::any_of(flight.selection.flights, [&](const SelectedSortie& sortie) {
        return sortie.flight == name && sortie.phases[phase.phase];
    });
}

/// What a sortie's phases add up to.
struct SortieRow {
    flight::PerPhase<const RecordedPhase*> phases{};
    double energy_wh = 0.0;
    double counter_wh = 0.0;
    bool has_counter = true;
    std::size_t samples = 0;
    std::size_t gaps = 0;
    double max_gap_s = 0.0;
};

std::vector<SortieRow> sortie_rows(const FlightRecord& record) {
    std::vector<SortieRow> rows;
    for (const auto& phase : record.phases) {
        if (rows.size() < phase.sortie) rows.resize(phase.sortie);
        auto& row = rows[phase.sortie - 1];
        row.phases[phase.phase] = &phase;
        row.energy_wh += phase.statistics.energy_wh;
        row.counter_wh += phase.statistics.counter_energy_wh.value_or(0.0);
        row.has_counter = row.has_counter && phase.statistics.counter_energy_wh.has_value();
        row.samples += phase.statistics.samples;
        row.gaps += phase.statistics.gaps;
        row.max_gap_s = std::max(row.max_gap_s, phase.statistics.max_gap_s);
    }
    return rows;
}

std::vector<std::string> cells_of(const BatchFlight& flight, const SortieRow& row, std::size_t sortie) {
    const bool has_power = flight.record.no_power_reason.empty();
    std::vector<std::string> cells{flight.record.flight,
                                   flight::describe_aircraft(flight.record.aircraft_id, flight.record.aircraft_name),
                                   fmt::format("{}", sortie)};
    for (const auto phase : flight::all_phases) {
        const auto* recorded = row.phases[phase];
        // An asterisk marks a phase that the log cuts.
        cells.push_back(recorded == nullptr ? "-"
                                            : fmt::format("{:.0f}{}", recorded->end_s - recorded->start_s,
                                                          recorded->complete ? "" : "*"));
    }
    for (const auto phase : flight::all_phases) {
        const auto* recorded = row.phases[phase];
        cells.push_back(recorded == nullptr || !has_power ? "-" : fixed(recorded->statistics.mean_power_w, 1));
    }
    const auto fitted = std::count_if(row.phases.values.begin(), row.phases.values.end(),
                                      [&](const auto* phase) { return phase != nullptr && is_used(flight, *phase); });
    const auto of_power = [&](const std::string& cell) { return has_power ? cell : "-"; };
    cells.insert(cells.end(), {of_power(fixed(row.energy_wh, 3)), row.has_counter ? fixed(row.counter_wh, 3) : "-",
                               fmt::format("{}", row.samples), of_power(fmt::format("{}", row.gaps)),
                               of_power(fixed(row.max_gap_s, 1)), fmt::format("{}", flight.record.warnings.size()),
                               has_power ? fmt::format("{} of 3", fitted) : "no power"});
    return cells;
}

/// The columns of flights.csv: `visit` is called with the name of each, and with what it holds of a phase.
void visit_columns(const BatchFlight& flight, const RecordedPhase& phase, const auto& visit) {
    const auto& record = flight.record;
    const auto& statistics = phase.statistics;
    const bool has_power = record.no_power_reason.empty();
    const auto known = [&](auto value) { return has_power ? std::optional(value) : std::nullopt; };
    visit("flight", record.flight);
    visit("sortie", phase.sortie);
    visit("phase", to_string(phase.phase));
    visit("start_s", phase.start_s);
    visit("end_s", phase.end_s);
    visit("duration_s", phase.end_s - phase.start_s);
    visit("samples", known(statistics.samples));
    visit("mean_power_w", known(statistics.mean_power_w));
    visit("energy_wh", known(statistics.energy_wh));
    visit("counter_energy_wh", statistics.counter_energy_wh);
    visit("used", is_used(flight, phase));
    visit("gaps", known(statistics.gaps));
    visit("longest_gap_s", known(statistics.max_gap_s));
    visit("complete", phase.complete);
    visit("aircraft_id", record.aircraft_id);
    visit("aircraft_name", record.aircraft_name);
    visit("synthetic", flight::is_synthetic(record.aircraft_name));
    visit("power_source", record.power_source);
    visit("power_faults", has_power ? fmt::format("{}", fmt::join(record.power_faults, "; ")) : record.no_power_reason);
    visit("error", record.error);
}

/// Of a rejected log there is its name and its error alone.
void add_rows(const BatchFlight& flight, CsvWriter& csv) {
    const std::set<std::string_view> of_rejected{"flight", "used", "error"};
    const auto& record = flight.record;
    for (const auto& phase : record.accepted ? record.phases : std::vector(1, RecordedPhase{})) {
        std::vector<std::string> cells;
        visit_columns(flight, phase, [&](const char* name, const auto& value) {
            cells.push_back(record.accepted || of_rejected.contains(name) ? csv.cell(value) : std::string());
        });
        csv.add_row(cells);
    }
}

}  // namespace

Totals totals_of(const BatchFlights& flights) {
    Totals totals;
    for (const auto& flight : flights) {
        const auto& record = flight.record;
        if (record.accepted) ++totals.accepted;
        if (record.accepted && record.no_power_reason.empty()) ++totals.with_power;
        if (!flight.is_of_this_run) continue;
        ++totals.of_this_run;
        if (!record.accepted && !record.is_of_other_aircraft) ++totals.rejected_of_this_run;
    }
    return totals;
}

TextTable flights_table(const BatchFlights& flights, std::size_t max_logs) {
    TextTable table;
    table.header = {"flight",     "aircraft",  "sortie",    "take-off s",   "cruise s",   "landing s",
                    "take-off W", "cruise W",  "landing W", "energy Wh",    "counter Wh", "samples",
                    "gaps",       "longest s", "warnings",  "phases fitted"};
    for (std::size_t i = 0; i < std::min(flights.size(), max_logs); ++i) {
        const auto& flight = flights[i];
        if (!flight.record.accepted) {
            std::vector<std::string> row{flight.record.flight, "-"};
            row.resize(table.header.size(), "-");
            row.back() = flight.record.is_of_other_aircraft ? "other aircraft" : "rejected";
            table.rows.push_back(std::move(row));
            continue;
        }
        const auto rows = sortie_rows(flight.record);
        for (std::size_t s = 0; s < rows.size(); ++s) table.rows.push_back(cells_of(flight, rows[s], s + 1));
    }
    return table;
}

TextWriter catalogue_csv(const BatchFlights& flights) {
    return [&flights](const TextSink& sink) {
        constexpr std::size_t piece_bytes = 65'536;
        std::vector<std::string_view> columns;
        visit_columns({}, {}, [&](const char* name, const auto& /*value*/) { columns.emplace_back(name); });
        CsvWriter csv(columns);
        for (const auto& flight : flights) {
            add_rows(flight, csv);
            if (csv.text().size() > piece_bytes) sink(csv.take_text());
        }
        sink(csv.take_text());
    };
}

}  // namespace flightwatt::batch
