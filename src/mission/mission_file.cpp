#include "mission/mission_file.h"

#include "base/atomic_file.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "battery/battery_toml.h"
#include "compute/profile_reader.h"
#include "mechanical/speed_to_fly.h"
#include "mission/file/airspeed_toml.h"
#include "mission/file/cruise_toml.h"
#include "mission/file/named_file.h"
#include "mission/file/payload_toml.h"
#include "mission/file/planning_toml.h"
#include "mission/file/schedule_toml.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

constexpr double shortest_phase_s = 1e-3;
constexpr double min_capacity_ah_of_a_pack = 1e-3;  // below, it is a mistake in the unit
constexpr double largest_sd_percent = 1000.0;
constexpr double max_phase_s = 1e7;  // a third of a year: beyond, it is a mistake in the unit

/// Whether the cruise power follows from its airspeed, where the model has a physical part.
bool states_airspeed(const TomlTable& root) { return root.has("airspeed_m_per_s") || root.has("path"); }

/// The model; at a stated airspeed also with drag that whole flights are predicted no better with.
void read_mechanical(const TomlTable& root, MissionSetup& mission) {
    if (root.string("mechanical") == "none") return;
    auto& model = mission.mechanical.emplace(mechanical::read_predicting_model(named_file(root, "mechanical")));
    if (!model.physical || knows_cost_of_airspeed(*model.physical) || !states_airspeed(root)) return;
    model.physical = mechanical::with_cost_of_airspeed(*std::move(model.physical));
    if (knows_cost_of_airspeed(*model.physical))
        mission.notes.emplace_back(
            "its cruise power at an airspeed is by the drag that the flights show within them; the error on flights left "
            "out is of the model without it, which predicts whole flights no worse");
}

/// The held-out score of the model that predicts the power (with an airspeed or a path, that of the cruise), if its
/// file has one.
void find_power_model(const TomlTable& root, MissionSetup& mission) {
    if (!mission.mechanical) return;
    const auto& physical = mission.mechanical->physical;
    const bool knows_airspeed = physical && states_airspeed(root);
    if (knows_airspeed && !knows_cost_of_airspeed(*physical))
        mission.notes.emplace_back(
            "its cruise power is assumed not to grow with the airspeed: the model's flights do not show what that costs; "
            "flights at other airspeeds, steady for minutes, would");
    if (!mission.mechanical->validation) return;
    const auto& validation = *mission.mechanical->validation;
    const auto model = knows_airspeed ? "physical" : default_model(*mission.mechanical);
    const auto score = std::ranges::find(validation.scores, model, &mechanical::HeldOutScore::model);
    if (score != validation.scores.end())
        mission.power_model = *score;
    else if (knows_airspeed)
        mission.notes.emplace_back(
            "its cruise power by airspeed is unproven: the model file has no error of it on flights left out");
}

mechanical::PhaseTimeScaling read_clock(const TomlTable& root, bool has_mechanical) {
    const auto name = root.optional_string("phase_clock");
    if (!name) return mechanical::PhaseTimeScaling::scaled;
    if (!has_mechanical) {
        throw InputError(root.where("phase_clock"), "phase_clock has no meaning with mechanical = \"none\"",
                         "leave it out");
    }
    if (*name == "stretch") return mechanical::PhaseTimeScaling::scaled;
    if (*name == "absolute") return mechanical::PhaseTimeScaling::absolute;
    throw InputError(root.where("phase_clock"), fmt::format("there is no phase_clock '{}'", *name),
                     "it is \"stretch\" or \"absolute\"");
}

double read_duration(const TomlTable& durations, std::string_view phase) {
    const double value = durations.number(phase);
    if (value == 0.0) return value;
    return number_in(between(shortest_phase_s, max_phase_s), durations, phase, "or 0: not flown");
}

