#include "mission/disturbance.h"

#include "base/toml_reader.h"
#include "mission/file/schedule_toml.h"

#include <array>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// The time that an entry's from, to and at are counted in: a phase, or the mission.
struct TimeFrame {
    std::string name;
    double start_s = 0.0;  ///< since the mission began
    double duration_s = 0.0;
};

TimeFrame frame_of(const TomlTable& entry, const PerPhase<double>& duration_s) {
    const auto timeline = timeline_of(duration_s);
    if (!entry.has("phase")) return {"the mission", 0.0, timeline.duration_s};
    const auto phase = read_flown_phase(entry, duration_s);
    return {std::string(phase_word(phase)), timeline.start_s[phase], duration_s[phase]};
}

/// A time that an entry gives, as mission time.
double read_mission_time_s(const TomlTable& entry, std::string_view key, const TimeFrame& frame) {
    const double time_s = read_time_s(entry, key, frame.duration_s);
    if (time_s >= 0.0 && time_s <= frame.duration_s) return frame.start_s + time_s;
    throw InputError(entry.where(key), fmt::format("{} = {:.6g} s is not within {}", key, time_s, frame.name),
                     fmt::format("it takes {:.6g} s in this mission", frame.duration_s));
}

/// Throws where one of `keys` is given together with `other`.
void refuse_beside(const TomlTable& entry, std::string_view other, std::initializer_list<std::string_view> keys,
                   std::string_view why) {
    for (const auto key : keys) {
        if (!entry.has(key) || !entry.has(other)) continue;
        throw InputError(entry.where(key), fmt::format("`{}` cannot be given with `{}`: {}", key, other, why),
                         "make two entries of it, or remove one");
    }
}

void read_when(const TomlTable& entry, const TimeFrame& frame, Disturbance& disturbance) {
    disturbance.start_s = frame.start_s;
    disturbance.end_s = frame.start_s + frame.duration_s;
    if (entry.has("at")) {
        disturbance.start_s = read_mission_time_s(entry, "at", frame);
        if (disturbance.start_s < disturbance.end_s) return;
        throw InputError(entry.where("at"), fmt::format("{} is over then", frame.name), "choose an earlier time");
    }
    if (entry.has("from")) disturbance.start_s = read_mission_time_s(entry, "from", frame);
    if (entry.has("to")) disturbance.end_s = read_mission_time_s(entry, "to", frame);
    if (disturbance.end_s > disturbance.start_s) return;
    throw InputError(entry.where(entry.has("from") ? "from" : "to"), "the segment is empty",
                     "it must start before it ends");
}

/// A number that a disturbance may have.
struct NumberKey {
    std::string_view key;
    NumberRange range;
    double Disturbance::*number;
};

constexpr double largest_factor = 100.0;
constexpr double largest_w = 1e6;
constexpr std::array number_keys{
    NumberKey{"mechanical_factor", between(0.0, largest_factor), &Disturbance::mechanical_factor},
    NumberKey{"mechanical_w", between(-largest_w, largest_w), &Disturbance::mechanical_w},
    NumberKey{"compute_factor", between(0.0, largest_factor), &Disturbance::compute_factor},
    NumberKey{"compute_w", between(-largest_w, largest_w), &Disturbance::compute_w},
    NumberKey{"soc_drop_percent", between(0.0, 100.0), &Disturbance::soc_drop_percent},
    NumberKey{"capacity_factor", between(0.01, largest_factor), &Disturbance::capacity_factor},
    NumberKey{"resistance_factor", between(0.0, largest_factor), &Disturbance::resistance_factor},
};

Disturbance read_disturbance(const TomlTable& entry, const PerPhase<double>& duration_s) {
    entry.refuse_keys_except({"phase", "from", "to", "at", "mechanical_factor", "mechanical_w", "compute_factor",
                              "compute_w", "soc_drop_percent", "capacity_factor", "resistance_factor"});
    if (entry.has("soc_drop_percent") && !entry.has("at")) {
        throw InputError(entry.where("soc_drop_percent"), "a drop happens at one moment, and none is given",
                         "add at = SECONDS");
    }
    if (entry.has("at") && !entry.has("soc_drop_percent")) {
        throw InputError(entry.where("at"), "`at` is when charge drops, and no soc_drop_percent is given",
                         "for a segment use from and to");
    }
    refuse_beside(entry, "at", {"from", "to", "mechanical_factor", "mechanical_w", "compute_factor", "compute_w"},
                  "one is a moment, the other lasts");
    for (const std::string_view pack : {"capacity_factor", "resistance_factor"})
        refuse_beside(entry, pack, {"phase", "from", "to", "at"}, "a pack is weaker from the start on");
    Disturbance disturbance;
    read_when(entry, frame_of(entry, duration_s), disturbance);
    for (const auto& [key, range, number] : number_keys)
        disturbance.*number = number_in_or(range, entry, key, disturbance.*number);
    return disturbance;
}

void refuse_nothing(const TomlTable& entry) {
    for (const auto& key : entry.keys())
        if (key != "phase" && key != "from" && key != "to") return;
    throw InputError(entry.where(), "this entry changes nothing",
                     "give it mechanical_factor, mechanical_w, compute_factor, compute_w, capacity_factor, "
                     "resistance_factor or soc_drop_percent");
}

}  // namespace

battery::Battery apply_disturbances(battery::Battery battery, const Disturbances& disturbances) {
    for (const auto& disturbance : disturbances) {
        battery.capacity_ah *= disturbance.capacity_factor;
        battery.resistance_ohm *= disturbance.resistance_factor;
        if (battery.thevenin) battery.thevenin->rc_resistance_ohm *= disturbance.resistance_factor;
    }
    return battery;
}

Disturbances rescale_to_flown_durations(Disturbances disturbances, const PerPhase<double>& planned_s,
                                        const PerPhase<double>& flown_s) {
    for (auto& disturbance : disturbances) {
        disturbance.start_s = rescale_to_flown_durations_s(disturbance.start_s, planned_s, flown_s);
        disturbance.end_s = rescale_to_flown_durations_s(disturbance.end_s, planned_s, flown_s);
    }
    return disturbances;
}

Disturbances read_disturbances(const std::filesystem::path& path, const PerPhase<double>& duration_s) {
    const auto root = read_toml(path, FileKind::disturbances);
    root.refuse_keys_except({"format", "disturbance"});
    require_known_format(root);
    Disturbances disturbances;
    for (const auto& entry : root.tables("disturbance")) {
        refuse_nothing(entry);
        disturbances.push_back(read_disturbance(entry, duration_s));
    }
    if (disturbances.empty())
        throw InputError(root.where(), "there are no disturbances", "add [[disturbance]] entries");
    return disturbances;
}

}  // namespace flightwatt::mission
