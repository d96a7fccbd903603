#include "batch/batch_fit.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "base/overwrite_guard.h"
#include "base/toml_reader.h"
#include "batch/manifest.h"
#include "mechanical/fit_records.h"

#include <cstddef>
#include <exception>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {

Fields<CurveBand> record_fields(const CurveBand*) {
    using R = CurveBand;
    return {field("time_s", &R::time_s), field("low_95_w", &R::low_95_w), field("high_95_w", &R::high_95_w),
            field("flights_low_w", &R::flights_low_w), field("flights_high_w", &R::flights_high_w)};
}

}  // namespace flightwatt::mechanical

namespace flightwatt::batch {
namespace {

constexpr std::size_t max_fit_bytes = 16'000'000;  // fit.json has some 100 kB

Json json_of(const BatchFit& fit) {
    Json json{{"format", format_version},
              {"options", {{"order", fit.options.phases.order}, {"weights", to_string(fit.options.weighting)}}},
              {"exclude", fit.excluded},
              {"keep", fit.keep},
              {"other_aircraft", fit.other_aircraft},
              {"key", fit.key},
              {"copies", Json::array()}};
    for (const auto& copy : fit.copies)
        if (copy.has_power) json["copies"].push_back({{"flight", copy.flight}, {"of", copy.same_as}});
    for (const auto phase : flight::all_phases)
        json["bands"][std::string(to_string(phase))] = record_json(fit.bands[phase]);
    return json;
}

/// Of all that a fit consists of.
std::string seal_of(std::string_view model, std::string_view model_errors, const Json& json) {
    Fingerprint fingerprint;
    for (const auto text : {model, model_errors}) fingerprint.add(text);
    fingerprint.add(json.dump(-1, ' ', false, Json::error_handler_t::replace));
    return fingerprint.hex();
}

void read_fit_json(const Json& json, BatchFit& fit) {
    const auto& options = json.at("options");
    fit.options.phases.order = options.at("order");
    fit.options.weighting = mechanical::weighting_from(options.at("weights").get<std::string>()).value();
    fit.excluded = json.at("exclude").get<std::set<std::string>>();
    fit.keep = json.at("keep").get<std::set<std::string>>();
    fit.other_aircraft = json.value("other_aircraft", std::set<std::string>());  // not in 0.2
    fit.key = json.value("key", std::string());                                  // not in 0.2
    for (const auto& copy : json.at("copies")) fit.copies.push_back({copy.at("flight"), copy.at("of")});
    for (const auto phase : flight::all_phases)
        read_record(json.at("bands").at(std::string(to_string(phase))), fit.bands[phase]);
}

}  // namespace

BatchFit fit_flights(std::span<const mechanical::FlightSamples> flights, const mechanical::ModelFitOptions& options) {
    auto fitted = fit_model(flights, options);
    const auto analyses = mechanical::analyse_model(fitted);
    BatchFit fit{options, {}, {}, {}, {}, {}, {}, curve_bands(fitted, analyses)};
    fit.model = std::move(fitted.model);
    return fit;
}

std::string fit_key(const BatchFlights& flights, const BatchFit& fit) {
    Fingerprint fingerprint;
    fingerprint.add(FLIGHTWATT_VERSION " fit 3");
    fingerprint.add(fit.options.name);
    fingerprint.add(json_of(fit).dump(-1, ' ', false, Json::error_handler_t::replace));  // options and names
    for (const auto& [record, up_to_date, of_this_run, missing, other_aircraft, selection] : flights) {
        if (selection.flights.empty()) continue;
        for (const auto& text : {record.flight, record.fingerprint, record.results}) fingerprint.add(text);
        fingerprint.add(fmt::format("{}", record.content.fingerprint));
        for (const auto& sortie : selection.flights) {
            fingerprint.add(sortie.flight);
            fingerprint.add(fmt::format("{}", fmt::join(sortie.phases.values, " ")));
        }
    }
    return fingerprint.hex();
}

void write_batch_fit(const BatchFit& fit, const std::filesystem::path& out) {
    const auto with_errors = to_toml(fit.model);
    auto plain = fit.model;
    for (auto& phase : plain.phases.values) {
        phase.errors.reset();
        phase.spread.reset();
    }
    const auto model = to_toml(plain);
    auto json = json_of(fit);
    json["seal"] = seal_of(model, with_errors, json);
    write_file_atomically(out / model_errors_name, with_errors, out / temporary_folder);
    write_file_atomically(out / model_name, model, out / temporary_folder);
    const auto text = json.dump(1, ' ', false, Json::error_handler_t::replace);  // names need not be UTF-8
    write_file_atomically(out / fit_name, text + "\n", out / temporary_folder);
}

std::optional<BatchFit> unchanged_batch_fit(const std::filesystem::path& out, const std::string& key) {
    const OverwriteExemption own;
    try {
        auto json = Json::parse(read_file(out / fit_name, max_fit_bytes));
        const auto seal = json.at("seal").get<std::string>();
        json.erase("seal");
        if (json.at("key") != key ||
            seal != seal_of(read_file(out / model_name), read_file(out / model_errors_name), json))
            return std::nullopt;
        return read_batch_fit(out);
    } catch (const std::exception&) {
        return std::nullopt;  // missing, damaged or of another version
    }
}

std::vector<std::string> remove_batch_fit(const std::filesystem::path& out) {
    std::vector<std::string> removed;
    for (const auto* name : model_names) {
        std::error_code ignored;
        if (std::filesystem::remove(out / name, ignored)) removed.emplace_back(name);
    }
    return removed;
}

std::optional<BatchFit> read_batch_fit(const std::filesystem::path& out) {
    if (!std::filesystem::exists(out / model_name)) return std::nullopt;
    const std::string again = "run flightwatt batch again";
    for (const auto* name : {fit_name, model_errors_name}) {
        if (std::filesystem::exists(out / name)) continue;
        throw InputError({(out / name).string()}, "does not exist: the batch is of another version", again);
    }
    BatchFit fit;
    const auto file = out / fit_name;
    read_batch_json(file, read_file(file, max_fit_bytes), "not a fit of a batch of this version", again,
                    [&](const Json& json) { read_fit_json(json, fit); });
    fit.model = mechanical::read_mechanical_model(out / model_errors_name);
    return fit;
}

}  // namespace flightwatt::batch
