#include "base/toml_text.h"
#include "mission/file/toml_keys.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

/// Of round numbers: 27.46 is 27.
std::string whole(double value) { return fmt::format("{:.0f}", value); }

/// The value of each parameter in the middle of what was profiled: { fps = 10 }.
std::string middle_qos(const compute::PowerProfile& profile) {
    std::vector<std::string> pairs;
    for (std::size_t i = 0; i < profile.parameters.size(); ++i) {
        const auto& axis = profile.axes[i];
        pairs.push_back(fmt::format("{} = {}", toml_key(profile.parameters[i]), axis[(axis.size() - 1) / 2]));
    }
    return toml_inline_table(pairs);
}

std::string middle_run(const NewMission& mission) {
    std::vector<std::string> pairs;
    for (const auto& component : mission.components)
        pairs.push_back(fmt::format("{} = {}", toml_key(component.name), middle_qos(component.power)));
    return toml_inline_table(pairs);
}

std::string list_of(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

std::string head(const NewMission& mission) {
    return fmt::format(
        R"(# A mission: what flies, for how long, on which battery, and which software runs when.
# A line like "#key = value" is a key that may be left out, with an example: take the # away to use it.
# `flightwatt help missions` tells more of each. Files are named relative to this one.

format = 1
# What tables and figures call the mission.
name = {}

)",
        toml_string(mission.name));
}

/// The airspeed of the model's flights in cruise [m/s]: the root of its mean cube, whose power is their mean power.
double airspeed_of(const mechanical::MechanicalModel& model) {
    constexpr double of_a_small_wing = 13.0;
    if (const auto& law = model.phases[flight::Phase::cruise].airspeed_law) return std::cbrt(law->mean);
    const auto& physical = model.physical;
    return physical && physical->mean_airspeed_m_per_s > 0.0 ? physical->mean_airspeed_m_per_s : of_a_small_wing;
}

/// Stated where the physical model makes the cruise's power of it.
std::string cruise_airspeed(const NewMission& mission) {
    const auto& physical = mission.model.physical;
    const bool is_stated = physical && physical->mean_airspeed_m_per_s > 0.0;
    return fmt::format(
        "# Airspeed of the cruise [m/s]{}.\n{}airspeed_m_per_s = {:.1f}\n",
        is_stated ? ": its power is that of [physical] in the model" : ", of a model whose flights measured it",
        is_stated ? "" : "#", airspeed_of(mission.model));
}

std::string aircraft(const NewMission& mission) {
    const auto& phases = mission.model.phases;
    const auto durations =
        fmt::format("takeoff = {}, cruise = {}, landing = {}", whole(phases[flight::Phase::takeoff].duration_s),
                    whole(phases[flight::Phase::cruise].duration_s), whole(phases[flight::Phase::landing].duration_s));
    return fmt::format(
        R"(# The aircraft: its power over take-off, cruise and landing, from `flightwatt batch` or `fit`. "none": computing
# alone; duration_s is then needed.
mechanical = {}
# How long each phase lasts [s], instead of what the model's flights took on average; 0: it is not flown.
#duration_s = {{ {} }}
# The curve of a phase that lasts longer or shorter than the model's: "stretch" it, or "absolute": it runs on in its own
# seconds.
#phase_clock = "absolute"
{}
)",
        toml_string(mission.mechanical), durations, cruise_airspeed(mission));
}

/// As the battery says; else of LiPo cells, by the voltage of a full pack, or by the paper's constant one.
int cells_of(const battery::Battery& pack) {
    constexpr double full_v = 4.2;
    constexpr double nominal_v = 3.7;
    if (pack.cells) return *pack.cells;
    const double cells =
        pack.thevenin ? pack.thevenin->open_circuit.voltage_v.back() / full_v : pack.voltage_v / nominal_v;
    return std::max(1, static_cast<int>(std::lround(cells)));
}

