#include "flight/segment/altitude_record.h"

#include "flight/checks/runs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

// Larger changes between samples are jumps: 60 m/s is more than a small aircraft climbs or dives, and an estimator may
// correct itself by 10 m.
constexpr double jump_m = 10.0;
constexpr double jump_m_per_s = 60.0;
constexpr double fix_jump_m = 60.0;  // next to repeated values, and across removed samples
constexpr double fix_jump_m_per_s = 5.0;
constexpr double excursion_s = 30.0;    // an altitude that returns from a jump within this time is removed,
constexpr double fix_loss_s = 120.0;    // or within this time, if it was stuck (no fix)
constexpr std::size_t max_jumps = 10;   // of a usable altitude
constexpr double stuck_s = 10.0;        // a value that is repeated for this time,
constexpr std::size_t stuck_count = 5;  // in this many samples, is that of an estimator without a fix
constexpr double min_pause_s = 2.5;     // of a link that may deliver what it held
constexpr double max_pause_s = 10.0;
constexpr double delivery_s = 2.0;      // of what was held
constexpr double climb_m_per_s = 15.0;  // and descent, of most aircraft
constexpr double min_piece_s = 5.0;
constexpr double long_piece_s = 20.0;
constexpr double max_jump_m = 1000.0;
constexpr std::size_t passes = 10;    // a removal may create further excursions
constexpr std::size_t returns = 100;  // jumps among which the return is searched

/// Samples of long runs of one value.
std::vector<bool> stuck_altitudes(const Track& track) {
    std::vector<bool> stuck(track.value.size(), false);
    for (const auto& run : runs_of_equal(track.value, stuck_count))
        if (track.time_s[run.end - 1] - track.time_s[run.begin] >= stuck_s) set_part(stuck, run, true);
    return stuck;
}

bool is_beyond(const Track& track, std::size_t i, std::size_t j, double step_m, double rate_m_per_s) {
    return std::abs(track.value[j] - track.value[i]) > step_m + rate_m_per_s * (track.time_s[j] - track.time_s[i]);
}

/// How far each sample may be from the one before it, as a link that held samples delivers them at once: what an
/// aircraft climbs or descends in the pause before.
std::vector<double> allowed_after_pause_m(const Track& track) {
    std::vector<double> allowed_m(track.time_s.size(), 0.0);
    double pause_s = 0.0;
    double pause_end_s = 0.0;
    for (std::size_t i = 1; i < allowed_m.size(); ++i) {
        const double step_s = track.time_s[i] - track.time_s[i - 1];
        if (step_s >= min_pause_s) {
            pause_s = std::min(step_s, max_pause_s);
            pause_end_s = track.time_s[i];
        } else if (pause_s > 0.0 && track.time_s[i] - pause_end_s <= delivery_s) {
            allowed_m[i] = climb_m_per_s * pause_s;
        }
    }
    return allowed_m;
}

/// The pieces between jumps, in order.
std::vector<IndexSpan> pieces_of(const Track& track) {
    const auto stuck = stuck_altitudes(track);
    const auto allowed_m = allowed_after_pause_m(track);
    const auto continues = [&](std::size_t i) {
        const bool has_fix = !stuck[i - 1] && !stuck[i];
        return (has_fix || !is_beyond(track, i - 1, i, fix_jump_m, fix_jump_m_per_s)) &&
               !is_beyond(track, i - 1, i, jump_m + allowed_m[i], jump_m_per_s);
    };
    return runs_of(
        {0, stuck.size()}, [](std::size_t) { return true; }, continues);
}

/// The samples after jumps, in order.
std::vector<std::size_t> jumps_of(const Track& track) {
    std::vector<std::size_t> jumps;
    for (const auto& piece : pieces_of(track))
        if (piece.begin > 0) jumps.push_back(piece.begin);
    return jumps;
}

/// Removes the samples between a jump and its return. Returns their number.
std::size_t remove_excursions(Track& track) {
    const auto jumps = jumps_of(track);
    std::vector<bool> out(track.time_s.size(), false);
    const auto stuck = stuck_altitudes(track);
    std::size_t after = 0;  // the first sample after the last removal
    for (std::size_t a = 0; a < jumps.size(); ++a) {
        const auto first = jumps[a];
        if (first < after) continue;
        for (std::size_t b = a + 1; b < std::min(jumps.size(), a + returns); ++b) {
            const auto back = jumps[b];
            const bool is_stuck = b == a + 1 && stuck[first] && stuck[back - 1];
            const double max_s = is_stuck ? fix_loss_s : excursion_s;
            if (track.time_s[back] - track.time_s[first - 1] > max_s) break;
            if (is_beyond(track, first - 1, back, fix_jump_m, fix_jump_m_per_s)) continue;
            set_part(out, {first, back}, true);
            after = back;
            break;
        }
    }
    return erase_samples(track, [&](std::size_t i) { return out[i]; });
}

