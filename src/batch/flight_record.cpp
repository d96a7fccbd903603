#include "batch/flight_record.h"

#include "base/fingerprint.h"
#include "flight/edge_events.h"
#include "flight/power_check.h"
#include "flight/selected_track.h"
#include "mechanical/flight_bins.h"

#include <cmath>
#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

using Json = nlohmann::ordered_json;

/// T is a Record that is written, or read into.
template <typename T, typename Record>
concept Of = std::same_as<std::remove_const_t<T>, Record>;

// The fields of each record: `visit` is called with their keys and with what they hold, for writing and for reading.

void visit_fields(Of<RecordedPhase> auto& phase, const auto& visit) {
    visit("sortie", phase.sortie);
    visit("phase", phase.phase);
    visit("start_s", phase.start_s);
    visit("end_s", phase.end_s);
    visit("start_gap_s", phase.start_gap_s);
    visit("end_gap_s", phase.end_gap_s);
    visit("complete", phase.complete);
    visit("samples", phase.statistics.samples);
    visit("mean_power_w", phase.statistics.mean_power_w);
    visit("energy_wh", phase.statistics.energy_wh);
    visit("counter_energy_wh", phase.statistics.counter_energy_wh);
    visit("gaps", phase.statistics.gaps);
    visit("longest_gap_s", phase.statistics.max_gap_s);
}

template <typename Flight, typename Samples, typename Visit>
void visit_measured_phase(Flight& flight, flight::Phase phase, Samples& samples, const Visit& visit) {
    visit("duration_s", samples.duration_s);
    visit("start_s", samples.start_s);
    visit("edge_samples", samples.edge_samples);
    visit("energy_wh", flight.energy_wh[phase]);
    visit("counter_energy_wh", flight.counter_energy_wh[phase]);
    visit("tau", samples.tau);
    visit("power_w", samples.power_w);
}

void visit_fields(Of<RecordedEdgeCheck> auto& check, const auto& visit) {
    visit("time_s", check.time_s);
    visit("verdict", check.text);
}

void visit_fields(Of<mechanical::Exclusion> auto& exclusion, const auto& visit) {
    visit("flight", exclusion.flight);
    visit("phase", exclusion.phase);
    visit("reason", exclusion.reason);
}

void visit_fields(Of<mechanical::FlightBin> auto& bin, const auto& visit) {
    visit("phase", bin.phase);
    visit("start_s", bin.start_s);
    visit("duration_s", bin.duration_s);
    visit("power_w", bin.power_w);
    visit("samples", bin.samples);
    visit("terms", bin.values.values);
    visit("airspeed_m_per_s", bin.airspeed_m_per_s);
}

void visit_fields(Of<mechanical::BinnedFlight> auto& motion, const auto& visit) {
    visit("bank_measured", motion.bank_measured);
    visit("lacks", motion.no_bins_reason);
    visit("bins", motion.bins);
}

void visit_fields(Of<flight::FlightContent> auto& content, const auto& visit) {
    visit("fingerprint", content.fingerprint);
    visit("has_definitions", content.has_definitions);
}

void visit_fields(Of<FlightRecord> auto& record, const auto& visit) {
    visit("flight", record.flight);
    visit("log", record.log);
    visit("fingerprint", record.fingerprint);
    visit("results", record.results);
    visit("accepted", record.accepted);
    visit("error", record.error);
    visit("is_of_other_aircraft", record.is_of_other_aircraft);
    visit("aircraft_id", record.aircraft_id);
    visit("aircraft_name", record.aircraft_name);
    visit("power_source", record.power_source);
    visit("current_origin", record.current_origin);
    visit("phases", record.phases);
    visit("verdicts", record.verdicts);
    visit("warnings", record.warnings);
    visit("power_faults", record.power_faults);
    visit("lacks_power", record.no_power_reason);
    visit("why_not_fitted", record.not_fitted_reason);
    visit("measured", record.measured);
    visit("content", record.content);
}

template <typename T>
concept HasFields = requires(T& record) {
    visit_fields(record, 0);
};

/// Writes what it visits into an object.
struct RecordWriter {
    Json& json;

    template <typename T>
    void operator()(const char* key, const T& value) const {
        json[key] = json_of(value);
    }

  private:
    template <typename T>
    static Json json_of(const T& value) {
        if constexpr (HasFields<T>) {
            Json json = Json::object();
            visit_fields(value, RecordWriter{json});
            return json;
        } else {
            return value;
        }
    }
    template <HasFields T>
    static Json json_of(const std::vector<T>& records) {
        Json json = Json::array();
        for (const auto& record : records) json.push_back(json_of(record));
        return json;
    }
    template <typename T>
    static Json json_of(const std::optional<T>& value) {
        return value ? json_of(*value) : Json();
    }
    static Json json_of(flight::Phase phase) { return to_string(phase); }
    static Json json_of(const mechanical::MeasuredFlights& measured) {
        Json flights = Json::array();
        for (std::size_t i = 0; i < measured.flights.size(); ++i) {
            const auto& flight = measured.flights[i];
            Json phases = Json::object();
            for (const auto phase : flight::all_phases) {
                const auto& samples = flight.samples.phases[phase];
                if (!samples) continue;
                visit_measured_phase(flight, phase, *samples, RecordWriter{phases[std::string(to_string(phase))]});
            }
            flights.push_back({{"flight", flight.samples.flight},
                               {"sortie", measured.sorties[i]},
                               {"phases", phases},
                               {"motion", json_of(flight.motion)}});
        }
        return {{"flights", flights}, {"excluded", json_of(measured.exclusions)}};
    }
};

