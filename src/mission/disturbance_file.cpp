#include "mission/disturbance_file.h"

#include "base/toml_reader.h"
#include "mission/file/schedule_toml.h"

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// The time that an entry's from, to and at are counted in: a phase, or the mission.
struct Span {
    std::string name;
    double begin_s = 0.0;
    double duration_s = 0.0;
};

Span span_of(const TomlTable& entry, const flight::PerPhase<double>& duration_s) {
    Span span{"the mission", 0.0, 0.0};
    const auto name = entry.optional_string("phase");
    for (const auto phase : flight::all_phases) {
        if (name && to_string(phase) == *name) {
            if (duration_s[phase] > 0.0) return {*name, span.duration_s, duration_s[phase]};
            throw InputError(entry.where("phase"), fmt::format("{} takes no time in this mission", *name));
        }
        span.duration_s += duration_s[phase];
    }
    if (!name) return span;
    throw InputError(entry.where("phase"), fmt::format("there is no phase '{}'", *name),
                     "the phases are takeoff, cruise and landing");
}

/// A time that an entry gives, as mission time.
double read_mission_time_s(const TomlTable& entry, std::string_view key, const Span& span) {
    const double time_s = read_time_s(entry, key, span.duration_s);
    if (time_s >= 0.0 && time_s <= span.duration_s) return span.begin_s + time_s;
    throw InputError(entry.where(key), fmt::format("{} = {} s is not within {}", key, time_s, span.name),
                     fmt::format("it takes {} s in this mission", span.duration_s));
}

/// A number from `low` to `high`, if the key is there.
void read_between(const TomlTable& entry, std::string_view key, double low, double high, double& value) {
    const auto given = entry.optional_number(key);
    if (!given) return;
    if (*given < low || *given > high) {
        throw InputError(entry.where(key), fmt::format("{} = {} is out of range", key, *given),
                         fmt::format("expected {} to {}", low, high));
    }
    value = *given;
}

/// Throws where one of `keys` stands with `other`.
void refuse_beside(const TomlTable& entry, std::string_view other,
                   std::initializer_list<std::string_view> keys, std::string_view why) {
    for (const auto key : keys) {
        if (!entry.has(key) || !entry.has(other)) continue;
        throw InputError(entry.where(key), fmt::format("`{}` stands with `{}`: {}", key, other, why),
                         "make two entries of it, or leave one out");
    }
}

void read_when(const TomlTable& entry, const Span& span, Disturbance& disturbance) {
    disturbance.from_s = span.begin_s;
    disturbance.to_s = span.begin_s + span.duration_s;
    if (entry.has("at")) {
        disturbance.from_s = read_mission_time_s(entry, "at", span);
        if (disturbance.from_s < disturbance.to_s) return;
        throw InputError(entry.where("at"), fmt::format("{} is over then", span.name), "let it be earlier");
    }
    if (entry.has("from")) disturbance.from_s = read_mission_time_s(entry, "from", span);
    if (entry.has("to")) disturbance.to_s = read_mission_time_s(entry, "to", span);
    if (disturbance.to_s > disturbance.from_s) return;
    throw InputError(entry.where(entry.has("from") ? "from" : "to"), "the stretch is empty",
                     "it must begin before it ends");
}

Disturbance read_disturbance(const TomlTable& entry, const flight::PerPhase<double>& duration_s) {
    constexpr double largest_factor = 100.0;
    constexpr double largest_w = 1e6;
    constexpr std::string_view of_pack = "a pack is weaker from the beginning on";
    entry.refuse_keys_except({"phase", "from", "to", "at", "mechanical_factor", "mechanical_w",
                              "compute_factor", "compute_w", "soc_drop_percent", "capacity_factor",
                              "resistance_factor"});
    if (entry.has("soc_drop_percent") && !entry.has("at")) {
        throw InputError(entry.where("soc_drop_percent"), "a drop happens at one moment, and none is given",
                         "add at = SECONDS");
    }
    if (entry.has("at") && !entry.has("soc_drop_percent")) {
        throw InputError(entry.where("at"), "`at` is when charge drops, and no soc_drop_percent is given",
                         "for a stretch use from and to");
    }
    refuse_beside(entry, "at",
                  {"from", "to", "mechanical_factor", "mechanical_w", "compute_factor", "compute_w"},
                  "one is a moment, the other lasts");
    for (const std::string_view pack : {"capacity_factor", "resistance_factor"})
        refuse_beside(entry, pack, {"phase", "from", "to", "at"}, of_pack);
    Disturbance disturbance;
    read_when(entry, span_of(entry, duration_s), disturbance);
    read_between(entry, "mechanical_factor", 0.0, largest_factor, disturbance.mechanical_factor);
    read_between(entry, "mechanical_w", -largest_w, largest_w, disturbance.mechanical_w);
    read_between(entry, "compute_factor", 0.0, largest_factor, disturbance.compute_factor);
    read_between(entry, "compute_w", -largest_w, largest_w, disturbance.compute_w);
    read_between(entry, "soc_drop_percent", 0.0, 100.0, disturbance.soc_drop_percent);
    read_between(entry, "capacity_factor", 0.01, largest_factor, disturbance.capacity_factor);
    read_between(entry, "resistance_factor", 0.0, largest_factor, disturbance.resistance_factor);
    return disturbance;
}

void refuse_nothing(const TomlTable& entry) {
    for (const auto& key : entry.keys()) {
        if (key != "phase" && key != "from" && key != "to") return;
    }
    throw InputError(entry.where(), "this entry changes nothing",
                     "give it mechanical_factor, mechanical_w, compute_factor, compute_w, capacity_factor, "
                     "resistance_factor or soc_drop_percent");
}

}  // namespace

std::vector<Disturbance> read_disturbances(const std::filesystem::path& path,
                                           const flight::PerPhase<double>& duration_s) {
    const auto root = read_toml(path);
    root.refuse_keys_except({"disturbance"});
    std::vector<Disturbance> disturbances;
    for (const auto& entry : root.tables("disturbance")) {
        refuse_nothing(entry);
        disturbances.push_back(read_disturbance(entry, duration_s));
    }
    if (disturbances.empty()) {
        throw InputError(root.where(), "there are no disturbances", "add [[disturbance]] entries");
    }
    return disturbances;
}

}  // namespace flightwatt::mission
