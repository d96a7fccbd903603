#include "flight/flight_identity.h"

#include "flight/flight_phases.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
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
constexpr std::array<std::size_t, precisions> max_marks{256, 256, 256, 512};
constexpr std::size_t max_candidate_marks = 8192;
constexpr std::array<std::size_t, precisions> indexed_marks{64, 64, 64, 128};
constexpr std::size_t max_sharing = 64;  // what more flights have in common tells of none
constexpr std::size_t min_indexed = 3;
// Of two recordings of one flight.
constexpr std::size_t min_shared = 6;
constexpr double min_shared_part = 0.05;
constexpr std::size_t min_told = 10;
constexpr double min_block_s = 30.0;
constexpr double max_blocks = 24.0;
constexpr double min_agreeing = 0.5;
constexpr std::size_t min_rounded_blocks = 5;
constexpr double clock_slack_s = 1.0;
constexpr double clock_drift = 2e-3;

constexpr std::size_t exact = precisions - 1;

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) + 0x9E3779B97F4A7C15U;  // splitmix64
    state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9U;
    state = (state ^ (state >> 27)) * 0x94D049BB133111EBU;
    return state ^ (state >> 31);
}

/// The value as one of so many decimals says it, or exactly.
std::uint64_t rounded(double value, std::size_t precision) {
    constexpr double most = 1e12;
    if (precision == exact || std::abs(value) > most) return std::bit_cast<std::uint64_t>(value + 0.0);
    const double scale = std::pow(10.0, static_cast<double>(precision));
    return static_cast<std::uint64_t>(std::llround(value * scale));
}

/// How many decimals the values have; two if more.
std::size_t decimals_of(const Track& track) {
    constexpr double nearly_all = 0.98;
    constexpr double nearly_whole = 1e-6;
    for (std::size_t decimals = 0; decimals < max_decimals; ++decimals) {
        const double scale = std::pow(10.0, static_cast<double>(decimals));
        const auto whole = std::ranges::count_if(track.value, [&](double value) {
            return std::abs(value * scale - std::round(value * scale)) < nearly_whole;
        });
        if (static_cast<double>(whole) >= nearly_all * static_cast<double>(track.value.size())) return decimals;
    }
    return max_decimals;
}

void add_marks(const Track& track, std::size_t precision, std::uint64_t highest, std::vector<SketchHash>& marks) {
    auto seed = mixed(0, precision);
    for (const char c : track.name + ' ' + track.source) seed = mixed(seed, static_cast<unsigned char>(c));
    const bool is_altitude = track.name == "altitude_m";
    std::vector<std::uint64_t> values(track.value.size());
    std::ranges::transform(track.value, values.begin(), [&](double value) { return rounded(value, precision); });
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto last = std::min(values.size(), i + 1 + farthest_sample);
        for (auto j = i + 1; j < last && track.time_s[j] - track.time_s[i] <= farthest_s; ++j) {
            if (values[j] == values[i]) continue;
            const auto interval = std::llround((track.time_s[j] - track.time_s[i]) / interval_step_s);
            const auto mark = mixed(mixed(mixed(seed, values[i]), values[j]), static_cast<std::uint64_t>(interval));
            if (mark > highest) continue;
            marks.push_back({is_altitude ? mark | 1U : mark & ~std::uint64_t{1}, to_millisecond(track.time_s[i])});
        }
    }
}

/// The least ones, rising, without those that recur.
void keep_least(std::vector<SketchHash>& marks, std::size_t most) {
    // Most are beyond. Where too many of those below recur, all are looked at.
    constexpr std::size_t spare = 2;
    if (marks.size() > 2 * spare * most) {
        auto least = marks;
        const auto nth = least.begin() + static_cast<std::ptrdiff_t>(spare * most);
        std::ranges::nth_element(least, nth, {}, &SketchHash::fingerprint);
        const auto highest = nth->fingerprint;
        std::erase_if(least, [&](const SketchHash& mark) { return mark.fingerprint >= highest; });
        keep_least(least, most);
        if (least.size() == most) {
            marks = std::move(least);
            return;
        }
    }
    std::ranges::sort(marks, {}, [](const SketchHash& mark) { return std::pair(mark.fingerprint, mark.time_s); });
    std::size_t kept = 0;
    for (std::size_t begin = 0, end = 0; begin < marks.size() && kept < most; begin = end) {
        while (end < marks.size() && marks[end].fingerprint == marks[begin].fingerprint) ++end;
        if (end == begin + 1) marks[kept++] = marks[begin];
    }
    marks.resize(kept);
}

std::uint64_t max_fingerprint(std::size_t parts) { return std::numeric_limits<std::uint64_t>::max() / parts; }