std::string battery(const NewMission& mission) {
    constexpr double min_v_per_cell = 3.0;
    const int cells = cells_of(mission.pack);
    return fmt::format(
        R"(# The battery, from `flightwatt battery`; or {{ voltage_v = 11.1, resistance_ohm = 0.05, capacity_ah = 5 }}.
battery = {}
# Charge at lift-off [%]: 100 is full.
#initial_soc_percent = 98
# What this pack holds [Ah], instead of what the battery's file says.
#capacity_ah = {:.3g}
# The flight ends when the voltage at the terminals falls below this [V]: 3.0 to 3.5 V a cell{}.
#cutoff_voltage_v = {:.1f}
# Charge to land with [%]. 20 % spares the pack.
reserve_soc_percent = 20
# Power below 0 is meant (sun, regeneration), and charges the battery.
#may_charge = true

)",
        toml_string(mission.battery), mission.pack.capacity_ah,
        cells == 1 ? "" : fmt::format(", and this pack has about {}", cells), min_v_per_cell * cells);
}

/// Of each condition what it is, and a value for models that follow another.
struct Condition {
    mechanical::Covariate covariate;
    const char* what;
    double usual;
};

constexpr std::array<Condition, mechanical::covariate_count> conditions_of_missions{
    {{mechanical::Covariate::height, "height of the cruise above the ground [m]", 80.0},
     {mechanical::Covariate::initial_voltage, "resting voltage before take-off [V]", 12.4},
     {mechanical::Covariate::time_to_cruise, "from lift-off to the start of the cruise [s]", 28.0},
     {mechanical::Covariate::wind, "wind in the first minute of the cruise [m/s]", 3.0},
     {mechanical::Covariate::airspeed, "airspeed in that minute [m/s]", 13.0},
     {mechanical::Covariate::ground_speed, "ground speed in that minute [m/s]", 12.0},
     {mechanical::Covariate::airspeed_cubed, "mean cube of the airspeed in that minute [m3/s3]", 2200.0}}};

std::string conditions(const NewMission& mission) {
    std::string text =
        "# What the level of the cruise follows, of a model that was fitted with --level-covariate: its one\n"
        "# (instead of airspeed_m_per_s).\n";
    const auto& law = mission.model.phases[flight::Phase::cruise].level_law;
    for (const auto& condition : conditions_of_missions) {
        const bool is_the_models = law && law->covariate == condition.covariate;
        text += fmt::format("# {}\n#conditions = {{ {} = {:.6g} }}\n", condition.what, to_string(condition.covariate),
                            is_the_models ? law->mean : condition.usual);
    }
    return text + "\n";
}

/// A component's utility by its first parameter, if it has one.
std::string utility_of(const compute::PowerProfile& profile, const char* shape) {
    const auto parameter = profile.parameters.empty()
                               ? std::string()
                               : fmt::format("parameter = {}, ", toml_string(profile.parameters.front()));
    return fmt::format("utility = {{ {}weight = 1{} }}", parameter, profile.parameters.empty() ? "" : shape);
}

std::string component_text(const NewComponent& component, bool is_planned) {
    const auto& profile = component.power;
    auto text =
        fmt::format("[components.{}]\nprofile = {}\n", toml_key(component.name), toml_string(component.profile));
    std::vector<std::string> names;
    names.reserve(profile.parameters.size());
    for (const auto& parameter : profile.parameters) names.push_back(toml_string(parameter));
    text +=
        fmt::format("# names of its parameters, for a profile with flags instead (powprofiler)\n#parameters = [{}]\n",
                    fmt::join(names, ", "));
    names.push_back("\"power_w\"");
    text += fmt::format("# names of its columns, for a CSV without a header; \"_\" passes one over\n#columns = [{}]\n",
                        fmt::join(names, ", "));
    text +=
        "# what a second of it is worth: weight times shape(parameter), \"linear\", \"sqrt\", \"log\" or \"points\"\n";
    text += is_planned ? utility_of(profile, "") + "\n" : "#" + utility_of(profile, ", shape = \"sqrt\"") + "\n";
    if (profile.parameters.empty()) return text + "\n";
    const auto& axis = profile.axes.front();
    const std::vector<double> ends{axis.front(), axis.back()};
    if (axis.size() > 1) {
        text += fmt::format(
            "# or a value of its own at some of them (worth: the older name of value)\n"
            "{}#utility = {{ parameter = {}, shape = \"points\", qos = {}, value = [0, 1] }}\n",
            is_planned ? "# (instead of the line above)\n" : "", toml_string(profile.parameters.front()),
            list_of(ends));
    }
    return text + "\n";
}

