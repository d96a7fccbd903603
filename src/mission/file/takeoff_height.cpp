#include "mission/file/takeoff_height.h"

#include "base/error.h"
#include "base/units.h"
#include "path/plan_writer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double assumed_m = 120.0;        // the legal limit: most flights of earlier files climbed to less
constexpr double height_error_m = 10.0;    // of a home as plans state it
constexpr double noted_s = 1.0;            // longer or shorter than the model's phase
constexpr double uncertain_percent = 5.0;  // of the energy

/// Of a model's phase, as if all of it were flown to one height if its file states none.
mechanical::PhaseModel with_heights(mechanical::PhaseModel phase) {
    if (!phase.heights)
        phase.heights = mechanical::PhaseHeights{assumed_m, assumed_m, assumed_m, assumed_m / phase.duration_s};
    return phase;
}

/// "take-off: 62 s to 120 m; the model's flights climbed to 24 to 74 m, on average in 21 s".
std::string duration_note(Phase phase, double height_m, double duration_s, const mechanical::PhaseModel& model) {
    const bool is_up = phase == Phase::takeoff;
    const auto note =
        fmt::format("{}: {:.0f} s {} {:.0f} m", phase_word(phase), duration_s, is_up ? "to" : "from", height_m);
    if (!model.heights) return fmt::format("{} instead of the model's {:.0f} s", note, model.duration_s);
    const auto& [mean_m, low_m, high_m, m_per_s] = *model.heights;
    const auto range = low_m == high_m ? fmt::format("{:.0f}", high_m) : fmt::format("{:.0f} to {:.0f}", low_m, high_m);
    return fmt::format("{}; the model's flights {} {} m, on average in {:.0f} s", note,
                       is_up ? "climbed to" : "descended from", range, model.duration_s);
}

}  // namespace

path::ClimbRates flown_rates(const mechanical::MechanicalModel& model) {
    path::ClimbRates rates;
    if (const auto& physical = model.physical) {
        if (physical->climb_m_per_s.high > 0.0) rates.climb_m_per_s = physical->climb_m_per_s.high;
        if (physical->climb_m_per_s.low < 0.0) rates.descent_m_per_s = -physical->climb_m_per_s.low;
    }
    if (const auto& up = model.phases[Phase::takeoff].heights) rates.climb_m_per_s = up->m_per_s;
    if (const auto& down = model.phases[Phase::landing].heights) rates.descent_m_per_s = down->m_per_s;
    return rates;
}

void note_rate_on_spot(const path::FlightPath& path, const path::ClimbRates& rates, MissionSetup& mission) {
    for (const auto& element : path.elements) {
        const auto* hold = std::get_if<path::Hold>(&element.shape);
        const double change_m = element.altitude_change_m;
        const double rate = (change_m > 0.0 ? rates.climb_m_per_s : rates.descent_m_per_s).value_or(0.0);
        if (hold == nullptr || change_m == 0.0 || element.climb_rate_m_per_s ||
            hold->time_s != std::abs(change_m) / rate)
            continue;
        mission.notes.push_back(
            fmt::format("path: {}: {:.0f} m of height above one place are flown at {:.2g} m/s, as "
                        "the model's flights did",
                        element.name, std::abs(change_m), rate));
        return;
    }
}

void read_ground_altitude(const TomlTable& path, path::PathDefaults& defaults) {
    constexpr std::string_view key = "ground_altitude_m";
    if (!path.has(key)) return;
    if (defaults.is_above_ground)
        throw InputError(path.where(key), "the plan states how high its altitudes are above home", "leave it out");
    defaults.ground_m = number_in(between(-1e4, 1e4), path, key);
    defaults.is_above_ground = true;
    defaults.is_above_sea = false;
}

void note_unknown_height(const path::PathDefaults& defaults, MissionSetup& mission) {
    if (!mission.mechanical || !defaults.altitude_m || defaults.is_above_ground) return;
    const auto flown = with_heights(mission.mechanical->phases[Phase::takeoff]);
    if (mission.duration_is_stated[Phase::takeoff] || *defaults.altitude_m <= flown.heights->high_m) return;
    const auto at_start = fmt::format("the {:.0f} m at its start are above", *defaults.altitude_m);
    const auto finding = defaults.is_above_sea ? at_start + " the sea, and the height of home is not stated"
                                               : "whether " + at_start + " the ground is not stated";
    mission.uncertain.push_back(
        fmt::format("{}: take-off and landing are those of the model's flights, of up to {:.0f} m", finding,
                    flown.heights->high_m));
}

