#include "base/csv.h"
#include "batch/batch_run.h"
#include "record/record.h"

#include <algorithm>
#include <optional>

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

/// Sums over a sortie's phases.
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

std::vector<std::string> cells_of(const BatchFlight& flight, const std::string& aircraft, const SortieRow& row,
                                  std::size_t sortie) {
    const bool has_power = flight.record.no_power_reason.empty();
    std::vector<std::string> cells{flight.record.flight, aircraft, fmt::format("{}", sortie)};
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
                               of_power(fixed(row.max_gap_s, 1)),
                               fmt::format("{}", texts_of(flight.record.diagnostics, Severity::warning).size()),
                               !has_power                    ? "no power"
                               : flight.is_of_other_aircraft ? "other aircraft"
                                                             : fmt::format("{} of 3", fitted)});
    return cells;
}

}  // namespace

/// A row of flights.csv: a phase, or a rejected log without one.
struct CatalogueRow {
    const BatchFlight& flight;
    const RecordedPhase* phase = nullptr;

    bool has_power() const { return flight.record.no_power_reason.empty(); }
};

Fields<CatalogueRow> record_fields(const CatalogueRow*) {
    using R = CatalogueRow;
    auto phase = embedded([](const R& row) { return row.phase; });
    for (auto& field : phase) {
        const auto& measured = fields_of<flight::PhaseStatistics>();
        if (std::ranges::find(measured, field.key, &FieldText::key) == measured.end()) continue;
        if (field.key == "counter_energy_wh") continue;
        field.get = [value = field.get](const R& row) { return row.has_power() ? value(row) : Json(); };
    }
    const auto used = [](const R& row) { return row.phase != nullptr && is_used(row.flight, *row.phase); };
    const auto synthetic = [](const R& row) {
        const auto& record = row.flight.record;
        return record.accepted ? std::optional(flight::is_synthetic(record.aircraft_name)) : std::nullopt;
    };
    const auto faults = [](const R& row) {
        const auto& record = row.flight.record;
        return row.has_power() ? fmt::format("{}", fmt::join(record.power_faults, "; ")) : record.no_power_reason;
    };
    const auto record = [](const R& row) { return &row.flight.record; };
    return list_fields<R>(
        field(
            "flight", [](const R& row) { return row.flight.record.flight; }, "name of the flight", csv_column{}),
        std::move(phase), field("used", used, "the phase is part of the fit", csv_column{}),
        embedded(record, {"flight"}),
        field("synthetic", synthetic, "`flightwatt synthesize` made the log", csv_column{}),
        field("power_faults", faults, "faults of the power record, or the reason without power", csv_column{}));
}

Totals totals_of(const BatchFlights& flights) {
    Totals totals;
    for (const auto& flight : flights) {
        const auto& record = flight.record;
        if (record.accepted) ++totals.accepted;
        if (record.accepted && record.no_power_reason.empty()) ++totals.with_power;
        if (!flight.is_of_this_run) continue;
        ++totals.of_this_run;
        const bool is_used = record.accepted || !record.recordings.empty();
        if (!is_used && !record.is_of_other_aircraft) ++totals.rejected_of_this_run;
    }
    return totals;
}

TextTable flights_table(const BatchFlights& flights, std::size_t max_logs, const ShortIds& short_ids) {
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
        const auto& id = flight.record.aircraft_id;
        const auto known = short_ids.find(id);
        const auto aircraft =
            flight::describe_aircraft(known == short_ids.end() ? id : known->second, flight.record.aircraft_name);
        const auto rows = sortie_rows(flight.record);
        for (std::size_t s = 0; s < rows.size(); ++s) table.rows.push_back(cells_of(flight, aircraft, rows[s], s + 1));
    }
    return table;
}

TextWriter catalogue_csv(const BatchFlights& flights) {
    return [&flights](const TextSink& sink) {
        constexpr std::size_t chunk_bytes = 65'536;
        const auto rows_of_flights = [](const std::vector<CatalogueRow>& rows) {
            return rows_of<CatalogueRow>(rows, &FieldText::csv_column);
        };
        auto csv = csv_header(rows_of_flights({}), 0);
        for (const auto& flight : flights) {
            std::vector<CatalogueRow> rows;
            for (const auto& phase : flight.record.phases) rows.push_back({flight, &phase});
            if (!flight.record.accepted) rows.push_back({flight});
            add_csv_rows(rows_of_flights(rows), csv);
            if (csv.text().size() > chunk_bytes) sink(csv.take_text());
        }
        sink(csv.take_text());
    };
}

Json catalogue_schema() {
    std::vector<const FieldText*> columns;
    for (const auto& field : fields_of<CatalogueRow>())
        if (field.csv_column) columns.push_back(&field);
    return object_schema(columns);
}

}  // namespace flightwatt::batch