/// Removes short pieces between jumps. Returns the number of samples.
std::size_t remove_short_pieces(Track& track) {
    const auto pieces = pieces_of(track);
    if (pieces.size() == 1) return 0;
    std::vector<bool> out(track.time_s.size(), false);
    for (const auto& piece : pieces)
        if (track.time_s[piece.end - 1] - track.time_s[piece.begin] < min_piece_s) set_part(out, piece, true);
    return erase_samples(track, [&](std::size_t i) { return out[i]; });
}

/// Whether an altitude that moves for a while on both sides jumps further than an estimator that gets a fix.
bool jumps_too_far(const Track& track) {
    const auto stuck = stuck_altitudes(track);
    const auto pieces = pieces_of(track);
    const auto lasts = [&](const IndexSpan& piece) {
        return track.time_s[piece.end - 1] - track.time_s[piece.begin] >= long_piece_s;
    };
    for (std::size_t p = 1; p < pieces.size(); ++p) {
        const auto i = pieces[p].begin;
        const bool moves = !stuck[i - 1] && !stuck[i] && lasts(pieces[p - 1]) && lasts(pieces[p]);
        if (moves && std::abs(track.value[i] - track.value[i - 1]) > max_jump_m) return true;
    }
    return false;
}

/// The first change, over several samples, that is too fast for the same reason as a jump; empty without one.
IndexSpan find_too_fast(const Track& track) {
    const auto allowed_m = allowed_after_pause_m(track);
    IndexSpan climb{0, 0};  // from the sample with the least altitude less what is climbed at jump_m_per_s
    IndexSpan dive{0, 0};
    for (std::size_t i = 0; i < track.value.size(); ++i) {
        for (auto* change : {&climb, &dive}) {
            const double sign = change == &climb ? 1.0 : -1.0;
            const double gained_m = sign * (track.value[i] - track.value[change->begin]);
            const double most_m = jump_m_per_s * (track.time_s[i] - track.time_s[change->begin]);
            if (gained_m > jump_m + most_m) return {change->begin, i};
            if (gained_m < most_m || allowed_m[i] > 0.0) change->begin = i;
        }
    }
    return {0, 0};
}

}  // namespace

CleanedAltitude clean_altitude(Track altitude) {
    CleanedAltitude record;
    const auto all = altitude.time_s.size();
    const auto [low, high] = std::minmax_element(altitude.value.begin(), altitude.value.end());
    const double min_m = all > 0 ? *low : 0.0;
    const double max_m = all > 0 ? *high : 0.0;
    altitude.value = running_median<3>(altitude.value);
    const auto before = jumps_of(altitude);
    const double first_jump_s = before.empty() ? 0.0 : altitude.time_s[before.front()];
    std::size_t removed = 0;
    const auto until_none = [&](std::size_t (*leave)(Track&)) {
        for (std::size_t count = before.size(), pass = 0; count > 0 && pass < passes; ++pass) {
            count = altitude.empty() ? 0 : leave(altitude);
            removed += count;
        }
    };
    until_none(remove_excursions);
    const auto lasting = jumps_of(altitude).size();
    until_none(remove_short_pieces);
    const auto jumps = jumps_of(altitude);
    record.altitude = std::move(altitude);
    const auto& left = record.altitude;
    for (const auto i : jumps) record.jumps_s.push_back(left.time_s[i]);
    const bool runs_away = 2 * removed > all || left.time_s.size() < 2 || jumps_too_far(left);
    if (runs_away || lasting > max_jumps) {
        record.unusable_reason =
            fmt::format("the altitude runs from {:.6g} to {:.6g} m{}: its estimator diverged, or its unit is not m",
                        min_m, max_m, lasting > 0 ? fmt::format(" with {} jumps", lasting) : "");
    }
    if (removed > 0) {
        record.warnings.push_back(
            fmt::format("{} of {} altitudes are removed, between jumps away and back, first at {:.1f} s", removed, all,
                        first_jump_s));
    }
    if (const auto [from, to] = find_too_fast(left); to > from && jumps.empty())
        record.warnings.push_back(fmt::format(
            "the altitude changes by {:+.0f} m in {:.2g} s at {:.1f} s, faster than an aircraft: is the time in s, and "
            "the altitude in m?",
            left.value[to] - left.value[from], left.time_s[to] - left.time_s[from], left.time_s[from]));
    if (!jumps.empty()) {
        const auto i = jumps.front();
        record.warnings.push_back(
            fmt::format("the altitude jumps by {:+.0f} m at {:.1f} s{}: before and after it the ground levels differ",
                        left.value[i] - left.value[i - 1], left.time_s[i],
                        jumps.size() > 1 ? fmt::format(" (and {} more times)", jumps.size() - 1) : ""));
    }
    return record;
}

}  // namespace flightwatt::flight
