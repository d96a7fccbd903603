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

/// Kinds of input of a predictor.
enum class PredictorInput {
    messages,  ///< messages of Paparazzi, as text or link frames
    samples,   ///< measurements as Sample
    mavlink    ///< packets of MAVLink 1 and 2, as bytes
};

/// Files and options as for `flightwatt watch`; an empty name means no file.
struct PredictorSetup {
    std::string mission_file = {};           ///< with model, path, battery, reserve and schedule; or
    std::string model_file = {};             ///< a model, with `remaining_s`
    std::string battery_file = {};           ///< replaces the mission's
    std::string definitions_file = {};       ///< .log or messages.xml: required for frames; default of text: built-in
    std::string aircraft_id = {};            ///< empty: the first that flies; of MAVLink the number of the system
    std::optional<double> remaining_s = {};  ///< rest of the cruise, from any moment
    std::optional<double> initial_soc_percent = {};  ///< absent: by the resting voltage
    bool replan = false;                             ///< plans again at every slot of the mission's plan
    PredictorInput input = PredictorInput::messages;
    std::size_t max_rows = 30'000;  ///< maximum number of messages in memory; more are thinned
};

/// Measurements at a time; NaN if unknown. Unknown power is voltage times current.
struct Sample {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double time_s = unknown;
    double voltage_v = unknown;
    double current_a = unknown;
    double power_w = unknown;
    double charge_ah = unknown;  ///< charge drawn, by a counter
    double throttle_percent = unknown;
    double altitude_m = unknown;
    double climb_m_per_s = unknown;
    double airspeed_m_per_s = unknown;
    double bank_deg = unknown;
};

/// Phases of a flight, and the time on the ground.
enum class FlightPhase { ground, takeoff, cruise, landing };

/// Prediction from a moment in cruise to the touchdown.
struct LandingPrediction {
    double remaining_s = 0.0;  ///< rest of the cruise
    double landing_s = 0.0;    ///< duration of the landing after it
    double energy_wh = 0.0;    ///< from now to the touchdown, with its 95 % interval
    double energy_low_wh = 0.0;
    double energy_high_wh = 0.0;
    double total_energy_wh = 0.0;   ///< from the lift-off to the touchdown
    double expected_power_w = 0.0;  ///< power of the next load
    // With a battery:
    std::optional<double> soc_percent = {};           ///< at the touchdown, or where the battery fails before
    std::optional<double> worst_soc_percent = {};     ///< at the high end of the energy
    std::optional<double> voltage_v = {};             ///< expected at the same time
    std::optional<double> fails_in_s = {};            ///< expected: empty, cut off or overloaded
    std::optional<double> reserve_in_s = {};          ///< time to the reserve in a continued cruise
    std::optional<double> chance_below_reserve = {};  ///< probability at landing, 0 to 1
    std::optional<double> turn_home_in_s = {};        ///< latest moment to leave the path for home, or to land
};

/// The state of the mission's schedule, or with `replan` of the current plan.
struct ScheduleState {
    double utility_per_s = 0.0;               ///< utility of the current configuration
    std::optional<double> next_in_s = {};     ///< time to the next change
    std::optional<double> rest_utility = {};  ///< mean utility per second to the mission's end
    bool keeps_reserve = true;
    std::size_t changes = 0;  ///< number of changes since the flight began
};

/// A component of the mission's computer.
struct ComponentState {
    std::string name;
    bool runs = false;
    std::vector<double> quality = {};  ///< a value for each QoS parameter; empty if it is off
};

/// A warning for the pilot about the flight.
struct Alarm {
    std::string kind;    ///< "reserve", "model", "silence" or "voltage"
    std::string grade;   ///< "caution" or "alarm"
    std::string text;    ///< the finding
    std::string action;  ///< recommended, with the time left
};

/// The state of a flight at a moment, with the prediction.
struct PredictorState {
    double time_s = 0.0;  ///< time of the latest message
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
    std::string waits_for = {};  ///< reason why there is no prediction yet; empty if there is one
    std::optional<ScheduleState> decision = {};
    std::vector<ComponentState> components = {};  ///< all components of the mission, by the last decision
    std::vector<Alarm> alarms = {};
    std::size_t rows = 0;      ///< messages in memory
    std::size_t dropped = 0;   ///< number of pushes that returned false, since the start
    std::size_t unusable = 0;  ///< number of unusable lines, frames and values, since the start
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

    // A push stores its input. Without memory, and for the other kind of input, it returns false, which is counted.

    /// Adds a line of a .data file: "73.2 20 ENERGY 57 11.62 1.64 19.1 0.08 0.97".
    virtual bool push_line(std::string_view line) noexcept = 0;
    /// Adds a message without its time: "20 ENERGY 57 11.62 1.64 19.1 0.08 0.97".
    virtual bool push_message(double time_s, std::string_view message) noexcept = 0;
    /// Adds bytes of a link (pprzlink 1 or 2, plain or XBee; or MAVLink), in chunks of any size, received at `time_s`.
    virtual bool push_frames(double time_s, std::string_view bytes) noexcept = 0;
    /// Adds measurements.
    virtual bool push_sample(const Sample& sample) noexcept = 0;

    /// Updates the prediction; once a second of flight suffices. `silent_s` is the time since the last input. The
    /// result is valid until the next update.
    virtual const PredictorState& update(double silent_s = 0.0) noexcept = 0;
    /// Ends the input: accepts messages whose times are not confirmed yet, and updates.
    virtual const PredictorState& end() noexcept = 0;
    /// Returns the result of the last update.
    virtual const PredictorState& state() const noexcept = 0;
};

/// A predictor, or an error.
struct PredictorOrError {
    std::unique_ptr<Predictor> predictor;
    std::string error;  ///< error text as of the programs: file, position, finding, action
};

/// Reads the files, plans the mission if necessary, and allocates the memory.
PredictorOrError make_predictor(const PredictorSetup& setup) noexcept;

}  // namespace flightwatt::live