void take_heights_as_written(const std::vector<path::PathEntry>& entries, path::PathDefaults& defaults,
                             MissionSetup& mission) {
    const bool has_altitude =
        defaults.altitude_m || std::ranges::any_of(entries, [](const auto& entry) { return !!entry.altitude_m; });
    if (!has_altitude) {
        defaults.altitude_m = defaults.ground_m + path::default_altitude_m;
        defaults.is_above_sea = false;
        mission.notes.push_back(
            fmt::format("path: no altitude is stated: {} m above the ground", path::default_altitude_m));
    } else if (defaults.is_above_sea) {
        mission.notes.emplace_back(
            "path: its altitudes are above the sea, and the height of home is not stated: the files of the packs have them "
            "above the sea, and climbs and descents are counted from 0 m: state altitudes above home");
    } else if (!defaults.is_above_ground) {
        mission.notes.emplace_back(
            "path: what its altitudes are above is not stated: the files of the packs have them above home, and climbs "
            "and descents are counted from there: check them");
    }
    defaults.is_above_ground = true;
}

TakeoffAndLanding takeoff_and_landing(const MissionSetup& mission) {
    TakeoffAndLanding ends{mission.duration_s};
    const auto& plan = *mission.cruise_path->plan;
    if (!plan.start_above_ground_m) return ends;
    PerPhase<double> height_m;
    height_m[Phase::takeoff] = height_m[Phase::landing] = *plan.start_above_ground_m;
    for (const auto& element : plan.path.elements) height_m[Phase::landing] += element.altitude_change_m;
    double energy_j = path::energy_j(*mission.cruise_path);
    double uncertain_j = 0.0;
    bool is_known = true;
    for (const auto phase : {Phase::takeoff, Phase::landing}) {
        const auto& model = mission.mechanical->phases[phase];
        const double mean_w = mean_power_w(model);
        auto& duration_s = ends.duration_s[phase];
        if (mission.duration_is_stated[phase]) {
            energy_j += mean_w * duration_s;
            continue;
        }
        const auto flown = with_heights(model);
        const double to_m = height_m[phase];
        if (to_m < -height_error_m)
            ends.uncertain.push_back(fmt::format("{}: the path {} {:.0f} m below home", phase_word(phase),
                                                 phase == Phase::takeoff ? "begins" : "ends", -to_m));
        duration_s = duration_at_height_s(flown, to_m);
        if (std::abs(duration_s - model.duration_s) >= noted_s)
            ends.notes.push_back(duration_note(phase, to_m, duration_s, model));
        energy_j += mean_w * duration_s;
        uncertain_j += mean_w * std::max(0.0, duration_s - duration_at_height_s(flown, flown.heights->high_m));
        if (model.heights) continue;
        is_known = false;
        uncertain_j += mean_w * model.duration_s * std::clamp(to_m / assumed_m, 0.0, 1.0);
    }
    if (!is_known)
        ends.notes.push_back(fmt::format(
            "take-off and landing: the model does not state how high its flights climbed, {:.0f} m are assumed: fit it "
            "again",
            assumed_m));
    const double percent = units::percentage(uncertain_j, energy_j);
    if (percent < uncertain_percent) return ends;
    ends.uncertain.push_back(fmt::format(
        "{:.0f} % of the energy is of a climb and a descent that {}", percent,
        is_known ? "are higher than the model's flights flew" : "the model's file may not cover: fit it again"));
    return ends;
}

void set_takeoff_and_landing(MissionSetup& mission) {
    auto ends = takeoff_and_landing(mission);
    mission.duration_s = ends.duration_s;
    std::ranges::move(ends.notes, std::back_inserter(mission.notes));
    std::ranges::move(ends.uncertain, std::back_inserter(mission.uncertain));
}

}  // namespace flightwatt::mission
