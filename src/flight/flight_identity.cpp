#include "flight/flight_identity.h"

#include "flight/flight_phases.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <string_view>
#include <utility>

#include <boost/algorithm/string/predicate.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

// A mark is a pair of values that differ, of up to so many samples and seconds apart: copies that lost other lines
// still share many, and of what differs hardly any two flights share one, at one time between them.
constexpr std::size_t farthest_sample = 8;
constexpr double farthest_s = 10.0;
constexpr double interval_step_s = 0.25;  // clocks that drift and jitter a little say the same
constexpr std::size_t max_marks = 512;
constexpr std::size_t max_candidate_marks = 8192;
constexpr std::size_t indexed_marks = 128;
constexpr std::size_t max_sharing = 64;  // what more flights have in common tells of none
constexpr std::size_t min_indexed = 3;
// Of two recordings of one flight.
constexpr std::size_t min_shared = 6;
constexpr double min_shared_part = 0.05;
constexpr std::size_t min_told = 10;
constexpr double min_block_s = 30.0;
constexpr double max_blocks = 24.0;
constexpr double min_agreeing = 0.5;
constexpr double clock_slack_s = 1.0;
constexpr double clock_drift = 2e-3;

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) + 0x9E3779B97F4A7C15U;  // splitmix64
    state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9U;
    state = (state ^ (state >> 27)) * 0x94D049BB133111EBU;
    return state ^ (state >> 31);
}

/// Those of the track up to a fingerprint.
void add_marks(const Track& track, std::uint64_t highest, std::vector<SketchHash>& marks) {
    auto seed = mixed(0, 3);  // as in the records of earlier batches
    for (const char c : track.name + ' ' + track.source) seed = mixed(seed, static_cast<unsigned char>(c));
    const bool is_altitude = track.name == "altitude_m";
    const auto bits = [&](std::size_t i) { return std::bit_cast<std::uint64_t>(track.value[i] + 0.0); };
    for (std::size_t i = 0; i < track.value.size(); ++i) {
        const auto last = std::min(track.value.size(), i + 1 + farthest_sample);
        for (auto j = i + 1; j < last && track.time_s[j] - track.time_s[i] <= farthest_s; ++j) {
            if (track.value[j] == track.value[i]) continue;
            const auto interval = std::llround((track.time_s[j] - track.time_s[i]) / interval_step_s);
            const auto mark = mixed(mixed(mixed(seed, bits(i)), bits(j)), static_cast<std::uint64_t>(interval));
            if (mark > highest) continue;
            marks.push_back({is_altitude ? mark | 1U : mark & ~std::uint64_t{1}, to_millisecond(track.time_s[i])});
        }
    }
}

/// The least ones, rising, without those that recur.
void keep_least(std::vector<SketchHash>& marks) {
    std::ranges::sort(marks, {}, [](const SketchHash& mark) { return std::pair(mark.fingerprint, mark.time_s); });
    std::size_t kept = 0;
    for (std::size_t begin = 0, end = 0; begin < marks.size() && kept < max_marks; begin = end) {
        while (end < marks.size() && marks[end].fingerprint == marks[begin].fingerprint) ++end;
        if (end == begin + 1) marks[kept++] = marks[begin];
    }
    marks.resize(kept);
}

/// The marks of the tracks with the least fingerprints. Of a long flight only the lowest part of the fingerprints is
/// searched, unless too many of these recur.
std::vector<SketchHash> least_marks(const std::vector<const Track*>& tracks) {
    std::size_t values = 0;
    for (const auto* track : tracks) values += track->value.size();
    std::vector<SketchHash> marks;
    for (auto parts = farthest_sample * values / max_candidate_marks + 1;; parts = 1) {
        for (const auto* track : tracks) add_marks(*track, std::numeric_limits<std::uint64_t>::max() / parts, marks);
        keep_least(marks);
        if (parts == 1 || marks.size() == max_marks) return marks;
        marks.clear();
    }
}

/// The marks that can be in the other too: beyond the last of a full sketch nothing is known.
std::span<const SketchHash> comparable(const FlightSketch& one, const FlightSketch& other) {
    const std::span<const SketchHash> marks = one.hashes;
    if (other.hashes.size() < max_marks) return marks;
    return {marks.begin(),
            std::ranges::upper_bound(marks, other.hashes.back().fingerprint, {}, &SketchHash::fingerprint)};
}

