#include "cli/output/sampling_output.h"

#include "cli/numeric_options.h"

#include <fmt/format.h>

namespace flightwatt::cli {

void add_sampling_options(StageDefinition& stage) {
    namespace po = boost::program_options;
    stage.options.add_options()(
        "samples", po::value<std::string>()->value_name("N"),
        "draw N flights from what the models (or [uncertainty]) say of how they differ")(
        "seed", po::value<std::string>()->value_name("S"), "of --samples; 1 if not given");
}

std::optional<mission::SamplingOptions> sampling_options(const StageCall& call, bool with_bands) {
    constexpr std::size_t band_times = 101;
    if (!call.has("samples")) {
        for (const std::string option : {"seed", "samples-csv"}) {
            if (call.has(option)) throw UsageError(fmt::format("--{} belongs to --samples", option));
        }
        return std::nullopt;
    }
    mission::SamplingOptions options;
    options.samples = count_option(call, "samples");
    if (call.has("seed")) options.seed = count_option(call, "seed");
    if (with_bands) options.band_times = band_times;
    return options;
}

}  // namespace flightwatt::cli
