#pragma once

#include "helpers/small_missions.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"
#include "mission/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::test {

/// A made-up survey of few slots whose lines and schedule are yet to be planned, as the text of its file.
struct SurveyMission {
    std::string text;  ///< all but the lines, up to the keys of [path]
    std::vector<double> spacings_m;
    std::vector<double> headings_deg;
    std::vector<double> airspeeds_m_per_s;
    std::size_t blocks = 1;

    mission::PlanningProblem read(const std::string& lines) const {
        return std::get<mission::PlanningProblem>(
            mission::parse_mission(text + lines, source_dir() / "survey.toml", {.allow_unplanned = true}));
    }

    /// With every choice.
    mission::PlanningProblem problem() const {
        return read(
            fmt::format("spacing_m = {{ levels = [{}], blocks = {} }}\nheading_deg = {}\nairspeed_m_per_s = {}\n",
                        fmt::join(spacings_m, ", "), blocks, values(headings_deg), values(airspeeds_m_per_s)));
    }

    /// With each of the ways to cover its area, as a mission that states them.
    std::vector<mission::PlanningProblem> all() const {
        std::vector<mission::PlanningProblem> missions;
        const std::size_t levels = spacings_m.size() * airspeeds_m_per_s.size();
        const auto ways = static_cast<std::size_t>(std::pow(levels, blocks));
        for (const double heading_deg : headings_deg)
            for (std::size_t way = 0; way < ways; ++way) missions.push_back(read(lines_of(heading_deg, way)));
        return missions;
    }

    /// The greatest utility of any schedule on any lines; none if none lands.
    std::optional<double> max_utility(std::optional<double> known = std::nullopt) const {
        for (const auto& problem : all()) {
            const double covered = coverage_utility(problem.setup);
            const auto beyond = known ? std::optional(*known - covered) : std::nullopt;
            const auto best = EverySchedule(problem, make_planning_tables(problem)).max_utility(beyond);
            if (best) known = std::max(known.value_or(-1.0), *best + covered);
        }
        return known;
    }

  private:
    static std::string values(const std::vector<double>& of) {
        return of.size() == 1 ? fmt::format("{}", of.front()) : fmt::format("{{ levels = [{}] }}", fmt::join(of, ", "));
    }

    std::string lines_of(double heading_deg, std::size_t way) const {
        auto lines = fmt::format("heading_deg = {}\nairspeed_m_per_s = {}\n", heading_deg, airspeeds_m_per_s.front());
        std::string strips;
        for (std::size_t block = 0; block < blocks; ++block) {
            const double airspeed = airspeeds_m_per_s[way % airspeeds_m_per_s.size()];
            way /= airspeeds_m_per_s.size();
            strips += fmt::format("[[path.strip]]\nto = {}\nspacing_m = {}\nairspeed_m_per_s = {}\n",
                                  block + 1 == blocks ? 1.0 : static_cast<double>(block + 1) / blocks,
                                  spacings_m[way % spacings_m.size()], airspeed);
            way /= spacings_m.size();
        }
        return lines + strips;
    }
};

/// A survey of the synthetic wing over the made-up field: one or two blocks, two to four spacings, on a pack that is
/// too small for the densest lines with all of the software.
inline SurveyMission survey_mission(unsigned seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto whole = [&](std::size_t low, std::size_t high) {
        return std::uniform_int_distribution<std::size_t>(low, high)(random);
    };
    SurveyMission made;
    made.blocks = whole(1, 2);
    const std::size_t levels = whole(2, made.blocks == 1 ? 4 : 3);
    double spacing_m = between(35.0, 60.0);
    for (std::size_t i = 0; i < levels; ++i)
        made.spacings_m.push_back(std::exchange(spacing_m, spacing_m * between(1.2, 1.8)));
    made.headings_deg = {between(0.0, 180.0)};
    if (whole(0, 3) == 0) made.headings_deg.push_back(made.headings_deg.front() + 90.0);
    made.airspeeds_m_per_s = {between(11.5, 16.0)};
    if (whole(0, 3) == 0) made.airspeeds_m_per_s.push_back(between(11.5, 16.0));
    const double reserve = between(0.0, 30.0);
    const auto text = [&, slot_s = between(120.0, 250.0), weight = between(2.0, 25.0), fps = between(0.3, 1.5),
                       shape = whole(0, 2), dwell = whole(0, 3), is_off = whole(0, 1), swath_m = between(40.0, 90.0),
                       wind = between(0.0, 4.0)](double capacity_ah) {
        return fmt::format(R"(mechanical = "fits/mechanical/synthetic-wing.toml"
battery = "fits/battery/synthetic-3s.toml"
capacity_ah = {}
reserve_soc_percent = {}
[components.detection]
profile = "fits/compute/tx2-detection.csv"
utility = {{ parameter = "fps", weight = {} }}
[components.encryption]
profile = "fits/compute/tx2-encryption.csv"
utility = {{ parameter = "key_bits", weight = 0.01, shape = "sqrt" }}
[plan]
slot_s = {}
dwell_s = {}
may_be_off = [{}]
levels = {{ detection = {{ fps = [5.8, 10, 16] }}, encryption = {{ key_bits = [32, 240] }} }}
[wind]
speed_m_per_s = {}
from_deg = 200
[path]
area = "missions/synthetic/field.geojson"
swath_m = {}
utility = {{ weight = {}, shape = "{}" }}
)",
                           capacity_ah, reserve, fps, slot_s, dwell == 0 ? 1.5 * slot_s : 0.0,
                           is_off == 0 ? "\"detection\"" : "", wind, swath_m, weight,
                           std::array{"linear", "sqrt", "log"}.at(shape));
    };
    constexpr double ample_ah = 50.0;
    made.text = text(ample_ah);
    double least = 100.0, most = 0.0;
    for (const auto& problem : made.all()) {
        auto flown = with_minimum_energy_schedule(problem);
        least = std::min(least, 100.0 - *simulate(flown).summary.final_soc_percent);
        for (auto& segment : flown.schedule) segment.run = {{0, {16.0}}, {1, {240.0}}};
        most = std::max(most, 100.0 - *simulate(flown).summary.final_soc_percent);
    }
    const double spent = least + between(-0.05, 0.9) * (most - least);  // a few land on no lines
    made.text = text(ample_ah * spent / (100.0 - reserve));
    return made;
}

}  // namespace flightwatt::test