/// A cruise whose number is nearer to that of the model's flights in minutes than in seconds.
void note_minutes(MissionSetup& mission) {
    const double cruise_s = mission.duration_s[Phase::cruise];
    const double flown_s = mission.mechanical ? mission.mechanical->phases[Phase::cruise].duration_s : 0.0;
    if (cruise_s <= 0.0 || cruise_s * std::sqrt(units::seconds_per_minute) >= flown_s) return;
    mission.notes.push_back(
        fmt::format("cruise = {0} is {0} s, and the model's flights cruised for {1:.0f} s: are {0} "
                    "minutes meant, cruise = {2}?",
                    cruise_s, flown_s, cruise_s * units::seconds_per_minute));
}

void read_durations(const TomlTable& root, MissionSetup& mission) {
    const auto& mechanical = mission.mechanical;
    if (mechanical) {
        for (const auto phase : all_phases) mission.duration_s[phase] = mechanical->phases[phase].duration_s;
    } else if (!root.has("duration_s")) {
        throw InputError(root.where("mechanical"), "without a mechanical model the phases have no durations",
                         "add duration_s = { takeoff = ..., cruise = ..., landing = ... }");
    }
    double total_s = 0.0;
    const auto given = root.optional_table("duration_s", "{ cruise = 600 }");
    for (const auto phase : all_phases) {
        const auto name = to_string(phase);
        if (given && (!mechanical || given->has(name))) {
            mission.duration_s[phase] = read_duration(*given, name);
            mission.duration_is_stated[phase] = true;
        }
        total_s += mission.duration_s[phase];
    }
    if (given) given->refuse_unknown_keys();
    if (!root.has("path")) note_minutes(mission);
    if (total_s == 0.0) throw InputError(root.where("duration_s"), "all phases take 0 s, expected a mission");
}

void read_mission_battery(const TomlTable& root, MissionSetup& mission) {
    auto& battery = mission.battery;
    battery = root.is_table("battery") ? battery::battery_from(root.table("battery"))
                                       : battery::read_battery(named_file(root, "battery"));
    const auto capacity_ah = optional_number_in(between(min_capacity_ah_of_a_pack, battery::max_capacity_ah), root,
                                                "capacity_ah", battery::capacity_hint);
    mission.capacity_is_stated = capacity_ah.has_value();
    if (!capacity_ah && battery.capacity_ah < min_capacity_ah_of_a_pack)
        throw InputError(root.where("battery"), fmt::format("the battery holds {:.3g} Ah", battery.capacity_ah),
                         fmt::format("expected {} Ah or more", min_capacity_ah_of_a_pack));
    if (!capacity_ah) return;
    battery.capacity_ah = *capacity_ah;
    battery.intervals.capacity_ah.reset();  // that was of the other capacity
}

/// A pack whose voltage when full is not that of the model's flights, whose packs were about full at the start.
void note_other_cells(MissionSetup& mission) {
    constexpr double least_part = 0.85;  // a nominal voltage, or a pack of one cell less
    constexpr double most_times = 1.2;   // flights that begin with 3.5 V a cell
    if (!mission.mechanical || !mission.mechanical->pack_voltage_v) return;
    const double flown_v = *mission.mechanical->pack_voltage_v;
    const double full_v = open_circuit_voltage_v(mission.battery, units::percent_per_whole);
    if (full_v >= least_part * flown_v && full_v <= most_times * flown_v) return;
    mission.uncertain.push_back(
        fmt::format("the pack has {:.1f} V when full, and the model's flights were flown with up to "
                    "{:.1f} V: has it another number of cells?",
                    full_v, flown_v));
}

compute::Component read_component(const TomlTable& table, const std::string& name) {
    table.refuse_keys_except({"profile", "parameters", "columns", "utility"});
    compute::ProfileNaming naming;
    naming.where = table.where();
    for (const std::string_view key : {"parameters", "columns"}) {
        if (!table.has(key)) continue;
        (key == "columns" ? naming.columns : naming.parameters) = table.strings(key);
        naming.where = table.where(key);
        if (naming.parameters.empty() && naming.columns.empty())
            throw InputError(naming.where, fmt::format("{} = [] names nothing", key), "leave it out");
    }
    return {name, read_power_profile(named_file(table, "profile"), naming)};
}

constexpr double least_of_idle = 0.5;  // idle power differs less between days

