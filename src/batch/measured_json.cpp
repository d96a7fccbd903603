#include "batch/measured_json.h"

#include <string>
#include <utility>
#include <vector>

namespace flightwatt::batch {
namespace {

using Json = nlohmann::ordered_json;

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::optional<double> optional_number(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json phase_json(const mechanical::MeasuredFlight& flight, flight::Phase phase) {
    const auto& samples = flight.samples.phases[phase].value();
    Json covariates = Json::object();
    for (const auto covariate : mechanical::all_covariates) {
        if (const auto& value = samples.covariates[covariate]) {
            covariates[std::string(to_string(covariate))] = *value;
        }
    }
    return {{"duration_s", samples.duration_s},
            {"start_s", samples.start_s},
            {"airspeed_cubed_m3_per_s3", optional_json(samples.airspeed_cubed_m3_per_s3)},
            {"covariates", covariates},
            {"energy_wh", optional_json(flight.energy_wh[phase])},
            {"counter_energy_wh", optional_json(flight.counter_energy_wh[phase])},
            {"tau", samples.tau},
            {"power_w", samples.power_w}};
}

void add_phase(mechanical::MeasuredFlight& flight, flight::Phase phase, const Json& json) {
    mechanical::PhaseSamples samples;
    samples.flight = flight.samples.flight;
    samples.duration_s = json.at("duration_s");
    samples.start_s = json.at("start_s");
    samples.airspeed_cubed_m3_per_s3 = optional_number(json.at("airspeed_cubed_m3_per_s3"));
    for (const auto& [name, value] : json.at("covariates").items()) {
        samples.covariates[mechanical::covariate_from(name).value()] = value.get<double>();
    }
    samples.tau = json.at("tau").get<std::vector<double>>();
    samples.power_w = json.at("power_w").get<std::vector<double>>();
    flight.energy_wh[phase] = optional_number(json.at("energy_wh"));
    flight.counter_energy_wh[phase] = optional_number(json.at("counter_energy_wh"));
    flight.samples.phases[phase] = std::move(samples);
}

}  // namespace

Json measured_json(const mechanical::MeasuredFlights& measured) {
    Json flights = Json::array();
    for (std::size_t i = 0; i < measured.flights.size(); ++i) {
        const auto& flight = measured.flights[i];
        Json phases = Json::object();
        for (const auto phase : flight::all_phases) {
            if (flight.samples.phases[phase])
                phases[std::string(to_string(phase))] = phase_json(flight, phase);
        }
        flights.push_back(
            {{"flight", flight.samples.flight}, {"sortie", measured.sorties[i]}, {"phases", phases}});
    }
    Json excluded = Json::array();
    for (const auto& [flight, phase, reason] : measured.exclusions) {
        excluded.push_back(
            {{"flight", flight}, {"phase", phase ? Json(to_string(*phase)) : Json()}, {"reason", reason}});
    }
    return {{"flights", flights}, {"excluded", excluded}};
}

mechanical::MeasuredFlights measured_from_json(const Json& json) {
    mechanical::MeasuredFlights measured;
    for (const auto& entry : json.at("flights")) {
        mechanical::MeasuredFlight flight;
        flight.samples.flight = entry.at("flight");
        for (const auto& [name, phase] : entry.at("phases").items()) {
            add_phase(flight, flight::phase_from(name).value(), phase);
        }
        measured.flights.push_back(std::move(flight));
        measured.sorties.push_back(entry.at("sortie"));
    }
    for (const auto& entry : json.at("excluded")) {
        std::optional<flight::Phase> phase;
        if (const auto& name = entry.at("phase"); !name.is_null()) {
            phase = flight::phase_from(name.get<std::string>()).value();
        }
        measured.exclusions.push_back({entry.at("flight"), phase, entry.at("reason")});
    }
    return measured;
}

}  // namespace flightwatt::batch
