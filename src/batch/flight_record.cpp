#include "batch/flight_record.h"

#include "base/fingerprint.h"
#include "flight/power_check.h"
#include "mechanical/flight_bins.h"

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

Fields<Diagnostic> record_fields(const Diagnostic*) {
    using R = Diagnostic;
    return {field("severity", &R::severity, "`note`, `warning` or `error`").reading([](const Json& json, R& r) {
                r.severity = severity_from(json.get<std::string>());
            }),
            field("kind", &R::kind, "shared by diagnostics of one kind"), field("text", &R::text, "the diagnostic")};
}

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

Fields<CircuitShare> record_fields(const CircuitShare*) {
    using R = CircuitShare;
    return {field("name", &R::name, "its battery monitors"), field("energy_wh", &R::energy_wh, "energy in flight"),
            field("percent", &R::percent, "of the energy of all circuits")};
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
    return {field("bank_measured", &R::bank_measured),
            field("lacks", &R::no_bins_reason),
            field("rotorcraft", &R::is_rotorcraft),
            field("payload_known", &R::payload_known),
            field(
                "load",
                [](const R& r) {
                    const auto rotors = r.load.rotors.value_or(RotorLoading{});
                    return std::vector{r.load.payload_kg, rotors.mass_kg, rotors.disc_area_m2};
                },
                "payload, mass and disc area; 0: not stated")
                .reading([](const Json& json, R& r) {
                    r.load.payload_kg = json.at(0).get<double>();
                    if (json.at(1).get<double>() > 0.0) r.load.rotors = {json.at(1), json.at(2)};
                }),
            field("airspeed_sd_m_per_s", &R::airspeed_sd_m_per_s),
            field("mean_airspeed_sd_m_per_s", &R::mean_airspeed_sd_m_per_s),
            field("bins", &R::bins)};
}

Fields<PhaseSamples> record_fields(const PhaseSamples*) {
    using R = PhaseSamples;
    return {field("duration_s", &R::duration_s), field("start_s", &R::start_s), field("edge_samples", &R::edge_samples),
            field("height_m", &R::height_m),     field("tau", &R::tau),         field("power_w", &R::power_w)};
}

}  // namespace mechanical