std::string components(const NewMission& mission) {
    std::string text =
        "# The software on board, a table each: its name is free, its power from `flightwatt profile`.\n";
    for (const auto& component : mission.components) text += component_text(component, mission.is_planned);
    if (mission.components.empty())
        text += "# `flightwatt new-mission --profile FILE` writes them and their schedule.\n\n";
    return text;
}

std::string schedule(const NewMission& mission) {
    if (mission.components.empty()) return "";
    const auto run = middle_run(mission);
    std::string text =
        mission.is_planned
            ? "# What is fixed and not to be planned: a part of a phase, and the components that run in it. Those\n"
              "# that are not named are off.\n"
            : "# What runs when: every moment once. Components that are not named in `run` are off; values between the\n"
              "# profiled ones are interpolated. `otherwise`: whatever the other entries do not cover.\n";
    if (!mission.is_planned) text += fmt::format("[[schedule]]\notherwise = true\nrun = {}\n", run);
    text +=
        "# Part of a phase (takeoff, cruise or landing), from and to in seconds since it began, or in percent of it.\n";
    text += fmt::format("#[[schedule]]\n#phase = \"cruise\"\n#from = 60\n#to = \"60 %\"\n#run = {}\n", run);
    text += "# So long in the middle of a phase; with run = {} nothing runs.\n";
    return text + "#[[schedule]]\n#phase = \"cruise\"\n#middle = \"20 %\"\n#run = {}\n\n";
}

/// The names of the components, and the values that each was profiled at.
std::string levels_text(const NewMission& mission) {
    std::vector<std::string> levels;
    for (const auto& component : mission.components) {
        std::vector<std::string> pairs;
        for (std::size_t i = 0; i < component.power.parameters.size(); ++i)
            pairs.push_back(
                fmt::format("{} = {}", toml_key(component.power.parameters[i]), list_of(component.power.axes[i])));
        if (!pairs.empty()) levels.push_back(toml_key(component.name) + " = " + toml_inline_table(pairs));
    }
    return toml_inline_table(levels);
}

std::string plan(const NewMission& mission) {
    if (mission.components.empty()) return "";
    std::string text =
        mission.is_planned
            ? "# The schedule is planned: `flightwatt plan`.\n[plan]\n"
            : "# The schedule may be planned (`flightwatt plan`) instead of the [[schedule]] above; say "
              "then what each\n# component is worth: utility. levels: the values to choose from, instead "
              "of all that were profiled.\n#[plan]\n";
    const std::array<std::pair<const char*, std::string>, 4> keys{
        {{"# what runs may change at multiples of this in each phase [s]", "slot_s = 10"},
         {"# a choice stays for at least so long [s]", "dwell_s = 60"},
         {"# components that may be switched off",
          fmt::format("may_be_off = [{}]", toml_string(mission.components.front().name))},
         {"# the values to choose from, instead of all that were profiled", "levels = " + levels_text(mission)}}};
    constexpr std::size_t max_line = 110;  // levels may be many: they are told above
    for (const auto& [what, key] : keys) {
        const bool fits = key.size() + std::string_view(what).size() < max_line;
        text += mission.is_planned ? fmt::format("{}\n#{}\n", what, key)
                                   : fmt::format("#{}{}{}\n", key, fits ? "    " : "", fits ? what : "");
    }
    return text + R"(
# The schedule is planned anew in flight, by the charge that is left and the power that was seen. "static": as if there
# were no [policy].
#[policy]
#kind = "adaptive"
#decide_every_s = 60          # how often a plan is made in each phase [s]
#mechanical_sd_percent = 5    # how far a flight's power is expected from the model's [%]; else as its flights differ
#learning_time_s = 60         # after so long, what was seen counts as much as what was expected [s]
#probability = 0.95           # with which every decision keeps the reserve

)";
}

