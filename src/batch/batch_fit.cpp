#include "batch/batch_fit.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "base/overwrite_guard.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "batch/manifest.h"
#include "mechanical/fit_records.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

using Json = nlohmann::ordered_json;

Json band_json(const mechanical::CurveBand& band) {
    return {{"time_s", band.time_s},
            {"low_95_w", band.low_95_w},
            {"high_95_w", band.high_95_w},
            {"flights_low_w", band.flights_low_w},
            {"flights_high_w", band.flights_high_w}};
}

mechanical::CurveBand band_from(const Json& json) {
    const auto numbers = [&](const char* key) { return json.at(key).get<std::vector<double>>(); };
    return {numbers("time_s"), numbers("low_95_w"), numbers("high_95_w"), numbers("flights_low_w"),
            numbers("flights_high_w")};
}

Json options_json(const mechanical::ModelFitOptions& options) {
    return {{"order", options.phases.order}, {"weights", to_string(options.weighting)}};
}

mechanical::ModelFitOptions options_from(const Json& json) {
    mechanical::ModelFitOptions options;
    options.phases.order = json.at("order");
    options.weighting = mechanical::weighting_from(json.at("weights").get<std::string>()).value();
    return options;
}

/// Raised with every change of the fit that changes a model: older models are fitted again.
constexpr auto fit_number = "fit 4";

constexpr auto copies_key = "copies";
constexpr auto copies_without_power_key = "copies_without_power";

constexpr std::size_t max_fit_bytes = 16'000'000;  // fit.json has some 100 kB

Json json_of(const BatchFit& fit) {
    Json copies = Json::array();
    Json without_power = Json::array();
    for (const auto& [flight, same_as, has_power] : fit.copies)
        (has_power ? copies : without_power).push_back({{"flight", flight}, {"of", same_as}});
    Json bands = Json::object();
    for (const auto phase : flight::all_phases) bands[std::string(to_string(phase))] = band_json(fit.bands[phase]);
    Json json{{"format", format_version},
              {"options", options_json(fit.options)},
              {"exclude", fit.excluded},
              {"keep", fit.keep}};
    json[copies_key] = std::move(copies);
    json[copies_without_power_key] = std::move(without_power);
    json["made_from"] = fit.input_fingerprint;
    json["bands"] = std::move(bands);
    return json;
}

std::string text_of(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

void read_fit_json(const std::filesystem::path& file, BatchFit& fit) {
    const std::string again = "run flightwatt batch again";
    try {
        const auto json = parse_json(read_file(file, max_fit_bytes));
        if (json.at("format").get<double>() > format_version) {
            throw InputError(
                {file.string()},
                fmt::format("its format is newer than this program, which reads formats up to {}", format_version),
                "use a newer FlightWatt, or " + again);
        }
        fit.options = options_from(json.at("options"));
        fit.excluded = json.at("exclude").get<std::set<std::string>>();
        fit.keep = json.at("keep").get<std::set<std::string>>();
        for (const auto* key : {copies_key, copies_without_power_key})
            for (const auto& copy : json.at(key))
                fit.copies.push_back({copy.at("flight"), copy.at("of"), key == copies_key});
        std::ranges::sort(fit.copies, {}, &DuplicateFlight::flight);
        for (const auto phase : flight::all_phases) {
            fit.bands[phase] = band_from(json.at("bands").at(std::string(to_string(phase))));
        }
    } catch (const InputError&) {
        throw;
    } catch (const UsageError&) {
        throw;
    } catch (const std::exception&) {
        throw InputError({file.string()}, "not a fit of a batch of this version", again);
    }
}

/// Fingerprint of the files of a fit except fit.json, and of its content.
std::string seal_of(const std::filesystem::path& out, const Json& json) {
    const OverwriteExemption own;
    Fingerprint seal;
    seal.add(json.dump());
    for (const auto* name : model_names) {
        if (std::string_view(name) == fit_name) continue;
        seal.add(name);
        if (std::filesystem::exists(out / name)) seal.add(read_file(out / name));
    }
    return seal.hex();
}

/// All of the options, as text.
std::string text_of(const mechanical::ModelFitOptions& options) {
    auto json = options_json(options);
    json["name"] = options.name;
    for (const auto phase : flight::all_phases) json[std::string(to_string(phase))] = options.phases.order;
    return json.dump();
}

}  // namespace

std::string fit_fingerprint(const BatchFlights& flights, const mechanical::ModelFitOptions& options,
                            const std::string& more) {
    Fingerprint fingerprint;
    const auto add = [&](std::string_view text) {
        fingerprint.add(fmt::format("{}:", text.size()));  // keeps neighbouring texts apart
        fingerprint.add(text);
    };
    add(FLIGHTWATT_VERSION);
    add(fit_number);
    add(text_of(options));
    add(more);
    for (const auto& [record, was_up_to_date, is_of_this_run, is_kept, selection] : flights) {
        if (valid_utf8(record.flight) != record.flight) return "";  // its JSON cannot name the flights
        add(is_kept ? "kept" : "");
        add(record.flight);
        add(record.results);
        add(record.fingerprint);
        for (const auto& sortie : selection.flights) {
            add(sortie.flight);
            for (const auto phase : flight::all_phases) add(sortie.phases[phase] ? "+" : "-");
        }
    }
    return fingerprint.hex();
}

bool is_fit_current(const std::filesystem::path& out, const std::string& made_from) {
    if (made_from.empty()) return false;
    const OverwriteExemption own;
    try {
        auto json = parse_json(read_file(out / fit_name, max_fit_bytes));
        const auto seal = json.at("seal").get<std::string>();
        json.erase("seal");
        return json.at("made_from").get<std::string>() == made_from && seal == seal_of(out, json);
    } catch (const std::exception&) {
        return false;  // missing, or of another version: the model is fitted again
    }
}

BatchFit fit_flights(std::span<const mechanical::FlightSamples> flights, const mechanical::ModelFitOptions& options) {
    auto fitted = fit_model(flights, options);
    const auto analyses = mechanical::analyse_model(fitted);
    BatchFit fit{options, {}, {}, {}, {}, curve_bands(fitted, analyses), {}};
    fit.model = std::move(fitted.model);
    return fit;
}

void write_batch_fit(const BatchFit& fit, const std::filesystem::path& out) {
    write_file_atomically(out / model_errors_name, to_toml(fit.model), out / temporary_folder);
    auto plain = fit.model;
    for (auto& phase : plain.phases.values) {
        phase.errors.reset();
        phase.spread.reset();
    }
    write_file_atomically(out / model_name, to_toml(plain), out / temporary_folder);
    auto sealed = Json::parse(text_of(json_of(fit)));  // as it is read: names that are not UTF-8 change
    sealed["seal"] = seal_of(out, sealed);
    write_file_atomically(out / fit_name, text_of(sealed), out / temporary_folder);
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
    for (const auto* name : {fit_name, model_errors_name}) {
        if (std::filesystem::exists(out / name)) continue;
        throw InputError({(out / name).string()}, "does not exist: the batch is of another version",
                         "run flightwatt batch again");
    }
    BatchFit fit;
    read_fit_json(out / fit_name, fit);
    fit.model = mechanical::read_mechanical_model(out / model_errors_name);
    return fit;
}

}  // namespace flightwatt::batch
