#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// The live predictor for programs of others: docs/live.md, "As a library".
namespace flightwatt::live {

/// What a predictor receives.
enum class PredictorInput {
    messages,  ///< Paparazzi's, as text or as link frames
    samples    ///< Sample
};

/// What a predictor is made from. Files are those of flightwatt watch; an empty name: none.
struct PredictorSetup {
    std::string mission_file = {};      ///< model, path, battery, reserve and schedule; or
    std::string model_file = {};        ///< a model alone, with `remaining_s`
    std::string battery_file = {};      ///< instead of the mission's
    std::string definitions_file = {};  ///< .log or messages.xml: needed for frames; text without it: the built-in ones
    std::string aircraft_id = {};       ///< empty: the one that flies
    std::optional<double> remaining_s = {};          ///< of the cruise, from each moment on
    std::optional<double> initial_soc_percent = {};  ///< none: by the voltage at rest
    bool replan = false;                             ///< plans the rest anew at every slot of the mission's plan
    PredictorInput input = PredictorInput::messages;
    std::size_t max_rows = 30'000;              ///< of messages that are kept; of more every second one goes
    std::size_t max_pending_bytes = 1'000'000;  ///< pushed between two updates; what does not fit is dropped
};

/// What was measured at a time; NaN: not known. Power is voltage times current where it is not known itself.
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

/// From a moment in cruise to the touchdown.
struct LandingPrediction {
    double remaining_s = 0.0;  ///< of the cruise
    double landing_s = 0.0;    ///< of the landing after it
    double energy_wh = 0.0;    ///< from now to the touchdown, with its 95 % interval
    double energy_low_wh = 0.0;
    double energy_high_wh = 0.0;
    double total_energy_wh = 0.0;   ///< from the lift-off to the touchdown
    double expected_power_w = 0.0;  ///< of what comes next
    // With a battery:
    std::optional<double> soc_percent = {};        ///< at the touchdown, or where the battery failed before
    std::optional<double> worst_soc_percent = {};  ///< at the high end of the energy
    std::optional<double> voltage_v = {};          ///< there, as expected
    std::optional<double> fails_in_s = {};         ///< as expected: empty, cut off, or asked for more than it has
    std::optional<double> reserve_in_s = {};       ///< so long could the cruise go on until the reserve alone is left
    std::optional<double> chance_below_reserve = {};  ///< of landing below it, 0 to 1
    std::optional<double> turn_home_in_s = {};        ///< with a path: the latest moment to leave it for home
};

/// What the mission's schedule says, or with `replan` the plan from here.
struct ScheduleState {
    double utility_per_s = 0.0;               ///< of what runs now
    std::optional<double> next_in_s = {};     ///< until something else is to run
    std::optional<double> rest_utility = {};  ///< mean a second from here to the mission's end
    bool keeps_reserve = true;
    std::size_t changes = 0;  ///< of what runs, since the flight began
};

/// A component of the mission's computer, and whether it is to run.
struct ComponentState {
    std::string_view name;
    bool runs = false;
    std::span<const double> quality = {};  ///< one value a parameter of its quality of service; 0 where it is off
};

/// What is known at a moment. Texts are valid until the next update.
struct PredictorState {
    double time_s = 0.0;  ///< of the latest message
    FlightPhase phase = FlightPhase::ground;
    bool landed = false;
    bool began_in_air = false;  ///< what was flown before the first message is not known
    double flight_s = 0.0;
    std::optional<double> energy_wh = {};  ///< since the lift-off
    std::optional<double> power_w = {};
    std::optional<double> voltage_v = {};
    std::optional<double> altitude_m = {};
    std::optional<double> soc_percent = {};
    std::optional<LandingPrediction> landing = {};
    std::string_view waits_for = {};  ///< why there is no prediction
    std::optional<ScheduleState> decision = {};
    std::size_t rows = 0;           ///< kept
    std::size_t dropped = 0;        ///< what was pushed and did not fit, since the start
    std::size_t unusable = 0;       ///< lines, frames and values, since the start
    std::string_view failure = {};  ///< why this update is none: memory ran out; else empty
};

struct AlarmText {
    std::string_view kind;  ///< "reserve", "model", "silence", "voltage"
    std::string_view text;
};

struct PredictorOrError;

/// A flight's energy while it is in the air: the same as flightwatt watch says of the same telemetry. Nothing that it
/// calls throws across it. One thread at a time.
class Predictor {
  public:
    ~Predictor();
    Predictor(const Predictor&) = delete;
    Predictor& operator=(const Predictor&) = delete;

    // What comes in is copied into memory that was set aside at the start: no allocation, no computation. False, and
    // counted, where it does not fit, and for the other kind of input.

    /// A line of a .data file: "73.2 20 ENERGY 57 11.62 1.64 19.1 0.08 0.97".
    bool push_line(std::string_view line) noexcept;
    /// A message without its time: "20 ENERGY 57 11.62 1.64 19.1 0.08 0.97".
    bool push_message(double time_s, std::string_view message) noexcept;
    /// Bytes of a link (pprzlink 1 or 2, plain or XBee), in pieces of any size, that came in at `time_s`.
    bool push_frames(double time_s, std::string_view bytes) noexcept;
    bool push_sample(const Sample& sample) noexcept;

    /// Takes in what was pushed, and computes anew: once a second of flight is often enough. `silent_s`: for how long
    /// nothing has come. Valid until the next update.
    const PredictorState& update(double silent_s = 0.0) noexcept;
    /// Nothing more will come: what was held back, as no other message confirmed its time, counts now. Updates.
    const PredictorState& end() noexcept;
    /// The last one.
    const PredictorState& state() const noexcept;
    /// All components of the mission, with what the last update's decision says of them.
    std::span<const ComponentState> component_states() const noexcept;
    std::span<const AlarmText> alarms() const noexcept;

  private:
    friend PredictorOrError make_predictor(const PredictorSetup& setup) noexcept;
    class State;
    explicit Predictor(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// A predictor, or why there is none.
struct PredictorOrError {
    std::unique_ptr<Predictor> predictor;
    std::string error;  ///< as the programs say it: file, place, what was found, how to mend it
};

/// Reads the files, plans the mission where that is to be done, and sets the memory aside.
PredictorOrError make_predictor(const PredictorSetup& setup) noexcept;

}  // namespace flightwatt::live
