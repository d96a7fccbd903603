#include "batch/flight_record.h"

#include "base/fingerprint.h"
#include "flight/edge_events.h"
#include "flight/power_check.h"
#include "flight/selected_track.h"
#include "mechanical/flight_bins.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace flightwatt {
namespace {

/// A phase by its name, or null. Reading throws std::exception for another name.
template <typename R, typename P>
Field<R> phase_field(P R::*member, const auto&... changes) {
    return field("phase", member, "`takeoff`, `cruise` or `landing`", changes...)
        .reading([member](const Json& json, R& record) {
            if (!json.is_null()) record.*member = flight::phase_from(json.get<std::string>()).value();
        });
}

}  // namespace

namespace flight {

Fields<PhaseStatistics> record_fields(const PhaseStatistics*) {
    using R = PhaseStatistics;
    return {field("samples", &R::samples, "power samples in the phase", csv_column{}),
            field("mean_power_w", &R::mean_power_w, "energy over duration", csv_column{}),
            field("energy_wh", &R::energy_wh, "integral of the power, linear between samples", csv_column{}),
            field("counter_energy_wh", &R::counter_energy_wh, "energy by the autopilot's counter", csv_column{}),
            field("gaps", &R::gaps, "intervals between samples that exceed three median ones", csv_column{}),
            field("longest_gap_s", &R::max_gap_s, "the longest interval between samples", csv_column{})};
}

Fields<FlightContent> record_fields(const FlightContent*) {
    using R = FlightContent;
    return {field("fingerprint", &R::fingerprint), field("has_definitions", &R::has_definitions)};
}

}  // namespace flight

namespace mechanical {

Fields<Exclusion> record_fields(const Exclusion*) {
    using R = Exclusion;
    return {field("flight", &R::flight), phase_field(&R::phase), field("reason", &R::reason)};
}

Fields<FlightBin> record_fields(const FlightBin*) {
    using R = FlightBin;
    return {phase_field(&R::phase),
            field("start_s", &R::start_s),
            field("duration_s", &R::duration_s),
            field("power_w", &R::power_w),
            field("samples", &R::samples),
            field(
                "terms", [](const R& bin) { return bin.values.values; }, "means of the terms of the physical model")
                .reading([](const Json& json, R& bin) { json.get_to(bin.values.values); }),
            field("airspeed_m_per_s", &R::airspeed_m_per_s)};
}

Fields<BinnedFlight> record_fields(const BinnedFlight*) {
    using R = BinnedFlight;
    return {field("bank_measured", &R::bank_measured), field("lacks", &R::no_bins_reason), field("bins", &R::bins)};
}

Fields<PhaseSamples> record_fields(const PhaseSamples*) {
    using R = PhaseSamples;
    return {field("duration_s", &R::duration_s), field("start_s", &R::start_s), field("edge_samples", &R::edge_samples),
            field("tau", &R::tau), field("power_w", &R::power_w)};
}

}  // namespace mechanical

