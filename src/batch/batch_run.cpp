#include "batch/batch_run.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "base/overwrite_guard.h"
#include "base/parallel.h"
#include "base/text.h"
#include "batch/batch_files.h"
#include "batch/manifest.h"
#include "flight/column_map.h"
#include "flight/load_flight.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"
#include "record/record.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::batch {
namespace {

void write_result(const BatchOptions& options, const std::string& flight, const char* ending,
                  const std::string& content) {
    const OverwriteExemption own;  // its name is unique: no check file by file
    write_file_atomically(result_path(options.out, flight, ending), content, options.out / temporary_folder);
}

/// Fingerprint of log and options.
std::string fingerprint_of(const flight::FlightFile& file, const LogFile& log, const BatchOptions& options) {
    const auto& load = options.load;
    const auto& segmentation = load.segmentation;
    Fingerprint fingerprint;
    fingerprint.add(FLIGHTWATT_VERSION " record 19");
    fingerprint.add(log.path);
    if (!file.autopilot() && !file.is_series()) fingerprint.add(load.aircraft.value_or(""));  // may be of several
    fingerprint.add(log.why_not_fitted);
    fingerprint.add(load.correct_idle_offset ? "idle offset corrected" : "");
    fingerprint.add(load.sortie ? fmt::format("sortie {}", *load.sortie) : "");
    fingerprint.add(load.recording ? fmt::format("recording {}", *load.recording) : "");
    fingerprint.add(fmt::format("{} {} {} {} {} {}", segmentation.rest_s, segmentation.hold_s,
                                segmentation.idle_throttle_percent, segmentation.cruise_fraction,
                                segmentation.ground_fraction, segmentation.flight_height_m));
    fingerprint.add(file.text());
    if (const auto& map = file.column_map()) fingerprint.add(map->text);
    fingerprint.add(file.log_text().value_or("no .log"));
    return fingerprint.hex();
}

bool has_results(const BatchOptions& options, const std::string& flight) {
    return std::filesystem::exists(result_path(options.out, flight, series_suffix)) ||
           std::filesystem::exists(result_path(options.out, flight, phases_suffix));
}

/// The stored results of a log, if they have this fingerprint and their files are unchanged.
std::optional<FlightRecords> stored_results(const BatchOptions& options, const LogFile& log,
                                            const std::string& fingerprint) {
    const OverwriteExemption own;
    std::error_code none;
    if (!std::filesystem::is_regular_file(result_path(options.out, log.flight, record_suffix), none))
        return std::nullopt;
    try {
        auto records = read_verified_records(options.out, log.flight);
        const bool is_current = std::ranges::all_of(records, [&](const FlightRecord& record) {
            return record.fingerprint == fingerprint && (record.accepted || !has_results(options, record.flight));
        });
        return is_current ? std::optional(std::move(records)) : std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;  // damaged or of another version: the log is read again
    }
}

/// Completes a record, writes it, and changes it to what later runs read.
void conclude(FlightRecord& record, const std::string& name, const LogFile& log, const std::string& fingerprint,
              const BatchOptions& options) {
    record.flight = name;
    record.log = log.path;
    record.fingerprint = fingerprint;
    const auto text = to_json_text(record);
    write_result(options, name, record_suffix, text);
    if (valid_utf8(name) == name) return;
    record = record_from_json(text).value();  // a name that is not UTF-8 changes in JSON
    record.flight = name;
}

/// Writes the series and phases of a flight. Returns its record.
FlightRecord do_flight(flight::LoadedFlight loaded, const std::string& name, const LogFile& log,
                       const BatchOptions& options) {
    loaded.series.flight = loaded.data.flight = name;
    auto record = record_of(loaded);
    record.not_fitted_reason = log.why_not_fitted;
    const auto series_csv = to_csv(loaded.series);
    const auto phases_csv = flight::phases_csv(loaded.data, loaded.phases);
    record.results = results_fingerprint(series_csv, phases_csv);
    write_result(options, name, series_suffix, series_csv);
    write_result(options, name, phases_suffix, phases_csv);
    return record;
}

/// Reads, segments and writes one log, of which the first record remains to be written. Throws InputError where it
/// cannot be used.
FlightRecords do_accepted(const flight::FlightFile& file, const LogFile& log, const std::string& fingerprint,
                          const BatchOptions& options) {
    auto load = options.load;
    load.power_required = false;
    auto loaded = flight::load_flights(file, load);
    FlightRecords records(1);
    if (loaded.unused.contains(1)) records.front().error = "recording 1: " + loaded.unused[1];
    for (auto& flight : loaded.flights) {
        const auto number = load.recording ? 1 : flight.recording;
        const auto name = flight::recording_name(log.flight, number);
        auto record = do_flight(std::move(flight), name, log, options);
        if (number == 1) {
            records.front() = std::move(record);
            continue;
        }
        records.front().recordings.push_back(number);
        conclude(record, name, log, fingerprint, options);
        records.push_back(std::move(record));
    }
    for (const auto& [number, reason] : loaded.unused)
        if (number > 1)
            records.front().diagnostics.push_back({Severity::note, "recordings without a flight",
                                                   fmt::format("recording {} is not used: {}", number, reason)});
    return records;
}

/// The flights of a log from their records.
BatchFlights flights_of(FlightRecords records, bool were_up_to_date, const BatchOptions& options) {
    BatchFlights flights;
    for (auto& record : records) {
        flights.push_back(without_samples(std::move(record), options.load));
        flights.back().was_up_to_date = were_up_to_date;
    }
    return flights;
}

/// Processes a log that exists; sets `fingerprint` as soon as it is known.
BatchFlights do_existing(const LogFile& log, const BatchOptions& options, std::string& fingerprint) {
    const flight::FlightFile file(log.path, options.load);
    fingerprint = fingerprint_of(file, log, options);
    if (auto records = stored_results(options, log, fingerprint)) return flights_of(*std::move(records), true, options);
    remove_results(options.out, log.flight);
    auto records = do_accepted(file, log, fingerprint, options);
    conclude(records.front(), log.flight, log, fingerprint, options);
    return flights_of(std::move(records), false, options);
}

/// The results of an earlier run of a missing log. Throws InputError where its files have changed.
BatchFlights do_missing(const LogFile& log, const BatchOptions& options) {
    const OverwriteExemption own;
    auto kept = flights_of(read_verified_records(options.out, log.flight), true, options);
    for (auto& flight : kept) flight.log_is_missing = true;
    return kept;
}

/// Reason of a rejected log from the current exception. Rethrows errors of output and usage.
std::string why_rejected(const LogFile& log, std::string& fingerprint) {
    try {
        throw;
    } catch (const OutputError&) {
        throw;
    } catch (const UsageError&) {
        throw;
    } catch (const InputError& error) {
        return fmt::format("{}: {}{}{}", to_string(error.where()), error.what(), error.hint().empty() ? "" : "; ",
                           error.hint());
    } catch (const std::bad_alloc&) {
        fingerprint.clear();  // may succeed with more memory
        return log.path + ": needs more memory than there is";
    } catch (const std::filesystem::filesystem_error& error) {
        fingerprint.clear();
        return fmt::format("{}: cannot be read: {}", log.path, error.code().message());
    } catch (const std::exception& error) {
        fingerprint.clear();
        return fmt::format("{}: internal error: {}", log.path, error.what());
    }
}

BatchFlight reject(const LogFile& log, const std::string& why, bool is_of_other_aircraft,
                   const std::string& fingerprint, const BatchOptions& options) {
    BatchFlight rejected;
    rejected.record.error = valid_utf8(why);  // as it is read back
    rejected.record.is_of_other_aircraft = is_of_other_aircraft;
    rejected.record.flight = log.flight;
    rejected.record.log = log.path;
    if (!log.problem.empty() || log.is_missing) return rejected;  // nothing to write
    remove_results(options.out, log.flight);
    conclude(rejected.record, log.flight, log, fingerprint, options);
    return rejected;
}

/// The flights of a log, the first recording's first.
BatchFlights do_log(const LogFile& log, const BatchOptions& options) {
    BatchFlights done;
    std::string fingerprint;
    std::string why;
    bool is_of_other_aircraft = false;
    try {
        if (!log.problem.empty()) throw InputError({log.path}, log.problem);
        done = log.is_missing ? do_missing(log, options) : do_existing(log, options, fingerprint);
    } catch (const flight::OtherAircraftError& error) {
        is_of_other_aircraft = true;
        why = fmt::format("{}; {}", error.what(), error.hint());
    } catch (...) {
        why = why_rejected(log, fingerprint);
        if (log.is_missing) why += "; its log is missing: restore it, or drop the flight with --prune";
    }
    if (!why.empty()) done = {reject(log, why, is_of_other_aircraft, fingerprint, options)};
    for (auto& flight : done) flight.is_of_this_run = log.is_of_this_run;
    return done;
}

/// Candidates for duplicates, the preferred ones first.
std::vector<const BatchFlight*> candidates_among(const BatchFlights& flights) {
    const auto is_fitted = [](const BatchFlight& flight) { return !flight.selection.flights.empty(); };
    std::vector<const BatchFlight*> candidates;
    candidates.reserve(flights.size());
    for (const auto& flight : flights)
        if (is_fitted(flight) || !flight.record.no_power_reason.empty()) candidates.push_back(&flight);
    std::ranges::stable_sort(candidates, {}, [&](const BatchFlight* flight) {
        return std::tuple(!is_fitted(*flight), flight->log_is_missing, !flight->record.content.has_definitions);
    });
    return candidates;
}

bool is_used(const BatchFlight& flight, const RecordedPhase& phase) {
    const auto name = mechanical::sortie_name(valid_utf8(flight.record.flight), phase.sortie);
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

BatchFlight without_samples(FlightRecord record, const flight::LoadOptions& options) {
    BatchFlight done;
    auto measured = select_for_fit(record, options);
    done.selection.flights.reserve(measured.flights.size());
    for (auto& flight : measured.flights) {
        SelectedSortie sortie{std::move(flight.samples.flight), {}, flight.only_hovers};
        for (const auto phase : flight::all_phases) sortie.phases[phase] = flight.samples.phases[phase].has_value();
        done.selection.flights.push_back(std::move(sortie));
    }
    done.selection.exclusions = std::move(measured.exclusions);
    done.record = std::move(record);
    return done;
}

BatchFlights run_batch(const std::vector<LogFile>& logs, const BatchOptions& options, const BatchProgress& progress) {
    make_directories(options.out / "flights");
    make_directories(options.out / temporary_folder);
    std::vector<BatchFlights> of_logs(logs.size());
    std::mutex mutex;  // guards `done`
    std::size_t done = 0;
    const auto work = [&](std::size_t i) {
        of_logs[i] = do_log(logs[i], options);
        const std::lock_guard lock(mutex);
        ++done;
        for (const auto& flight : of_logs[i]) progress(done, logs.size(), flight);
    };
    for_each_in_parallel(logs.size(), work, options.jobs);
    return joined(std::move(of_logs));
}

BatchFlights joined(std::vector<BatchFlights> of_logs) {
    BatchFlights flights;
    for (auto& of_log : of_logs) std::ranges::move(of_log, std::back_inserter(flights));
    return flights;
}

std::vector<mechanical::MeasuredFlight> read_samples(const BatchFlights& flights, const BatchOptions& options) {
    std::vector<std::size_t> selected;
    for (std::size_t i = 0; i < flights.size(); ++i)
        if (!flights[i].selection.flights.empty()) selected.push_back(i);
    std::vector<std::vector<mechanical::MeasuredFlight>> of_logs(selected.size());
    for_each_in_parallel(selected.size(), [&](std::size_t i) {
        const auto& flight = flights[selected[i]];
        const OverwriteExemption own;
        const auto file = result_path(options.out, flight.record.flight, record_suffix);
        auto record = record_from_json(read_file(file));
        if (!record) throw InputError({file.string()}, "it changed while it was read", "run flightwatt batch again");
        record->flight = flight.record.flight;  // also of a name that is not UTF-8
        of_logs[i] = select_for_fit(*record, options.load).flights;
        std::erase_if(of_logs[i], [&](const auto& measured) {
            return std::ranges::find(flight.selection.flights, measured.samples.flight, &SelectedSortie::flight) ==
                   flight.selection.flights.end();
        });
    });
    std::vector<mechanical::MeasuredFlight> measured;
    for (auto& of_log : of_logs) std::ranges::move(of_log, std::back_inserter(measured));
    return measured;
}

std::vector<FlightAircraft> fitted_aircraft(const BatchFlights& flights) {
    std::vector<FlightAircraft> fitted;
    for (const auto& flight : flights)
        if (!flight.selection.flights.empty()) fitted.push_back(aircraft_of(flight.record));
    return fitted;
}

std::set<std::string> keep_aircraft(BatchFlights& flights, const AircraftGroup& group,
                                    std::span<const FlightAircraft> fitted) {
    std::set<std::string> others;
    for (const auto& flight : fitted) others.insert(flight.flight);
    for (const auto number : group.flights) others.erase(fitted[number].flight);
    for (auto& flight : flights) {
        flight.is_of_other_aircraft = others.contains(flight.record.flight);
        if (flight.is_of_other_aircraft) flight.selection = {};
    }
    return others;
}

std::string duplicate_reason(const std::string& other) {
    return fmt::format("it is the same flight as {}, which is used", other);
}

std::vector<DuplicateFlight> find_duplicates(const BatchFlights& flights) {
    std::vector<DuplicateFlight> copies;
    std::unordered_map<std::uint64_t, const FlightRecord*> used;  // by fingerprint
    for (const auto* flight : candidates_among(flights)) {
        const auto& record = flight->record;
        if (record.content.fingerprint == 0) continue;
        const auto [original, is_first] = used.emplace(record.content.fingerprint, &record);
        if (!is_first) copies.push_back({record.flight, original->second->flight, record.no_power_reason.empty()});
    }
    std::ranges::sort(copies, {}, &DuplicateFlight::flight);
    return copies;
}

const std::string* original_of(const std::string& flight, const std::vector<DuplicateFlight>& copies) {
    const auto copy = std::ranges::lower_bound(copies, flight, {}, &DuplicateFlight::flight);
    const bool is_found = copy != copies.end() && copy->flight == flight && copy->has_power;
    return is_found ? &copy->same_as : nullptr;
}

void exclude_duplicates(BatchFlights& flights, const std::vector<DuplicateFlight>& copies) {
    for (auto& flight : flights) {
        const auto& name = flight.record.flight;
        const auto copy = std::ranges::lower_bound(copies, name, {}, &DuplicateFlight::flight);
        if (copy == copies.end() || copy->flight != name) continue;
        flight.selection.flights.clear();
        flight.selection.flights.shrink_to_fit();
        flight.selection.exclusions.push_back({name, std::nullopt,
                                               copy->has_power
                                                   ? duplicate_reason(copy->same_as)
                                                   : fmt::format("it is the same flight as {}", copy->same_as)});
    }
}

std::vector<mechanical::Exclusion> exclude_hover(BatchFlights& flights, const std::set<std::string>& keep) {
    const auto hovers = [](const BatchFlight& flight) {
        return std::ranges::any_of(flight.selection.flights, &SelectedSortie::only_hovers);
    };
    const auto is_on_wing = [](const BatchFlight& flight) {
        return !std::ranges::all_of(flight.selection.flights, &SelectedSortie::only_hovers);
    };
    std::vector<mechanical::Exclusion> excluded;
    if (std::ranges::none_of(flights, hovers)) return excluded;
    const auto fitted = fitted_aircraft(flights);
    for (const auto& group : group_aircraft(fitted)) {
        std::set<std::string> names;
        for (const auto number : group.flights) names.insert(fitted[number].flight);
        const auto is_of_group = [&](const BatchFlight& flight) { return names.contains(flight.record.flight); };
        if (std::ranges::none_of(flights, [&](const auto& of) { return is_of_group(of) && is_on_wing(of); })) continue;
        for (auto& flight : flights) {
            if (!is_of_group(flight) || keep.contains(flight.record.flight)) continue;
            std::erase_if(flight.selection.flights, [&](const auto& sortie) {
                if (!sortie.only_hovers) return false;
                excluded.push_back({sortie.flight, std::nullopt, mechanical::hover_reason()});
                flight.selection.exclusions.push_back(excluded.back());
                return true;
            });
        }
    }
    return excluded;
}

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
