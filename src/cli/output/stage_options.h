#pragma once

#include "cli/stage.h"
#include "mechanical/model_fit.h"
#include "mission/disturbance.h"
#include "mission/mission.h"
#include "mission/new_mission_path.h"
#include "mission/sampled_flights.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Options that several stages have: of a fit, of a battery's capacity, of drawn flights and of groups of flights.
namespace flightwatt::cli {

/// What is fitted.
enum class ModelKind {
    fourier,   ///< the curves over time alone, which predict whatever their error
    physical,  ///< as best, and the physical model whatever its error
    best       ///< what mechanical::add_best_power decides and adds
};

struct FitArguments {
    mechanical::ModelFitOptions fit;
    ModelKind kind = ModelKind::best;
    std::optional<std::string> published;
};

/// --order and --weights.
void add_fit_options(Options& options, mechanical::ModelFitOptions& fit);

/// The same with --model-kind and --published.
void add_model_options(Options& options, FitArguments& arguments);

/// The model of --published.
std::optional<mechanical::MechanicalModel> read_published(const FitArguments& arguments);

/// --capacity, with its own description.
void add_capacity_option(Options& options, std::optional<double>& capacity_ah, const std::string& description);

/// --folds: the number of groups of flights that are excluded together.
void add_folds_option(Options& options, std::size_t& folds);

struct SamplingArguments {
    std::optional<std::size_t> samples;
    std::uint64_t seed = 1;
    std::optional<std::string> disturbances;
};

/// --samples, --seed and --disturb.
void add_sampling_options(Options& options, SamplingArguments& arguments);

/// How flights are drawn; std::nullopt without --samples.
std::optional<mission::SamplingOptions> sampling_options(const SamplingArguments& arguments, bool with_bands);

/// The disturbances of --disturb for a mission.
std::vector<mission::Disturbance> read_disturbances(const SamplingArguments& arguments,
                                                    const mission::MissionSetup& mission);

/// How a plan is flown: --block, --airspeed, --terrain, and --spacing, --swath, --overlap and --heading of lines over an
/// area. `needs` are options of which one has to be given with each.
void add_plan_options(Options& options, mission::PlanToFly& plan, const std::vector<std::string>& needs);

/// The wind of --wind: "6@250" is 6 m/s from 250 degrees. Without a direction it is 0, unless `needs_direction`. Throws
/// UsageError for another text.
path::Wind parse_wind(const std::string& text, bool needs_direction);

}  // namespace flightwatt::cli