/// The marks that can be in the other too: beyond what was looked at, and the last of a full sketch, nothing is known.
std::span<const SketchHash> comparable(const FlightSketch& one, const FlightSketch& other, std::size_t precision) {
    const auto& marks = one.hashes[precision];
    const auto& others = other.hashes[precision];
    auto highest = max_fingerprint(other.hash_divisor);
    if (others.size() >= max_marks[precision]) highest = std::min(highest, others.back().fingerprint);
    return {marks.begin(), std::ranges::upper_bound(marks, highest, {}, &SketchHash::fingerprint)};
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

SketchMatch compare_at(const FlightSketch& one, const FlightSketch& other, std::size_t precision) {
    auto marks = comparable(one, other, precision);
    auto with = comparable(other, one, precision);
    if (with.size() < marks.size()) std::swap(marks, with);
    auto shared = shared_marks(marks, with);
    if (shared.size() < min_shared) return {};  // most pairs end here
    const auto [first, last] = std::ranges::minmax_element(marks, {}, &SketchHash::time_s);
    const double span_s = last->time_s - first->time_s;
    shared = at_one_offset(std::move(shared), clock_slack_s + clock_drift * span_s);
    if (shared.size() < min_shared || !agree_in_kind(marks, with, shared)) return {};
    const double block_s = std::max(min_block_s, span_s / max_blocks);
    const auto agreeing = blocks_of(shared, block_s);
    if (precision != exact && agreeing < min_rounded_blocks) return {};
    const double part = static_cast<double>(agreeing) / static_cast<double>(blocks_of(marks, block_s));
    return {part >= min_agreeing, static_cast<double>(agreeing) * block_s};
}

}  // namespace

FlightSketch make_sketch(const FlightSeries& series) {
    constexpr std::array<std::string_view, 4> names{"altitude_m", "voltage_v", "current_a", "power_w"};
    FlightSketch content;
    content.has_definitions = !series.log_is_missing;
    content.samples = power_track(series).time_s.size();
    if (content.samples == 0) content.samples = select_track(series, "altitude_m").time_s.size();
    std::vector<const Track*> tracks;
    std::size_t values = 0;
    for (const auto& track : series.tracks) {
        if (std::ranges::find(names, track.name) == names.end() || is_constant(track)) continue;
        tracks.push_back(&track);
        values += track.value.size();
        if (track.name == "altitude_m" || track.name == "power_w")
            content.decimals = std::min(content.decimals, decimals_of(track));
    }
    content.hash_divisor = farthest_sample * values / max_candidate_marks + 1;
    for (std::size_t precision = 0; precision < precisions; ++precision) {
        auto& marks = content.hashes[precision];
        for (const auto* track : tracks) add_marks(*track, precision, max_fingerprint(content.hash_divisor), marks);
        keep_least(marks, max_marks[precision]);
    }
    return content;
}

SketchMatch compare_sketches(const FlightSketch& one, const FlightSketch& other) {
    SketchMatch best;
    for (auto precision = precisions; precision-- > std::min(one.decimals, other.decimals);) {
        const auto likeness = compare_at(one, other, precision);
        if (likeness.is_same) return likeness;
        best.shared_s = std::max(best.shared_s, precision == exact ? likeness.shared_s : 0.0);
    }
    return best;
}

bool is_preferred_duplicate(const FlightSketch& one, const FlightSketch& other) {
    return std::tuple(one.has_definitions, one.samples, one.decimals) >
           std::tuple(other.has_definitions, other.samples, other.decimals);
}

std::string describe_overlap(const std::string& one, const std::string& other, const SketchMatch& likeness) {
    return fmt::format(
        "{} and {} recorded about {:.0f} s of one flight both, less than half of either: it counts twice "
        "unless one of them is excluded",
        one, other, likeness.shared_s);
}

std::vector<SketchIndex::Hit> SketchIndex::find(const FlightSketch& content) const {
    std::map<std::size_t, std::size_t> sharing;  // marks with each
    for (std::size_t precision = 0; precision < precisions; ++precision) {
        for (const auto& mark : content.hashes[precision]) {
            const auto [first, last] = with_mark_.equal_range(mark.fingerprint);
            if (static_cast<std::size_t>(std::distance(first, last)) >= max_sharing) continue;
            for (auto known = first; known != last; ++known) {
                const auto& other = contents_[known->second];
                if (precision >= std::min(content.decimals, other.decimals)) ++sharing[known->second];
            }
        }
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
    for (std::size_t precision = 0; precision < precisions; ++precision) {
        const auto& marks = content.hashes[precision];
        for (const auto& mark : std::span(marks).first(std::min(marks.size(), indexed_marks[precision])))
            if (with_mark_.count(mark.fingerprint) < max_sharing)
                with_mark_.emplace(mark.fingerprint, contents_.size());
    }
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