/// Of marks in both: when, by the clock of the first, and how much later than by that of the second.
struct SharedMark {
    std::uint64_t fingerprint;
    double time_s;
    double offset_s;
};

/// Those that one offset of the clocks explains, as far as clocks drift: the offset with the most.
std::vector<SharedMark> at_one_offset(std::vector<SharedMark> shared, double slack_s) {
    std::ranges::sort(shared, {}, &SharedMark::offset_s);
    std::size_t best = 0;
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < shared.size(); ++begin) {
        while (end < shared.size() && shared[end].offset_s <= shared[begin].offset_s + slack_s) ++end;
        if (end - begin <= most) continue;
        best = begin;
        most = end - begin;
    }
    return {shared.begin() + static_cast<std::ptrdiff_t>(best),
            shared.begin() + static_cast<std::ptrdiff_t>(best + most)};
}

template <typename Marks>
std::size_t blocks_of(const Marks& marks, double block_s) {
    std::set<long> blocks;
    for (const auto& mark : marks) blocks.insert(std::lround(mark.time_s / block_s));
    return blocks.size();
}

/// Whether altitude, and what is electrical, both agree as far as both logs tell of them: one of two may follow from a
/// plan.
bool agree_in_kind(std::span<const SketchHash> marks, std::span<const SketchHash> with,
                   const std::vector<SharedMark>& shared) {
    for (const bool is_altitude : {false, true}) {
        const auto count = [&](const auto& all) {
            return static_cast<std::size_t>(
                std::ranges::count_if(all, [&](const auto& mark) { return (mark.fingerprint & 1U) == is_altitude; }));
        };
        const auto told = std::min(count(marks), count(with));
        if (told < min_told) continue;
        if (static_cast<double>(count(shared)) < min_shared_part * static_cast<double>(told)) return false;
    }
    return true;
}

/// Both rise.
std::vector<SharedMark> shared_marks(std::span<const SketchHash> marks, std::span<const SketchHash> with) {
    std::vector<SharedMark> shared;
    auto other = with.begin();
    for (const auto& mark : marks) {
        while (other != with.end() && other->fingerprint < mark.fingerprint) ++other;
        if (other == with.end()) break;
        if (other->fingerprint == mark.fingerprint)
            shared.push_back({mark.fingerprint, mark.time_s, mark.time_s - other->time_s});
    }
    return shared;
}

}  // namespace

std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name) {
    constexpr int century = 2000;
    constexpr int hours_a_day = 24;
    constexpr int sixty = 60;  // minutes, and seconds
    static const std::regex pattern(
        "(?:^|[^0-9])([0-9]{2})_([0-9]{2})_([0-9]{2})__([0-9]{2})_([0-9]{2})_([0-9]{2})(?:$|[^0-9])");
    std::smatch found;
    if (!std::regex_search(name, found, pattern)) return std::nullopt;
    const auto part = [&](std::size_t group) { return std::stoi(found[group].str()); };
    const std::chrono::year_month_day date{std::chrono::year{century + part(1)},
                                           std::chrono::month{static_cast<unsigned>(part(2))},
                                           std::chrono::day{static_cast<unsigned>(part(3))}};
    if (!date.ok() || part(4) >= hours_a_day || part(5) >= sixty || part(6) >= sixty) return std::nullopt;
    return std::chrono::sys_days{date} + std::chrono::hours{part(4)} + std::chrono::minutes{part(5)} +
           std::chrono::seconds{part(6)};
}

FlightSketch make_sketch(const FlightSeries& series) {
    constexpr std::array<std::string_view, 4> names{"altitude_m", "voltage_v", "current_a", "power_w"};
    FlightSketch content;
    content.has_definitions = !series.log_is_missing;
    content.samples = power_track(series).time_s.size();
    if (content.samples == 0) content.samples = select_track(series, "altitude_m").time_s.size();
    std::vector<const Track*> tracks;
    for (const auto& track : series.tracks)
        if (std::ranges::find(names, track.name) != names.end() && !is_constant(track)) tracks.push_back(&track);
    content.hashes = least_marks(tracks);
    return content;
}

