#pragma once

#include "answer/answered.h"
#include "answer/flight_facts.h"
#include "answer/pack_answer.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/speed_to_fly.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The questions that pilots ask of an aircraft and its pack: how long, how far, with what payload and in what wind.
///
/// An answer is made of a power model, a battery and what the cruises of the flights were like. Each quantity states
/// what it rests on; one that cannot be known has the reason, and which flight would show it, instead of a value. Time
/// in the air is the longest mission of take-off, cruise (of a rotorcraft its hover) and landing that begins with a full
/// pack and lands with the reserve. Distances are out and back, along a steady wind and across it; the way home is
/// against it.
namespace flightwatt::answer {

/// Folder of an answer unless --output names one, and the names of its files, with those of a batch.
inline constexpr auto default_folder = "flightwatt-out";
inline constexpr auto pack_name = "answer-pack.toml";
inline constexpr auto mission_name = "answer-mission.toml";
inline constexpr auto kept_name = "answer.json";  ///< what --again repeats

/// What is asked.
struct Question {
    double reserve_soc_percent = 20.0;
    std::optional<double> airspeed_m_per_s = {};  ///< default: as flown
    std::optional<double> payload_kg = {};        ///< beyond the aircraft's own mass; default: as flown
    std::optional<double> takeoff_mass_kg = {};   ///< of the flights, where a payload's effect must be assumed
    double wind_m_per_s = 0.0;
    std::optional<double> wind_from_deg = {};  ///< absent: not stated
    bool draws_flights = true;                 ///< for what 95 of 100 flights reach; takes as long as all else
};

/// What is known of an aircraft from its flights.
struct KnownAircraft {
    mechanical::MechanicalModel model;
    std::filesystem::path model_file;    ///< that has the model, for the mission
    std::filesystem::path battery_file;  ///< that has the battery
    std::vector<FlightFacts> flights;
    PackAnswer pack;
};

/// How long and how far, and at what power.
struct Endurance {
    bool is_hover = false;           ///< of a rotorcraft that flies as slowly as it flew
    Answered power_w;                ///< mean, of hover or cruise
    Answered time_s;                 ///< in the air from a full pack to the reserve
    Answered time_95_s;              ///< the same, which 95 of 100 flights reach
    std::optional<double> cruise_s;  ///< of the flight that 95 of 100 reach, else of the mean one; absent: unknown
    Answered airspeed_m_per_s;       ///< in cruise
    Answered distance_m;             ///< over ground in the cruise, out and back along the wind
    std::optional<double> distance_across_m;         ///< across the wind; absent in calm air
    Answered return_airspeed_m_per_s;                ///< of the failsafe's way home
    std::vector<mechanical::BestSpeed> best_speeds;  ///< of endurance and range; empty where they are not known
    std::vector<std::string> notes;                  ///< limits of the answers, such as "extrapolated"
};

/// Answers how long and how far. Throws InputError for a reserve, payload or airspeed that no mission accepts.
Endurance answer_endurance(const KnownAircraft& aircraft, const Question& question);

/// The mission of a question as a file next to the model, for other commands; its cruise takes `cruise_s`, or
/// as long as those of the flights.
std::string mission_toml(const KnownAircraft& aircraft, const Question& question,
                         const std::optional<double>& cruise_s = std::nullopt);

}  // namespace flightwatt::answer
