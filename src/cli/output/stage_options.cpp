#include "cli/output/stage_options.h"

#include "base/error.h"
#include "base/number.h"
#include "battery/battery.h"

namespace flightwatt::cli {

void add_fit_options(Options& options, mechanical::ModelFitOptions& fit) {
    using enum mechanical::Weighting;
    options.add("order", fit.phases.order,
                {.value = "N",
                 .max = mechanical::max_order,
                 .hint = "'flightwatt validate --order N' shows how each order predicts"},
                "order of the Fourier series, 0 to 8");
    options.add_choice("weights", fit.weighting, {{"uniform", uniform}, {"agreement", agreement}}, {.value = "HOW"},
                       "weights of the flights: uniform or agreement");
}

void add_model_options(Options& options, FitArguments& arguments) {
    add_fit_options(options, arguments.fit);
    options.add_choice(
        "model-kind", arguments.kind,
        {{"fourier", ModelKind::fourier}, {"physical", ModelKind::physical}, {"best", ModelKind::best}},
        {.value = "KIND", .old_name = "model"},
        "best: each phase is predicted by its curve over time or by its mean power, as flights excluded from the fit "
        "show, and with an airspeed by the physical model, unless the mean power predicts better; physical: the "
        "physical model in any case, power from airspeed and climb; fourier: the curves in any case, without the other");
    options.add("published", arguments.published, input_file("MODEL.toml"), "show Table I next to this model's");
}

std::optional<mechanical::MechanicalModel> read_published(const FitArguments& arguments) {
    const auto& file = arguments.published;
    return file ? std::optional(mechanical::read_mechanical_model(*file)) : std::nullopt;
}

void add_capacity_option(Options& options, std::optional<double>& capacity_ah, const std::string& description) {
    options.add("capacity", capacity_ah,
                {.value = "AH",
                 .min = 0.0,
                 .max = battery::max_capacity_ah,
                 .above_min = true,
                 .unit = "Ah",
                 .hint = battery::capacity_hint},
                description);
}

void add_folds_option(Options& options, std::size_t& folds) {
    options.add("folds", folds, {.value = "N", .min = 2},
                "exclude more flights than N in N groups, not one by one: the time then grows with the flights, not "
                "with their square");
}

void add_sampling_options(Options& options, SamplingArguments& arguments) {
    options.add("samples", arguments.samples, {.value = "N"},
                "draw N flights from the variability that the models or [uncertainty] state");
    options.add("seed", arguments.seed, {.value = "S", .needs = {"samples"}}, "seed of --samples");
    options.add("disturb", arguments.disturbances, input_file("FILE"),
                "apply the disturbances of FILE (missions/disturbances/)");
}

std::optional<mission::SamplingOptions> sampling_options(const SamplingArguments& arguments, bool with_bands) {
    constexpr std::size_t band_times = 101;
    if (!arguments.samples) return std::nullopt;
    return mission::SamplingOptions{
        .samples = *arguments.samples, .seed = arguments.seed, .band_points = with_bands ? band_times : 0};
}

std::vector<mission::Disturbance> read_disturbances(const SamplingArguments& arguments,
                                                    const mission::MissionSetup& mission) {
    return arguments.disturbances ? mission::read_disturbances(*arguments.disturbances, mission.duration_s)
                                  : std::vector<mission::Disturbance>();
}

void add_plan_options(Options& options, mission::PlanToFly& plan, const std::vector<std::string>& needs) {
    options.add("block", plan.blocks, {.value = "NAME", .needs = needs},
                "a block of a flight plan of Paparazzi; may be given several times, in the order of the flight");
    options.add("airspeed", plan.airspeed_m_per_s,
                {.value = "M_PER_S", .min = 0.0, .max = path::max_m_per_s, .above_min = true, .needs = needs},
                "airspeed along the plan; default: that of the plan, or of the model's flights");
    options.add("spacing", plan.spacing_m,
                {.value = "M", .min = path::min_radius_m, .max = path::max_radius_m, .needs = needs},
                "between the lines over an area; default: of turns with a bank of 30 degrees, of rotorcraft 25 m");
    options.add("swath", plan.swath_m,
                {.value = "M", .min = path::min_radius_m, .max = path::max_radius_m, .needs = {"overlap"}},
                "width of ground that the camera sees, which with --overlap decides the spacing");
    options.add("overlap", plan.overlap_percent,
                {.value = "PERCENT", .min = 0.0, .max = 95.0, .needs = {"swath"}, .excludes = {"spacing"}},
                "part of an image's width that the next line sees again");
    options.add("heading", plan.heading_deg, {.value = "DEG", .min = 0.0, .max = 360.0, .needs = needs},
                "course of these lines; default: with the fewest turns");
    options.add("terrain", plan.terrain, {.value = "FOLDER", .file = FileRole::input, .needs = needs},
                "heights of the ground, tiles of SRTM (N47E008.hgt), for altitudes of the plan above the terrain");
}

path::Wind parse_wind(const std::string& text, bool needs_direction) {
    constexpr double max_m_per_s = 100.0;
    constexpr double degree_per_turn = 360.0;
    const auto at = text.find('@');
    path::Wind wind;
    wind.speed_m_per_s = number_or_nan(text.substr(0, at));
    if (at != std::string::npos) wind.from_deg = number_or_nan(text.substr(at + 1));
    if (wind.speed_m_per_s >= 0.0 && wind.speed_m_per_s <= max_m_per_s && std::abs(wind.from_deg) <= degree_per_turn &&
        (at != std::string::npos || !needs_direction))
        return wind;
    throw UsageError(fmt::format("--wind {}: expected SPEED@DEG in m/s and degrees, such as 6@250{}", text,
                                 needs_direction ? "" : ", or SPEED alone"));
}

}  // namespace flightwatt::cli