SketchMatch compare_sketches(const FlightSketch& one, const FlightSketch& other) {
    auto marks = comparable(one, other);
    auto with = comparable(other, one);
    if (with.size() < marks.size()) std::swap(marks, with);
    auto shared = shared_marks(marks, with);
    if (shared.size() < min_shared) return {};  // most pairs end here
    const auto [first, last] = std::ranges::minmax_element(marks, {}, &SketchHash::time_s);
    const double span_s = last->time_s - first->time_s;
    shared = at_one_offset(std::move(shared), clock_slack_s + clock_drift * span_s);
    if (shared.size() < min_shared || !agree_in_kind(marks, with, shared)) return {};
    const double block_s = std::max(min_block_s, span_s / max_blocks);
    const auto agreeing = blocks_of(shared, block_s);
    const double part = static_cast<double>(agreeing) / static_cast<double>(blocks_of(marks, block_s));
    return {part >= min_agreeing, static_cast<double>(agreeing) * block_s};
}

bool is_preferred_duplicate(const FlightSketch& one, const FlightSketch& other) {
    return std::pair(one.has_definitions, one.samples) > std::pair(other.has_definitions, other.samples);
}

std::string describe_overlap(const std::string& one, const std::string& other, const SketchMatch& likeness) {
    return fmt::format(
        "{} and {} recorded about {:.0f} s of one flight both, less than half of either: it counts twice "
        "unless one of them is excluded",
        one, other, likeness.shared_s);
}

std::vector<SketchIndex::Hit> SketchIndex::find(const FlightSketch& content) const {
    std::map<std::size_t, std::size_t> sharing;  // marks with each
    for (const auto& mark : content.hashes) {
        const auto [first, last] = with_mark_.equal_range(mark.fingerprint);
        if (static_cast<std::size_t>(std::distance(first, last)) >= max_sharing) continue;
        for (auto known = first; known != last; ++known) ++sharing[known->second];
    }
    std::vector<Hit> alike;
    for (const auto& [known, marks] : sharing) {
        if (marks < min_indexed) continue;
        const auto likeness = compare_sketches(content, contents_[known]);
        if (likeness.shared_s > 0.0) alike.push_back({known, likeness});
    }
    return alike;
}

void SketchIndex::add(FlightSketch content) {
    const std::span<const SketchHash> marks = content.hashes;
    for (const auto& mark : marks.first(std::min(marks.size(), indexed_marks)))
        if (with_mark_.count(mark.fingerprint) < max_sharing) with_mark_.emplace(mark.fingerprint, contents_.size());
    contents_.push_back(std::move(content));
}

bool is_synthetic(const std::string& aircraft_name) { return boost::algorithm::icontains(aircraft_name, "synthetic"); }

std::string describe_aircraft(const std::string& id, const std::string& name) {
    if (id.empty() && name.empty()) return "unknown";
    return fmt::format("{}{}{}{}", id, id.empty() || name.empty() ? "" : " ", name,
                       is_synthetic(name) ? " (SYNTHETIC)" : "");
}

std::string describe_mixed_aircraft(std::span<const FlightAircraft> flights) {
    std::map<std::string, std::vector<std::string>> flown;  // by aircraft
    std::set<std::string> ids;
    std::set<std::string> names;
    for (const auto& [flight, id, name] : flights) {
        flown[describe_aircraft(id, name)].push_back(flight);
        if (!id.empty()) ids.insert(id);
        if (!name.empty()) names.insert(name);
    }
    names.erase(unnamed_synthetic);  // one without its .log goes with any other synthetic one of its id
    const auto synthetic =
        std::ranges::count_if(flights, [](const FlightAircraft& by) { return is_synthetic(by.aircraft_name); });
    const bool any_real = std::ranges::any_of(names, [](const auto& name) { return !is_synthetic(name); });
    if (ids.size() < 2 && names.size() < 2 && (synthetic == 0 || !any_real)) return "";
    std::vector<std::string> lines;
    lines.reserve(flown.size());
    for (const auto& [aircraft, its] : flown) lines.push_back(fmt::format("{}: {}", aircraft, fmt::join(its, ", ")));
    return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace flightwatt::flight