std::string uncertainty(const NewMission& mission) {
    std::string components;
    if (!mission.components.empty()) {
        components = fmt::format("#compute_sd_percent = {{ {} = 2 }}    # of a component's power [%]\n",
                                 toml_key(mission.components.front().name));
    }
    return R"(# How flights differ, as standard deviations, instead of what model, battery and profiles know of it: for
# `flightwatt simulate --samples` and `plan --probability`.
#[uncertainty]
#level_sd_percent = { takeoff = 5, cruise = 5, landing = 5 }    # of a phase's mean mechanical power [%]
#duration_sd_s = { takeoff = 1, cruise = 20, landing = 3 }      # of its duration [s]
#capacity_sd_percent = 3                                        # of the battery's capacity [%]
)" + components +
           "\n";
}

std::string path(const NewMission& mission) {
    const auto airspeed = fmt::format("{:.1f}", airspeed_of(mission.model));
    return fmt::format(
        R"(# Where the cruise flies (instead of airspeed_m_per_s; duration_s and conditions then say nothing of the cruise). The
# model needs [physical], from `flightwatt batch` or `fit --model physical`; one without it flies level paths, if its
# flights measured their airspeed. `flightwatt path` shows the legs. Places in metres east and north of the origin:
#[path]
#airspeed_m_per_s = {0}
#altitude_m = 90              # as the cruise begins
#climb_m_per_s = 1.5          # rate at which height is gained; without it evenly over the leg
#descent_m_per_s = 1.2        # and lost
#start = {{ east_m = 0, north_m = 0 }}
#return_to_start = true       # at the end straight back
#[[path.leg]]                 # so far in a direction
#length_m = 800
#course_deg = 60              # over ground, clockwise from north
#[[path.leg]]                 # to a place; at another altitude, in another way
#east_m = 1200
#north_m = 900
#altitude_m = 120
#airspeed_m_per_s = {0}
#climb_m_per_s = 1
#descent_m_per_s = 1
#[[path.leg]]                 # circles around a place
#east_m = 1500
#north_m = 900
#circles = 6
#radius_m = 75
#turn = "left"                # or "right"
#[[path.leg]]
#east_m = 900
#north_m = 0
#duration_s = 90              # the way takes so long whatever the wind: a path as it was flown
#[[path.leg]]                 # straight on for so long
#hold_s = 60
#[wind]                       # steady along the path
#speed_m_per_s = 4
#from_deg = 250               # where it blows from
#speed_sd_m_per_s = 1         # standard deviation between flights
#direction_sd_deg = 15
# In degrees (WGS84):
#[path]
#airspeed_m_per_s = {0}
#start = {{ latitude_deg = 43.4622, longitude_deg = 1.2729 }}
#[[path.leg]]
#latitude_deg = 43.4682
#longitude_deg = 1.2801
# From a file of waypoints, CSV or GeoJSON (`flightwatt path --path-from LOG` makes one):
#[path]
#airspeed_m_per_s = {0}
#waypoints = "survey.csv"
# From a flight plan of Paparazzi, its waypoints in the order in which they are flown:
#[path]
#airspeed_m_per_s = {0}
#altitude_m = 260             # as its waypoints' altitudes
#flight_plan = "flight_plan.xml"
#waypoint_order = ["1", "2", "STDBY"]
)",
        airspeed);
}

}  // namespace

std::string new_mission_toml(const NewMission& mission) {
    return head(mission) + aircraft(mission) + battery(mission) + conditions(mission) + components(mission) +
           schedule(mission) + plan(mission) + uncertainty(mission) + path(mission);
}

}  // namespace flightwatt::mission
