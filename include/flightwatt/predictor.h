#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The live predictor as a library for other programs (docs/live.md).
namespace flightwatt::live {

enum class PredictorInput {
    messages,  ///< of Paparazzi, as text or link frames
    samples    ///< Sample
};

/// Files as for `flightwatt watch`; an empty name: none.
struct PredictorSetup {
    std::string mission_file = {};           ///< with model, path, battery, reserve and schedule; or
    std::string model_file = {};             ///< a model, with `remaining_s`
    std::string battery_file = {};           ///< replaces the mission's
    std::string definitions_file = {};       ///< .log or messages.xml: required for frames; default of text: built-in
    std::string aircraft_id = {};            ///< empty: the first that flies
    std::optional<double> remaining_s = {};  ///< of the cruise, from any moment on
    std::optional<double> initial_soc_percent = {};  ///< none: by the resting voltage
    bool replan = false;                             ///< at every slot of the mission's plan
    PredictorInput input = PredictorInput::messages;
    std::size_t max_rows = 30'000;  ///< of messages in memory; beyond, they are thinned
};

/// Measurements at a time; NaN: unknown. Unknown power is voltage times current.
struct Sample {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double time_s = unknown;
    double voltage_v = unknown;
    double current_a = unknown;
    double power_w = unknown;
    double charge_ah = unknown;  ///< drawn, by a counter
    double throttle_percent = unknown;
    double altitude_m = unknown;
    double climb_m_per_s = unknown;
    double airspeed_m_per_s = unknown;
    double bank_deg = unknown;
};

enum class FlightPhase { ground, takeoff, cruise, landing };

/// Prediction from a moment in cruise to the touchdown.
struct LandingPrediction {
    double remaining_s = 0.0;  ///< of the cruise
    double landing_s = 0.0;    ///< duration of the landing after it
    double energy_wh = 0.0;    ///< from now to the touchdown, with its 95 % interval
    double energy_low_wh = 0.0;
    double energy_high_wh = 0.0;
    double total_energy_wh = 0.0;   ///< from the lift-off to the touchdown
    double expected_power_w = 0.0;  ///< of the next load
    // With a battery:
    std::optional<double> soc_percent = {};           ///< at the touchdown, or where the battery fails before
    std::optional<double> worst_soc_percent = {};     ///< at the high end of the energy
    std::optional<double> voltage_v = {};             ///< expected at the same time
    std::optional<double> fails_in_s = {};            ///< expected: empty, cut off or overloaded
    std::optional<double> reserve_in_s = {};          ///< time to the reserve in a continued cruise
    std::optional<double> chance_below_reserve = {};  ///< probability at landing, 0 to 1
    std::optional<double> turn_home_in_s = {};        ///< latest moment to leave the path for home, or to land
};

/// The mission's schedule, or with `replan` the current plan.
struct ScheduleState {
    double utility_per_s = 0.0;               ///< of the current configuration
    std::optional<double> next_in_s = {};     ///< to the next change
    std::optional<double> rest_utility = {};  ///< mean a second to the mission's end
    bool keeps_reserve = true;
    std::size_t changes = 0;  ///< since the flight began
};

/// A component of the mission's computer.
struct ComponentState {
    std::string name;
    bool runs = false;
    std::vector<double> quality = {};  ///< a value for each QoS parameter; empty where it is off
};

struct Alarm {
    std::string kind;    ///< "reserve", "model", "silence" or "voltage"
    std::string grade;   ///< "caution" or "alarm"
    std::string text;    ///< the finding
    std::string action;  ///< recommended, with the time left
};

/// The state at a moment.
struct PredictorState {
    double time_s = 0.0;  ///< of the latest message
    FlightPhase phase = FlightPhase::ground;
    bool landed = false;
    bool began_in_air = false;  ///< the flight before the first message is unknown
    double flight_s = 0.0;
    std::optional<double> energy_wh = {};  ///< since the lift-off
    std::optional<double> power_w = {};
    std::optional<double> voltage_v = {};
    std::optional<double> altitude_m = {};
    std::optional<double> soc_percent = {};
    std::optional<LandingPrediction> landing = {};
    std::string waits_for = {};  ///< reason where there is no prediction
    std::optional<ScheduleState> decision = {};
    std::vector<ComponentState> components = {};  ///< all of the mission, by the last decision
    std::vector<Alarm> alarms = {};
    std::size_t rows = 0;      ///< in memory
    std::size_t dropped = 0;   ///< pushes that returned false, since the start
    std::size_t unusable = 0;  ///< lines, frames and values, since the start
    std::string failure = {};  ///< reason why the update failed (out of memory); else empty
};

/// Predicts the energy of a flight in progress, as `flightwatt watch` does from the same telemetry. Its functions do
/// not throw. One thread at a time.
class Predictor {
  public:
    Predictor() = default;
    virtual ~Predictor() = default;
    Predictor(const Predictor&) = delete;
    Predictor& operator=(const Predictor&) = delete;

    // Input that is pushed is stored. False, and counted, without memory and for the other kind of input.

    /// A line of a .data file: "73.2 20 ENERGY 57 11.62 1.64 19.1 0.08 0.97".
    virtual bool push_line(std::string_view line) noexcept = 0;
    /// A message without its time: "20 ENERGY 57 11.62 1.64 19.1 0.08 0.97".
    virtual bool push_message(double time_s, std::string_view message) noexcept = 0;
    /// Bytes of a link (pprzlink 1 or 2, plain or XBee), in chunks of any size, received at `time_s`.
    virtual bool push_frames(double time_s, std::string_view bytes) noexcept = 0;
    virtual bool push_sample(const Sample& sample) noexcept = 0;

    /// Updates the prediction; once a second of flight suffices. `silent_s`: time since
    /// the last input. The result is valid until the next update.
    virtual const PredictorState& update(double silent_s = 0.0) noexcept = 0;
    /// No more input will follow: accepts messages whose times are not confirmed yet, and updates.
    virtual const PredictorState& end() noexcept = 0;
    /// The result of the last update.
    virtual const PredictorState& state() const noexcept = 0;
};

/// A predictor, or an error.
struct PredictorOrError {
    std::unique_ptr<Predictor> predictor;
    std::string error;  ///< as of the programs: file, position, finding, action
};

/// Reads the files, plans the mission if necessary, and allocates the memory.
PredictorOrError make_predictor(const PredictorSetup& setup) noexcept;

}  // namespace flightwatt::live
