#include "report/sections/page_data.h"

#include "report/sections/mission_card.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr std::array outcome_classes{"keeps", "may-miss", "may-miss", "misses", "fails"};

VegaJson phases_of(const mission::MissionSetup& mission) {
    auto phases = VegaJson::array();
    const auto timeline = mission::timeline_of(mission.duration_s);
    for (const auto phase : flight::all_phases)
        if (mission.duration_s[phase] > 0.0)
            phases.push_back({{"phase", phase_word(phase)},
                              {"start_s", rounded_json(timeline.start_s[phase], 1)},
                              {"end_s", rounded_json(timeline.end_s[phase], 1)}});
    return phases;
}

VegaJson band_of(const mission::MissionSummary& summary) {
    if (!known_probability_below_reserve(summary) || summary.samples->bands.empty()) return {};
    auto band = VegaJson{{"time_s", VegaJson::array()}, {"low", VegaJson::array()}, {"high", VegaJson::array()}};
    for (const auto& row : summary.samples->bands) {
        band["time_s"].push_back(rounded_json(row.time_s, 1));
        band["low"].push_back(rounded_json(row.p05_percent, 1));
        band["high"].push_back(rounded_json(row.p95_percent, 1));
    }
    return band;
}

VegaJson cell_data(const QosCell& cell) {
    const auto& summary = cell.simulation.summary;
    auto data = curve_data(cell.simulation);
    data["keeps"] = cell.probability ? VegaJson(probability_text(*cell.probability)) : VegaJson();
    data["utility"] = summary.utility ? rounded_json(*summary.utility, 2) : VegaJson();
    return data;
}

}  // namespace

VegaJson rounded_json(double value, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::isfinite(value) ? VegaJson(std::round(value * scale) / scale) : VegaJson();
}

std::string data_block(const std::string& id, const VegaJson& data) {
    return fmt::format("<script type=\"application/json\" id=\"data-{}\">{}</script>\n", id, script_json(data));
}

VegaJson curve_data(const mission::Simulation& simulation) {
    const auto& summary = simulation.summary;
    auto time_s = VegaJson::array();
    auto soc_percent = VegaJson::array();
    for (const auto& row : simulation.curve.rows) {
        time_s.push_back(rounded_json(row.time_s, 1));
        soc_percent.push_back(rounded_json(row.soc_percent, 1));
    }
    return {{"time_s", time_s},
            {"soc", soc_percent},
            {"landing", summary.feasible ? rounded_json(*summary.final_soc_percent, 1) : VegaJson()},
            {"end_s", rounded_json(mission::powered_end_s(summary), 1)},
            {"duration_s", rounded_json(summary.duration_s, 1)}};
}

VegaJson missions_data(std::span<const SimulatedMission> missions) {
    auto all = VegaJson::array();
    for (const auto& mission : missions) {
        const auto& summary = mission.simulation.summary;
        auto data = curve_data(mission.simulation);
        data["title"] = mission.title;
        data["outcome"] = outcome_classes.at(static_cast<std::size_t>(outcome_of(mission)));
        data["reserve"] = summary.reserve_soc_percent;
        data["utility"] = summary.utility ? rounded_json(*summary.utility, 2) : VegaJson();
        data["phases"] = phases_of(mission.mission.setup);
        data["band"] = band_of(summary);
        all.push_back(std::move(data));
    }
    return all;
}

VegaJson quality_data(const QosGrid& grid, const std::vector<std::size_t>& missions, double reserve_percent) {
    auto cells = VegaJson::array();
    for (const auto& cell : grid.cells) cells.push_back(cell_data(cell));
    return {{"x", grid.x.name},           {"xs", grid.x.nodes},   {"y", grid.y.name}, {"ys", grid.y.nodes},
            {"reserve", reserve_percent}, {"missions", missions}, {"cells", cells}};
}

}  // namespace flightwatt::report