/// A whole number that the type holds: nlohmann::json would convert any number, and one beyond the type's range has no
/// defined value. Throws std::out_of_range.
template <std::integral T>
T whole(const Json& json) {
    if (json.is_number_unsigned()) {
        if (const auto value = json.get<std::uint64_t>(); std::in_range<T>(value)) return static_cast<T>(value);
    } else if (json.is_number_integer()) {
        if (const auto value = json.get<std::int64_t>(); std::in_range<T>(value)) return static_cast<T>(value);
    }
    throw std::out_of_range("not such a whole number");
}

/// Reads what it visits from an object. Throws what nlohmann::json throws, or std::bad_optional_access for a
/// phase that there is none of.
struct RecordReader {
    const Json& json;

    template <typename T>
    void operator()(const char* key, T& value) const {
        read(json.at(key), value);
    }

  private:
    template <typename T>
    static void read(const Json& json, T& value) {
        if constexpr (HasFields<T>) {
            visit_fields(value, RecordReader{json});
        } else if constexpr (std::integral<T> && !std::same_as<T, bool>) {
            value = whole<T>(json);
        } else {
            json.get_to(value);
        }
    }
    template <typename T>
    static void read(const Json& json, std::optional<T>& value) {
        if (!json.is_null()) read(json, value.emplace());
    }
    static void read(const Json& json, flight::Phase& phase) {
        phase = flight::phase_from(json.get<std::string>()).value();
    }
    template <HasFields T>
    static void read(const Json& json, std::vector<T>& records) {
        for (const auto& entry : json) read(entry, records.emplace_back());
    }
    static void read(const Json& json, mechanical::MeasuredFlights& measured) {
        for (const auto& entry : json.at("flights")) {
            auto& flight = measured.flights.emplace_back();
            flight.samples.flight = entry.at("flight");
            for (const auto& [name, object] : entry.at("phases").items()) {
                const auto phase = flight::phase_from(name).value();
                auto& samples = flight.samples.phases[phase].emplace();
                samples.flight = flight.samples.flight;
                visit_measured_phase(flight, phase, samples, RecordReader{object});
            }
            read(entry.at("motion"), flight.motion);
            flight.motion.flight = flight.samples.flight;
            measured.sorties.push_back(whole<std::size_t>(entry.at("sortie")));
        }
        read(json.at("excluded"), measured.exclusions);
    }
};

constexpr std::string_view seal_key = ",\n \"seal\": \"";

/// What a record ends with: the fingerprint of all before. One that was changed or cut is not believed.
std::string seal_of(std::string_view text) {
    Fingerprint fingerprint;
    fingerprint.add(text);
    return fmt::format("{}{}\"\n}}\n", seal_key, fingerprint.hex());
}

/// What the best witness of an edge says.
std::string verdict_text(const flight::EdgeReport& explained) {
    if (explained.matching_events.empty()) return explained.agreement;
    const auto& best = explained.matching_events.front();
    const bool agrees = std::abs(best.after_s) <= flight::agreement_s;
    return fmt::format("{} {} {} ({:+.1f} s)", explained.agreement, agrees ? "with" : "from", best.what, best.after_s);
}

}  // namespace

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
            record.verdicts.push_back({edge.edge.time_s, verdict_text(edge)});
        }
        for (const auto& span : sortie.phases) {
            record.phases.push_back({sortie.number, span.phase, span.start.time_s, span.end.time_s, span.start.gap_s,
                                     span.end.gap_s, span.complete, power.between(span.start.time_s, span.end.time_s)});
        }
    }
    return record;
}

std::string to_json_text(const FlightRecord& record) {
    Json json;
    visit_fields(record, RecordWriter{json});
    // File names need not be UTF-8, and a record must never fail for that.
    auto text = json.dump(1, ' ', false, Json::error_handler_t::replace);
    text.resize(text.size() - std::string_view("\n}").size());
    return text + seal_of(text);
}

std::optional<FlightRecord> record_from_json(const std::string& text) {
    const auto end = text.rfind(seal_key);
    if (end == std::string::npos || text.substr(end) != seal_of(std::string_view(text).substr(0, end)))
        return std::nullopt;
    try {
        FlightRecord record;
        visit_fields(record, RecordReader{Json::parse(text.substr(0, end) + "}")});
        return record;
    } catch (const std::exception&) {
        return std::nullopt;  // of another version: the log is done again
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

}  // namespace flightwatt::batch