/// The component with the most power that its profile leaves out; nullptr if none does.
const compute::Component* above_idle(const compute::ComputeModel& compute) {
    const auto excluded_w = [](const compute::Component& component) { return component.profile.excluded_idle_w; };
    const auto above = std::ranges::max_element(compute.components, {}, excluded_w);
    return above == compute.components.end() || excluded_w(*above) <= 0.0 ? nullptr : &*above;
}

/// Adds a note where a profile is above the idle computer and no other component draws what that does.
void note_missing_idle(MissionSetup& mission) {
    const auto* above = above_idle(mission.compute);
    if (above == nullptr) return;
    double others_w = 0.0;
    for (const auto& component : mission.compute.components)
        if (component.profile.excluded_idle_w <= 0.0) others_w += std::ranges::min(component.profile.power_w);
    if (others_w >= least_of_idle * above->profile.excluded_idle_w) return;
    mission.notes.push_back(
        fmt::format("the profile of {} is above the idle computer, whose {:.3g} W no component draws: add the idle.csv "
                    "of its folder as a component, and run it",
                    above->name, above->profile.excluded_idle_w));
}

/// Adds a note where such a component runs while no other draws the power of the idle computer.
void note_idle_not_run(const Schedule& schedule, MissionSetup& mission) {
    const auto* above = above_idle(mission.compute);
    if (above == nullptr) return;
    double without_s = 0.0;
    for (const auto& segment : schedule) {
        double excluded_w = 0.0;
        double others_w = 0.0;
        for (const auto& [index, qos] : segment.run) {
            const auto& component = mission.compute.components[index];
            excluded_w = std::max(excluded_w, component.profile.excluded_idle_w);
            if (component.profile.excluded_idle_w <= 0.0) others_w += power_w(component.profile, qos);
        }
        if (others_w < least_of_idle * excluded_w) without_s += segment.duration_s();
    }
    if (without_s <= 0.0) return;
    mission.notes.push_back(
        fmt::format("the profile of {} is above the idle computer, and for {:.0f} s of the schedule nothing draws the "
                    "{:.3g} W of that: add the idle.csv of its folder as a component, and run it",
                    above->name, without_s, above->profile.excluded_idle_w));
}

/// The idle computer in the powers of those of `components` that include it.
struct IncludedIdle {
    std::vector<std::string> names;
    double largest_w = 0.0;

    void add(const compute::Component& component) {
        if (component.profile.included_idle_w <= 0.0) return;
        names.push_back(component.name);
        largest_w = std::max(largest_w, component.profile.included_idle_w);
    }
};

std::string idle_counted_twice(const IncludedIdle& idle, const std::string& when) {
    return fmt::format(
        "the profiles of {} include the idle computer: {} its {:.3g} W count {}, and the mission lands "
        "with less charge than it would; profile with above_idle = true, and add idle.csv as a component",
        fmt::join(idle.names, " and "), when, idle.largest_w,
        idle.names.size() == 2 ? "twice" : fmt::format("{} times", idle.names.size()));
}

/// Adds a note where several profiles that may run at the same time include the idle computer.
void note_idle_twice(MissionSetup& mission) {
    IncludedIdle idle;
    for (const auto& component : mission.compute.components) idle.add(component);
    if (idle.names.size() > 1) mission.notes.push_back(idle_counted_twice(idle, "where they run at the same time,"));
}

/// The same where the schedule runs them at the same time.
void note_idle_run_twice(const Schedule& schedule, MissionSetup& mission) {
    IncludedIdle most;
    double several_s = 0.0;
    for (const auto& segment : schedule) {
        IncludedIdle idle;
        for (const auto& [index, qos] : segment.run) idle.add(mission.compute.components[index]);
        if (idle.names.size() < 2) continue;
        several_s += segment.duration_s();
        if (idle.names.size() > most.names.size()) most = std::move(idle);
    }
    if (several_s > 0.0)
        mission.notes.push_back(idle_counted_twice(most, fmt::format("for {:.0f} s of the schedule", several_s)));
}