namespace batch {
namespace {

using OptionalNumber = JsonType<std::optional<double>>;

Json json_of(const mechanical::MeasuredFlight& flight, std::size_t sortie) {
    auto phases = Json::object();
    for (const auto phase : flight::all_phases) {
        const auto& samples = flight.samples.phases[phase];
        if (!samples) continue;
        auto& json = phases[std::string(to_string(phase))];
        json = record_json(*samples);
        json["energy_wh"] = OptionalNumber::write(flight.energy_wh[phase]);
        json["counter_energy_wh"] = OptionalNumber::write(flight.counter_energy_wh[phase]);
    }
    return {
        {"flight", flight.samples.flight},   {"sortie", sortie},
        {"only_hovers", flight.only_hovers}, {"pack_voltage_v", OptionalNumber::write(flight.samples.pack_voltage_v)},
        {"phases", std::move(phases)},       {"motion", record_json(flight.motion)}};
}

Json json_of(const mechanical::MeasuredFlights& measured) {
    auto flights = Json::array();
    for (std::size_t i = 0; i < measured.flights.size(); ++i)
        flights.push_back(json_of(measured.flights[i], measured.sorties[i]));
    return {{"flights", std::move(flights)}, {"excluded", json_list<mechanical::Exclusion>(measured.exclusions)}};
}

/// Throws std::exception for JSON of another type.
void read_measured(const Json& json, mechanical::MeasuredFlights& measured) {
    JsonType<std::vector<mechanical::Exclusion>>::read(json.at("excluded"), measured.exclusions);
    for (const auto& stored : json.at("flights")) {
        auto& flight = measured.flights.emplace_back();
        stored.at("flight").get_to(flight.samples.flight);
        JsonType<std::size_t>::read(stored.at("sortie"), measured.sorties.emplace_back());
        stored.at("only_hovers").get_to(flight.only_hovers);
        OptionalNumber::read(stored.at("pack_voltage_v"), flight.samples.pack_voltage_v);
        for (const auto phase : flight::all_phases) {
            const auto of_phase = stored.at("phases").find(std::string(to_string(phase)));
            if (of_phase == stored.at("phases").end()) continue;
            auto& samples = flight.samples.phases[phase].emplace();
            read_record(*of_phase, samples);
            samples.flight = flight.samples.flight;
            OptionalNumber::read(of_phase->at("energy_wh"), flight.energy_wh[phase]);
            OptionalNumber::read(of_phase->at("counter_energy_wh"), flight.counter_energy_wh[phase]);
        }
        read_record(stored.at("motion"), flight.motion);
        flight.motion.flight = flight.samples.flight;
    }
}

constexpr std::string_view seal_key = ",\n \"seal\": \"";

/// End of a record: the fingerprint of all before, by which changed and truncated records are rejected.
std::string seal_of(std::string_view text) {
    Fingerprint fingerprint;
    fingerprint.add(text);
    return fmt::format("{}{}\"\n}}\n", seal_key, fingerprint.hex());
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

Fields<FlightRecord> record_fields(const FlightRecord*) {
    using R = FlightRecord;
    return {
        field("flight", &R::flight, "name of the flight", csv_column{}),
        field("log", &R::log),
        field("fingerprint", &R::fingerprint),
        field("results", &R::results),
        field("accepted", &R::accepted),
        field("is_of_other_aircraft", &R::is_of_other_aircraft),
        field("recordings", &R::recordings),
        field("aircraft_id", &R::aircraft_id, "id of the aircraft in the log", csv_column{}),
        field("aircraft_name", &R::aircraft_name, "name of the aircraft in the log", csv_column{}),
        field("kind", &R::kind, "kind of vehicle: `fixedwing`, `rotorcraft`, `rover`; empty: unknown", csv_column{}),
        field("pack_voltage_v", &R::pack_voltage_v, "highest voltage, less 1 % of the samples", csv_column{}),
        field("cruise_power_w", &R::cruise_power_w, "mean power of all cruises of the log", csv_column{}),
        field("payload_kg", &R::payload_kg, "payload, if the file states it", csv_column{}),
        field("power_source", &R::power_source, "message of the power", csv_column{}),
        field("error", &R::error, "reason of a rejected log", csv_column{}),
        field("current_origin", &R::current_origin),
        field("phases", &R::phases),
        field("circuits", &R::circuits),
        field("diagnostics", &R::diagnostics),
        field("power_faults", &R::power_faults),
        field("lacks_power", &R::no_power_reason),
        field("why_not_fitted", &R::not_fitted_reason),
        field(
            "measured", [](const R& record) { return json_of(record.measured); }, "data of the fit")
            .reading([](const Json& json, R& record) { read_measured(json, record.measured); }),
        field("content", &R::content)};
}

FlightRecord record_of(const flight::LoadedFlight& loaded) {
    const auto& data = loaded.data;
    const auto& phases = loaded.phases;
    FlightRecord record;
    record.flight = data.flight;
    record.accepted = true;
    const auto aircraft = aircraft_of(loaded);
    record.aircraft_id = aircraft.id;
    record.aircraft_name = aircraft.name;
    record.kind = aircraft.kind;
    record.pack_voltage_v = aircraft.pack_voltage_v;
    record.cruise_power_w = aircraft.cruise_power_w;
    record.payload_kg = first_value(data.payload_kg);
    record.content = content_of(loaded.series);
    record.power_source = data.power_w.source;
    record.current_origin = to_string(data.current_origin);
    record.diagnostics = loaded.diagnostics;
    record.power_faults = loaded.power.power_faults;
    record.no_power_reason = loaded.lacks_power;
    if (record.no_power_reason.empty()) record.measured = mechanical::extract_flights(data, phases);
    record.circuits = circuit_shares(data, phases);
    const flight::PowerStatistics power(data);
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            record.phases.push_back({sortie.number, span.phase, span.start.time_s, span.end.time_s, span.start.gap_s,
                                     span.end.gap_s, span.complete, power.between(span.start.time_s, span.end.time_s)});
        }
    }
    return record;
}

FlightAircraft aircraft_of(const FlightRecord& record) {
    return {record.flight, record.aircraft_id,    record.aircraft_name,
            record.kind,   record.pack_voltage_v, record.cruise_power_w};
}

std::string reason_without_log(const FlightRecord& record) {
    const auto path = record.log + ": ";
    return record.error.starts_with(path) ? record.error.substr(path.size()) : record.error;
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
    if (auto reason = flight::simulation_reason(record.aircraft_name, options); !reason.empty()) return reason;
    if (!record.power_faults.empty()) return flight::describe_power_faults(record.power_faults);
    return record.not_fitted_reason;
}

mechanical::MeasuredFlights select_for_fit(FlightRecord& record, const flight::LoadOptions& options) {
    auto measured = std::exchange(record.measured, {});
    if (const auto exclusion = exclusion_reason(record, options); !exclusion.empty() && record.accepted) {
        measured.flights.clear();
        measured.sorties.clear();
        measured.exclusions.push_back({record.flight, std::nullopt, exclusion});
        return measured;
    }
    return measured;
}

}  // namespace batch
}  // namespace flightwatt
