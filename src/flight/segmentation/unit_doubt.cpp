#include "base/units.h"
#include "flight/segmentation/flight_rejection.h"
#include "flight/sources/outliers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double window_s = 10.0;
constexpr double wrong_factor = 1.7;  // feet are 3.28 times as many
constexpr std::size_t enough_windows = 5;
constexpr double moves_m = 5.0;
constexpr double min_correlation = 0.8;

/// change(first, last) of the grid's points at the ends of windows that follow each other, piece by piece.
template <typename Change>
std::vector<double> changes_of(const ResampledFlight& grid, const Change& change) {
    std::vector<double> changes_m;
    const auto steps = grid.steps(window_s);
    changes_m.reserve(grid.size() / steps + 1);
    for (const auto& piece : grid.pieces)
        for (auto i = piece.begin; i + steps < piece.end; i += steps) changes_m.push_back(change(i, i + steps));
    return changes_m;
}

/// How another altitude, or the integral of a climb rate, changes; what is absurd of it tells nothing.
std::vector<double> changes_said(const ResampledFlight& grid, const Track& track) {
    const double max_m = physical_bounds("altitude_m").value().high;
    const bool is_altitude = track.name == "altitude_m";
    std::vector<double> middles_s(is_altitude ? 0 : grid.size());
    for (std::size_t i = 0; i < middles_s.size(); ++i) middles_s[i] = grid.time_s(i) + 0.5 * grid.step_s;
    const auto climb_m_per_s = resample(track, middles_s);
    return changes_of(grid, [&](std::size_t first, std::size_t last) {
        double change_m = is_altitude ? value_at(track, grid.time_s(last)) - value_at(track, grid.time_s(first)) : 0.0;
        for (auto k = first; k < last && !is_altitude; ++k) change_m += grid.step_s * climb_m_per_s[k];
        return std::abs(change_m) <= max_m ? change_m : 0.0;
    });
}

/// How many times as much `b` moves as `a` (as long), where one of them moves; std::nullopt where they hardly do, or
/// have nothing to do with each other.
std::optional<double> times_as_much(const std::vector<double>& a, const std::vector<double>& b) {
    std::size_t moves = 0;
    double aa = 0.0;
    double ab = 0.0;
    double bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::max(std::abs(a[i]), std::abs(b[i])) < moves_m) continue;
        ++moves;
        aa += a[i] * a[i];
        ab += a[i] * b[i];
        bb += b[i] * b[i];
    }
    if (moves < enough_windows || aa == 0.0 || ab < min_correlation * std::sqrt(aa * bb)) return std::nullopt;
    return ab / aa;
}

std::string unit_of(double times) {
    const auto is_near = [&](double factor) { return times > 0.8 * factor && times < 1.25 * factor; };
    return is_near(100.0) ? "cm" : is_near(1000.0) ? "mm" : is_near(3.28084) ? "feet" : "another unit than m";
}

}  // namespace

std::string suspected_unit_error(const SelectedTracks& tracks, const ResampledFlight& grid) {
    const auto& chosen = tracks["altitude_m"];
    const auto seen = changes_of(
        grid, [&](std::size_t first, std::size_t last) { return grid.altitude_m[last] - grid.altitude_m[first]; });
    const auto doubt_by = [&](const Track& said, const char* how) -> std::string {
        const auto times = times_as_much(changes_said(grid, said), seen);
        if (!times || (*times<wrong_factor&& * times> 1.0 / wrong_factor)) return "";
        return fmt::format("{} moves {:.3g} times as much as {}{} says: is one of them in {}?", chosen.source, *times,
                           how, said.source, unit_of(std::max(*times, 1.0 / *times)));
    };
    if (const auto& climb = tracks["climb_m_per_s"]; !climb.empty()) {
        if (auto doubt = doubt_by(climb, "the climb rate of "); !doubt.empty()) return doubt;
    }
    for (const auto& track : tracks.series().tracks) {
        if (track.name != "altitude_m" || track.source == chosen.source || track.empty()) continue;
        if (auto doubt = doubt_by(track, ""); !doubt.empty()) return doubt;
    }
    return "";
}

}  // namespace flightwatt::flight