void read_components(const TomlTable& root, MissionSetup& mission) {
    const auto components = root.optional_table("components");
    if (!components) return;
    for (const auto& name : components->keys()) {
        const auto table = components->table(name);
        auto& component = mission.compute.components.emplace_back(read_component(table, name));
        if (!mission.may_charge)
            if (auto text = remove_negative_power(component.profile); !text.empty())
                mission.notes.push_back(std::move(text));
        std::optional<Utility> utility;
        if (const auto stated = table.optional_table("utility")) utility = read_utility(*stated, component.profile);
        mission.utilities.push_back(std::move(utility));
    }
}

std::optional<double> optional_sd_percent(const TomlTable& table, std::string_view key) {
    return optional_number_in(between(0.0, largest_sd_percent), table, key);
}

PerPhase<std::optional<double>> read_phases(const TomlTable& uncertainty, std::string_view key, double largest) {
    PerPhase<std::optional<double>> phases;
    const auto table = uncertainty.optional_table(key);
    if (!table) return phases;
    for (const auto phase : all_phases)
        phases[phase] = optional_number_in(between(0.0, largest), *table, to_string(phase));
    table->refuse_unknown_keys();
    return phases;
}

Uncertainty read_uncertainty(const TomlTable& mission, const compute::ComputeModel& compute, bool has_mechanical) {
    Uncertainty read;
    read.compute_sd_percent.resize(compute.components.size());
    const auto table = mission.optional_table("uncertainty");
    if (!table) return read;
    table->refuse_keys_except(
        {"level_sd_percent", "duration_sd_s", "compute_sd_percent", "capacity_sd_percent", "initial_soc_sd_percent"});
    if (table->has("level_sd_percent") && !has_mechanical) {
        throw InputError(table->where("level_sd_percent"), "level_sd_percent has no meaning with mechanical = \"none\"",
                         "leave it out");
    }
    read.level_sd_percent = read_phases(*table, "level_sd_percent", largest_sd_percent);
    read.duration_sd_s = read_phases(*table, "duration_sd_s", max_phase_s);
    read.capacity_sd_percent = optional_sd_percent(*table, "capacity_sd_percent");
    read.initial_soc_sd_percent = number_in_or(between(0.0, 100.0), *table, "initial_soc_sd_percent", 0.0);
    if (const auto components = table->optional_table("compute_sd_percent")) {
        for (std::size_t i = 0; i < compute.components.size(); ++i)
            read.compute_sd_percent[i] = optional_sd_percent(*components, compute.components[i].name);
        components->refuse_unknown_keys();
    }
    return read;
}

/// Throws where a mission that is yet to be planned is not accepted.
void require_schedule(const TomlTable& root, bool lacks_schedule) {
    if (lacks_schedule && !root.has("plan")) {
        throw InputError(root.where("components"), "there are components and no [[schedule]] that runs them",
                         "add [[schedule]] with otherwise = true and run = { ... }, or make a schedule with "
                         "`flightwatt plan`");
    }
    if (!root.has("plan")) return;
    throw InputError(root.where("plan"), "this mission has no complete schedule: it is yet to be planned",
                     "`flightwatt plan` makes one; without [plan], [[schedule]] is taken as complete");
}

MissionVariant scheduled_mission(const TomlTable& root, const MissionReadOptions& reading, MissionSetup mission);

/// Reads the cruise; of lines that are to be chosen, those of the first heading and airspeed that can be flown.
void read_flyable_cruise(const TomlTable& root, const MissionReadOptions& reading, MissionSetup& mission) {
    const auto before = mission;
    try {
        return read_cruise_path(root, reading, mission);
    } catch (const InputError&) {
        const auto choices = reading.survey ? std::nullopt : read_survey_choices(root);
        if (!choices) throw;
        auto chosen = reading;
        for (const double heading_deg : choices->headings_deg) {
            for (const auto& level : choices->levels) {
                if (level.spacing_m != choices->levels.front().spacing_m) continue;
                chosen.survey = {heading_deg, {level}};
                mission = before;
                try {
                    return read_cruise_path(root, chosen, mission);
                } catch (const InputError&) {
                    continue;
                }
            }
        }
        throw;
    }
}

