#pragma once

#include "base/number.h"
#include "cli/stage.h"
#include "mission/sampled_flights.h"

#include <optional>

#include <fmt/format.h>

/// What simulate and compare have in common about --samples.
namespace flightwatt::cli {

inline void add_sampling_options(cli::StageDefinition& stage) {
    namespace po = boost::program_options;
    stage.options.add_options()("samples", po::value<std::string>()->value_name("N"),
                                "draw N flights from what the models (or [uncertainty]) say of how they "
                                "differ")("seed", po::value<std::string>()->value_name("S"),
                                          "of --samples; 1 if not given");
}

/// None without --samples.
inline std::optional<mission::SamplingOptions> sampling_options(const cli::StageCall& call, bool with_bands) {
    constexpr std::size_t band_times = 101;
    const auto whole = [&](const std::string& option) {
        const auto value = parse_unsigned(call.get<std::string>(option));
        if (value) return *value;
        throw UsageError(fmt::format("--{} {}: expected a whole number", option,
                                     cli::one_line(call.get<std::string>(option))));
    };
    if (!call.has("samples")) {
        for (const std::string option : {"seed", "samples-csv"}) {
            if (call.has(option)) throw UsageError(fmt::format("--{} belongs to --samples", option));
        }
        return std::nullopt;
    }
    mission::SamplingOptions options;
    options.samples = whole("samples");
    if (call.has("seed")) options.seed = whole("seed");
    if (with_bands) options.band_times = band_times;
    return options;
}

}  // namespace flightwatt::cli