namespace batch {
namespace {

/// A phase of a sortie as it is fitted.
struct StoredPhase {
    mechanical::PhaseSamples samples;
    std::optional<double> energy_wh;
    std::optional<double> counter_energy_wh;
};

struct StoredPhases {
    std::optional<StoredPhase> takeoff, cruise, landing;
};

struct StoredSortie {
    std::string flight;
    std::size_t sortie = 0;
    StoredPhases phases;
    mechanical::BinnedFlight motion;
};

struct StoredMeasurement {
    std::vector<StoredSortie> flights;
    std::vector<mechanical::Exclusion> excluded;
};

Fields<StoredPhase> record_fields(const StoredPhase*) {
    using R = StoredPhase;
    return list_fields<R>(embedded(&R::samples), field("energy_wh", &R::energy_wh),
                          field("counter_energy_wh", &R::counter_energy_wh));
}

Fields<StoredPhases> record_fields(const StoredPhases*) {
    using R = StoredPhases;
    return {field("takeoff", &R::takeoff, "samples of the take-off", optional_key{}),
            field("cruise", &R::cruise, "samples of the cruise", optional_key{}),
            field("landing", &R::landing, "samples of the landing", optional_key{})};
}

Fields<StoredSortie> record_fields(const StoredSortie*) {
    using R = StoredSortie;
    return {field("flight", &R::flight), field("sortie", &R::sortie), field("phases", &R::phases),
            field("motion", &R::motion)};
}

Fields<StoredMeasurement> record_fields(const StoredMeasurement*) {
    using R = StoredMeasurement;
    return {field("flights", &R::flights), field("excluded", &R::excluded)};
}

constexpr std::array stored_phases{&StoredPhases::takeoff, &StoredPhases::cruise, &StoredPhases::landing};

StoredMeasurement stored(const mechanical::MeasuredFlights& measured) {
    StoredMeasurement all{{}, measured.exclusions};
    for (std::size_t i = 0; i < measured.flights.size(); ++i) {
        const auto& flight = measured.flights[i];
        auto& sortie =
            all.flights.emplace_back(StoredSortie{flight.samples.flight, measured.sorties[i], {}, flight.motion});
        for (const auto phase : flight::all_phases)
            if (const auto& samples = flight.samples.phases[phase])
                sortie.phases.*stored_phases.at(static_cast<std::size_t>(phase)) =
                    StoredPhase{*samples, flight.energy_wh[phase], flight.counter_energy_wh[phase]};
    }
    return all;
}

mechanical::MeasuredFlights measured_flights(StoredMeasurement all) {
    mechanical::MeasuredFlights measured;
    measured.exclusions = std::move(all.excluded);
    for (auto& sortie : all.flights) {
        auto& flight = measured.flights.emplace_back();
        flight.samples.flight = sortie.flight;
        for (const auto phase : flight::all_phases) {
            auto& stored = sortie.phases.*stored_phases.at(static_cast<std::size_t>(phase));
            if (!stored) continue;
            stored->samples.flight = sortie.flight;
            flight.samples.phases[phase] = std::move(stored->samples);
            flight.energy_wh[phase] = stored->energy_wh;
            flight.counter_energy_wh[phase] = stored->counter_energy_wh;
        }
        flight.motion = std::move(sortie.motion);
        flight.motion.flight = sortie.flight;
        measured.sorties.push_back(sortie.sortie);
    }
    return measured;
}

constexpr std::string_view seal_key = ",\n \"seal\": \"";

/// End of a record: the fingerprint of all before, by which changed and truncated records are rejected.
std::string seal_of(std::string_view text) {
    Fingerprint fingerprint;
    fingerprint.add(text);
    return fmt::format("{}{}\"\n}}\n", seal_key, fingerprint.hex());
}

/// The best autopilot event of an edge, and whether it agrees.
std::string edge_check(const flight::EdgeReport& explained) {
    if (explained.matching_events.empty()) return explained.agreement;
    const auto& best = explained.matching_events.front();
    const bool agrees = std::abs(best.after_s) <= flight::agreement_s;
    return fmt::format("{} {} {} ({:+.1f} s)", explained.agreement, agrees ? "with" : "from", best.what, best.after_s);
}

}  // namespace

Fields<RecordedPhase> record_fields(const RecordedPhase*) {
    using R = RecordedPhase;
    const auto duration_s = [](const R& phase) { return phase.end_s - phase.start_s; };
    return list_fields<R>(
        field("sortie", &R::sortie, "flight of the log, from 1", csv_column{}), phase_field(&R::phase, csv_column{}),
        field("start_s", &R::start_s, "in the log's time", csv_column{}),
        field("end_s", &R::end_s, "in the log's time", csv_column{}),
        field("duration_s", duration_s, "end less start", csv_column{}, not_in_json{}),
        field("start_gap_s", &R::start_gap_s), field("end_gap_s", &R::end_gap_s), embedded(&R::statistics),
        field("complete", &R::complete, "false: the log begins or ends in the phase", csv_column{}));
}

Fields<RecordedEdgeCheck> record_fields(const RecordedEdgeCheck*) {
    using R = RecordedEdgeCheck;
    return {field("time_s", &R::time_s), field("verdict", &R::text)};
}

Fields<FlightRecord> record_fields(const FlightRecord*) {
    using R = FlightRecord;
    return {field("flight", &R::flight, "name of the flight", csv_column{}),
            field("log", &R::log),
            field("fingerprint", &R::fingerprint),
            field("results", &R::results),
            field("accepted", &R::accepted),
            field("is_of_other_aircraft", &R::is_of_other_aircraft),
            field("aircraft_id", &R::aircraft_id, "id of the aircraft in the log", csv_column{}),
            field("aircraft_name", &R::aircraft_name, "name of the aircraft in the log", csv_column{}),
            field("power_source", &R::power_source, "message of the power", csv_column{}),
            field("error", &R::error, "reason of a rejected log", csv_column{}),
            field("current_origin", &R::current_origin),
            field("phases", &R::phases),
            field("verdicts", &R::edge_checks),
            field("warnings", &R::warnings),
            field("power_faults", &R::power_faults),
            field("lacks_power", &R::no_power_reason),
            field("why_not_fitted", &R::not_fitted_reason),
            field(
                "measured", [](const R& record) { return stored(record.measured); }, "data of the fit")
                .reading([](const Json& json, R& record) {
                    StoredMeasurement all;
                    read_record(json, all);
                    record.measured = measured_flights(std::move(all));
                }),
            field("content", &R::content)};
}

FlightRecord record_of(const flight::LoadedFlight& loaded) {
    const auto& series = loaded.series;
    const auto& phases = loaded.phases;
    FlightRecord record;
    record.flight = series.flight;
    record.accepted = true;
    record.aircraft_id = series.aircraft_id;
    record.aircraft_name = series.aircraft_name;
    record.content = content_of(series);
    record.power_source = power_track(series).source;
    record.current_origin = to_string(series.current_origin);
    record.warnings = loaded.warnings;
    record.power_faults = loaded.power.power_faults;
    record.no_power_reason = loaded.lacks_power;
    if (record.no_power_reason.empty()) record.measured = mechanical::extract_flights(series, phases, 0);
    const flight::SelectedTracks tracks(series);
    const flight::PowerStatistics power(series);
    for (const auto& sortie : phases.sorties) {
        for (const auto& edge : compare_edges_with_events(tracks, sortie)) {
            record.edge_checks.push_back({edge.edge.time_s, edge_check(edge)});
        }
        for (const auto& span : sortie.phases) {
            record.phases.push_back({sortie.number, span.phase, span.start.time_s, span.end.time_s, span.start.gap_s,
                                     span.end.gap_s, span.complete, power.between(span.start.time_s, span.end.time_s)});
        }
    }
    return record;
}

std::string to_json_text(const FlightRecord& record) {
    // File names need not be UTF-8, and a record must never fail for that.
    auto text = record_json(record).dump(1, ' ', false, Json::error_handler_t::replace);
    text.resize(text.size() - std::string_view("\n}").size());
    return text + seal_of(text);
}

std::optional<FlightRecord> record_from_json(const std::string& text) {
    const auto end = text.rfind(seal_key);
    if (end == std::string::npos || text.substr(end) != seal_of(std::string_view(text).substr(0, end)))
        return std::nullopt;
    try {
        FlightRecord record;
        read_record(Json::parse(text.substr(0, end) + "}"), record);
        return record;
    } catch (const std::exception&) {
        return std::nullopt;  // of another version: the log is read again
    }
}

std::string exclusion_reason(const FlightRecord& record, const flight::LoadOptions& options) {
    if (options.excluded.contains(record.flight)) return "--exclude names it";
    if (!record.no_power_reason.empty()) return record.no_power_reason;
    if (options.keep.contains(record.flight)) return "";
    if (!record.power_faults.empty()) return flight::describe_power_faults(record.power_faults);
    return record.not_fitted_reason;
}

mechanical::MeasuredFlights select_for_fit(FlightRecord& record, std::size_t needed_samples,
                                           const flight::LoadOptions& options) {
    auto measured = std::exchange(record.measured, {});
    if (const auto exclusion = exclusion_reason(record, options); !exclusion.empty() && record.accepted) {
        measured.flights.clear();
        measured.sorties.clear();
        measured.exclusions.push_back({record.flight, std::nullopt, exclusion});
        return measured;
    }
    mechanical::exclude_short_phases(measured, needed_samples);
    return measured;
}

}  // namespace batch
}  // namespace flightwatt
