#pragma once

#include "base/statistics.h"
#include "mission/mission_summary.h"
#include "mission/new_mission_toml.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::answer {

/// Whether a plan fits a battery.
enum class PlanFit {
    yes,      ///< it keeps the reserve with the probability that is asked for
    perhaps,  ///< it keeps it as modelled, with less than that probability or an unknown one, or a part is uncertain
    no        ///< it misses it as modelled, or cannot be flown in the wind
};

/// "yes", "perhaps" or "no".
std::string to_string(PlanFit fit);

/// A plan, the aircraft and pack that shall fly it, and how sure it has to be.
struct PlanQuestion {
    mission::NewMission aircraft;  ///< with payload, wind and reserve; files are named from the working folder
    mission::PlanToFly plan;
    double probability = 0.95;
    std::size_t samples = 2000;  ///< drawn flights
    std::uint64_t seed = 1;
};

/// A leg, circles or a hold of the plan, with its turns.
struct PlanLeg {
    std::string name;
    double start_s = 0.0;  ///< since lift-off
    double duration_s = 0.0;
    double length_m = 0.0;  ///< over ground
    double energy_wh = 0.0;
    double soc_percent = 0.0;  ///< at its end
};

/// A change of the flight, and how it lands with it.
struct PlanRemedy {
    std::string kind;  ///< "airspeed", "heading", "spacing", "part", "pack" or "payload"
    std::string text;
    double value = 0.0;  ///< m/s, degrees, m, part of the path, Ah or kg
    std::optional<double> final_soc_percent;
    std::optional<double> probability;  ///< of keeping the reserve; absent: unknown
    bool suffices = false;              ///< alone
};

/// The answer for one plan.
struct PlanCheck {
    std::string plan;
    PlanFit fit = PlanFit::no;
    std::string reason;  ///< why it cannot be flown, or is uncertain; may be empty
    double probability_required = 0.0;
    std::optional<double> probability;             ///< of keeping the reserve; absent: unknown
    std::optional<Interval> probability_95;        ///< of new flights
    std::optional<mission::MissionSummary> flown;  ///< as modelled; absent, with all about the flight: unknown
    std::optional<double> length_m;                ///< of the path
    std::optional<std::string> fails_at;  ///< phase or leg where the charge is below the reserve, or the battery fails
    std::optional<double> fails_at_s;     ///< since lift-off
    std::vector<PlanLeg> legs;
    std::vector<PlanRemedy> remedies;  ///< where the answer is not yes
    std::vector<std::string> chosen;   ///< what the plan leaves open
    std::vector<std::string> notes;    ///< of the mission
};

/// Flies a plan as a mission in memory, draws flights, and where they miss the reserve tries what would help: each by
/// simulating the changed mission. Throws InputError for a plan or model that cannot be read, and UsageError as
/// mission::path_of_plan().
PlanCheck check_plan(const PlanQuestion& question);

}  // namespace flightwatt::answer