/// A mission without what was noted as its path was read: other lines have notes of their own.
MissionSetup without_notes_of_path(const TomlTable& root, const MissionReadOptions& reading, MissionSetup setup) {
    auto read = setup;
    read.notes.clear();
    read.uncertain.clear();
    read_flyable_cruise(root, reading, read);
    const auto erase = [](std::vector<std::string>& texts, const std::vector<std::string>& of_path) {
        std::erase_if(texts, [&](const auto& text) { return std::ranges::find(of_path, text) != of_path.end(); });
    };
    erase(setup.notes, read.notes);
    erase(setup.uncertain, read.uncertain);
    return setup;
}

/// The choices of lines over the area of a mission; none if they are fixed or `reading` chooses.
std::shared_ptr<const SurveyChoices> read_survey(const TomlTable& root, const MissionReadOptions& reading,
                                                 const MissionSetup& setup) {
    if (reading.survey) return nullptr;
    auto choices = read_survey_choices(root);
    if (!choices) return nullptr;
    auto mutex = std::make_shared<std::mutex>();  // tables note which of their keys were read
    choices->mission_with = [root, reading, mutex,
                             bare = without_notes_of_path(root, reading, setup)](const path::SurveyLayout& layout) {
        auto chosen = reading;
        chosen.survey = layout;
        auto changed = bare;
        const std::lock_guard lock(*mutex);
        read_cruise_path(root, chosen, changed);
        return std::get<PlanningProblem>(scheduled_mission(root, chosen, std::move(changed)));
    };
    return std::make_shared<const SurveyChoices>(std::move(*choices));
}

/// The mission with its schedule, or the planning problem with the fixed part of it. A complete schedule, such as the
/// result of flightwatt plan, is scaled in time to a cruise of another duration than `stated_s`.
MissionVariant with_read_schedule(const TomlTable& root, const MissionReadOptions& reading,
                                  const PerPhase<double>& stated_s, MissionSetup setup) {
    auto adaptive = read_adaptive_policy(root);
    const auto has_otherwise = [](const TomlTable& entry) { return entry.has("otherwise"); };
    const bool is_stretched = reading.cruise_s && stated_s[Phase::cruise] > 0.0 && !adaptive && !root.has("plan") &&
                              std::ranges::none_of(root.tables("schedule"), has_otherwise);
    const auto& entries_s = is_stretched ? stated_s : setup.duration_s;
    auto entries = read_schedule(root, setup.compute, entries_s);
    const bool lacks_schedule = entries.empty() && !setup.compute.components.empty();
    auto survey = read_survey(root, reading, setup);
    const bool chooses_lines = survey || reading.survey;
    if (!reading.allow_unplanned && !adaptive && !setup.packs && !reading.survey) {
        require_schedule(root, lacks_schedule);
        if (survey)
            throw InputError(root.where("path"), "its lines are yet to be chosen", "`flightwatt plan` chooses them");
    }
    if (lacks_schedule || root.has("plan") || adaptive || chooses_lines) {
        note_missing_idle(setup);
        note_idle_twice(setup);
        PlanningProblem problem{std::move(setup), {}, {}, adaptive, std::move(survey)};
        problem.plan = read_plan_settings(root, problem.setup.compute);
        problem.fixed = resolve_fixed_segments(entries, problem.setup.duration_s);
        if (problem.adaptive && problem.adaptive->decide_every_s == 0.0)
            problem.adaptive->decide_every_s = problem.plan.slot_s;
        return problem;
    }
    if (entries.empty()) {
        ScheduleEntry nothing;  // mechanical only: nothing runs, all the time
        nothing.otherwise = true;
        nothing.where = root.where();
        entries.push_back(nothing);
    }
    auto schedule = resolve_schedule(entries, entries_s);
    if (is_stretched) schedule = rescale_to_flown_durations(std::move(schedule), stated_s, setup.duration_s);
    note_idle_not_run(schedule, setup);
    note_idle_run_twice(schedule, setup);
    return Mission{std::move(setup), std::move(schedule)};
}

