#include "flight/select/positions.h"

#include "base/units.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double max_position_speed_m_per_s = 100.0;
constexpr double position_error_m = 50.0;
constexpr double max_unreachable_part = 0.5;  // more are in another scale, or on another clock

/// Positions in metres or degrees, on the clock of `east`.
struct PositionRecord {
    const Track& east;
    std::vector<double> north;
    bool is_geographic = false;

    std::size_t size() const { return north.size(); }

    /// Whether an aircraft gets from the one to the other, later one in the time between.
    bool reaches(std::size_t from, std::size_t to) const {
        double east_m = east.value[to] - east.value[from];
        double north_m = north[to] - north[from];
        if (is_geographic) {
            constexpr double turn_deg = 360.0;
            const double shrink = std::cos((north[from] + north[to]) / 2.0 / units::degree_per_rad);
            east_m = std::remainder(east_m, turn_deg) * units::metre_per_degree * shrink;
            north_m *= units::metre_per_degree;
        }
        const double reach_m =
            position_error_m + max_position_speed_m_per_s * std::abs(east.time_s[to] - east.time_s[from]);
        return std::hypot(east_m, north_m) <= reach_m;
    }

    bool is_without_fix(std::size_t i) const { return is_geographic && east.value[i] == 0.0 && north[i] == 0.0; }
};

/// Which of the positions `with_fix` are out of reach: from the longest run of positions that reach each other, those
/// before and after it that are reached from the last one.
std::vector<std::size_t> unreachable(const PositionRecord& positions, const std::vector<std::size_t>& with_fix) {
    std::size_t first = 0;
    std::size_t longest = 0;
    for (std::size_t begin = 0, end = 0; begin < with_fix.size(); begin = end) {
        for (end = begin + 1; end < with_fix.size() && positions.reaches(with_fix[end - 1], with_fix[end]);) ++end;
        if (end - begin <= longest) continue;
        first = begin;
        longest = end - begin;
    }
    std::vector<std::size_t> out;
    const auto keep_or_drop = [&](std::size_t i, std::size_t& last) {
        if (positions.reaches(with_fix[last], with_fix[i]))
            last = i;
        else
            out.push_back(with_fix[i]);
    };
    for (std::size_t i = first, last = first; i > 0; --i) keep_or_drop(i - 1, last);
    for (std::size_t i = first + longest, last = i - 1; i < with_fix.size(); ++i) keep_or_drop(i, last);
    return out;
}

/// Removes positions by their indices in `east`, and what `north` has between the others.
void erase_positions(ChosenTrack& east, ChosenTrack& north, const std::vector<std::size_t>& out) {
    std::vector<bool> is_out(east.time_s.size(), false);
    for (const auto i : out) is_out[i] = true;
    const auto is_out_at = [&](double time_s) {
        const auto next = first_at_or_after(east.time_s, time_s);
        if (next < is_out.size() && east.time_s[next] == time_s) return bool(is_out[next]);
        return (next > 0 && is_out[next - 1]) || (next < is_out.size() && is_out[next]);
    };
    erase_samples(north, [&](std::size_t i) { return is_out_at(north.time_s[i]); });
    erase_samples(east, [&](std::size_t i) { return bool(is_out[i]); });
    if (east.empty() || north.empty()) static_cast<Track&>(east) = static_cast<Track&>(north) = {};
}

void remove_unreachable(ChosenTrack& east, ChosenTrack& north, bool is_geographic) {
    if (east.empty() || north.empty()) return;
    const PositionRecord positions{east, resample(north, east.time_s), is_geographic};
    std::vector<std::size_t> out;
    std::vector<std::size_t> with_fix;
    for (std::size_t i = 0; i < positions.size(); ++i) (positions.is_without_fix(i) ? out : with_fix).push_back(i);
    const auto all = positions.size();
    const auto without_fix = out.size();
    const auto far = unreachable(positions, with_fix);
    const bool are_errors = static_cast<double>(far.size()) <= max_unreachable_part * static_cast<double>(all);
    if (are_errors) out.insert(out.end(), far.begin(), far.end());
    const auto source = east.source;
    if (!out.empty()) erase_positions(east, north, out);
    if (without_fix > 0)
        east.notes.push_back(
            fmt::format("{} of {} positions ({}) are removed: latitude and longitude are 0, as "
                        "without a fix",
                        without_fix, all, source));
    if (far.empty()) return;
    east.notes.push_back(fmt::format(
        "{} of {} positions ({}) {}", far.size(), all, source,
        are_errors ? "are removed: no aircraft flies there in the time between the others"
                   : "are farther from the others than an aircraft flies in the time between: distances, maps and "
                     "paths are those of the log; check the unit and the clock"));
}

}  // namespace

void remove_unreachable_positions(FlightData& data) {
    remove_unreachable(data.longitude_deg, data.latitude_deg, true);
    remove_unreachable(data.east_m, data.north_m, false);
}

}  // namespace flightwatt::flight