/// The mission without its schedule and with the durations that it states.
MissionSetup setup_from(const TomlTable& root, const std::filesystem::path& path, const MissionReadOptions& reading) {
    if (root.is_table("conditions"))
        throw InputError(root.where("conditions"), "conditions are no longer read: a cruise follows its airspeed alone",
                         "leave them out, or state airspeed_m_per_s at the top of the mission, with a model of "
                         "flightwatt fit --model-kind physical");
    root.refuse_keys_except(
        {"format",   "name",       "mechanical",      "duration_s",          "phase_clock", "airspeed_m_per_s",
         "path",     "wind",       "battery",         "initial_soc_percent", "capacity_ah", "cutoff_voltage_v",
         "packs",    "payload_kg", "takeoff_mass_kg", "reserve_soc_percent", "may_charge",  "components",
         "schedule", "plan",       "policy",          "uncertainty"});
    require_known_format(root);
    MissionSetup mission;
    mission.file = path.string();
    mission.name = root.optional_string("name").value_or(path.stem().string());
    read_mechanical(root, mission);
    mission.phase_clock = read_clock(root, mission.mechanical.has_value());
    mission.packs = read_packs(root);
    apply_payload(root, mission);
    if (!root.has("path")) apply_airspeed(root, mission);
    read_durations(root, mission);
    read_flyable_cruise(root, reading, mission);
    if (mission.packs && mission.survey && mission.survey->has_zones)
        mission.notes.emplace_back(
            "packs: the ways home and back to the lines are straight, also over zones that are not to be flown over: check "
            "them, also in the files of plan --packs");
    find_power_model(root, mission);
    read_mission_battery(root, mission);
    note_other_cells(mission);
    mission.may_charge = root.optional_boolean("may_charge").value_or(false);
    read_components(root, mission);
    mission.initial_soc_percent = optional_number_in(between(1.0, 100.0), root, "initial_soc_percent",
                                                     "a full pack is 100; a charge of 0.98 is 98 %")
                                      .value_or(100.0);
    mission.cutoff_voltage_v = number_in_or(between(0.0, 1e6), root, "cutoff_voltage_v", 0.0);
    mission.reserve_soc_percent = number_in_or(between(0.0, 100.0), root, "reserve_soc_percent", 0.0);
    if (const double percent = mission.reserve_soc_percent; percent > 0.0 && percent < 1.0)
        mission.notes.push_back(fmt::format("reserve_soc_percent = {} is {} % of the charge; are {:.3g} % meant?",
                                            percent, percent, units::percentage(percent, 1.0)));
    mission.uncertainty = read_uncertainty(root, mission.compute, mission.mechanical.has_value());
    return mission;
}

MissionVariant scheduled_mission(const TomlTable& root, const MissionReadOptions& reading, MissionSetup mission) {
    const auto stated_s = mission.duration_s;
    if (reading.cruise_s) {
        mission.duration_s[Phase::cruise] = *reading.cruise_s;
        mission.duration_is_stated[Phase::cruise] = true;
    }
    return with_read_schedule(root, reading, stated_s, std::move(mission));
}

}  // namespace

MissionVariant parse_mission(std::string_view text, const std::filesystem::path& path,
                             const MissionReadOptions& reading) {
    return mission_loader(std::string(text), path)(reading);
}

MissionLoader mission_loader(std::string text, std::filesystem::path path) {
    struct Read {
        TomlTable root;
        MissionSetup setup;
    };
    auto of_cruise = std::make_shared<std::optional<Read>>();
    return [text = std::move(text), path = std::move(path), of_cruise](const MissionReadOptions& reading) {
        const bool is_of_cruise =
            reading.cruise_s && !reading.circles && !reading.return_after_m && !reading.path_times;
        if (is_of_cruise && *of_cruise) return scheduled_mission((*of_cruise)->root, reading, (*of_cruise)->setup);
        const auto root = parse_toml(text, path.string(), FileKind::mission);
        std::optional<MissionVariant> mission;
        root.collect_unknown_keys([&] {
            auto setup = setup_from(root, path, reading);
            mission = scheduled_mission(root, reading, setup);
            if (is_of_cruise) of_cruise->emplace(Read{root, std::move(setup)});
        });
        return std::move(*mission);
    };
}

MissionVariant read_mission(const std::filesystem::path& path, const MissionReadOptions& reading) {
    return parse_mission(read_file(path), path, reading);
}

}  // namespace flightwatt::mission
