#include "base/error.h"
#include "battery/battery_toml.h"
#include "flight/telemetry_series.h"
#include "live/live_flight.h"
#include "live/live_state.h"
#include "live/prediction.h"
#include "mission/mission_file.h"
#include "telemetry/link_decoder.h"
#include "telemetry/log_configuration.h"
#include "telemetry/mavlink_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include <flightwatt/predictor.h>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr auto no_memory = "out of memory";  // fits into a string without allocation

/// Definitions of the messages that samples are converted to.
telemetry::LogConfiguration sample_configuration() {
    const auto definition = [](const char* name, std::vector<telemetry::FieldDefinition> fields) {
        return std::pair{std::string(name), telemetry::MessageDefinition{name, std::move(fields), "samples"}};
    };
    const auto field = [](const char* name, const char* unit) {
        return telemetry::FieldDefinition{name, "double", unit, "", std::nullopt};
    };
    telemetry::LogConfiguration configuration;
    configuration.file = "samples";
    configuration.messages = {
        definition("ENERGY", {field("throttle", "%"), field("voltage", "V"), field("current", "A"), field("power", "W"),
                              field("charge", "Ah")}),
        definition("ESTIMATOR", {field("z", "m"), field("z_dot", "m/s")}),
        definition("AIRSPEED", {field("airspeed", "m/s")}),
        definition("ATTITUDE", {field("phi", "deg")}),
    };
    return configuration;
}

struct Start {
    std::optional<PredictionInput> input;
    std::unique_ptr<LiveSchedule> schedule;
    compute::ComputeModel compute;
};

Start start_of_mission(const PredictorSetup& setup) {
    if (!setup.model_file.empty()) throw UsageError("mission_file and model_file exclude each other");
    const auto mission = mission::read_mission(setup.mission_file, {.allow_unplanned = true});
    const auto& of = setup_of(mission);
    if (!of.mechanical)
        throw InputError({setup.mission_file}, "the mission has no mechanical model", "name one: mechanical = FILE");
    Start start{input_from_mission(of, setup.mission_file), nullptr, of.compute};
    if (!start.compute.components.empty() || setup.replan)
        start.schedule = std::make_unique<LiveSchedule>(mission, setup.replan);
    return start;
}

/// As --mission or --model, --battery, --remaining and --initial-soc of the programs.
Start start_of(const PredictorSetup& setup) {
    Start start;
    if (!setup.mission_file.empty()) {
        start = start_of_mission(setup);
    } else {
        if (setup.model_file.empty()) throw UsageError("no model given: expected mission_file, or model_file");
        if (!setup.remaining_s) throw UsageError("model_file requires remaining_s");
        if (setup.replan) throw UsageError("replan requires mission_file");
        auto model = mechanical::read_predicting_model(setup.model_file);
        start.input = input_from_model(std::move(model), setup.model_file, *setup.remaining_s);
    }
    auto& input = *start.input;
    input.remaining_s = setup.remaining_s;
    if (input.remaining_s && !(*input.remaining_s >= 0.0 && std::isfinite(*input.remaining_s)))
        throw UsageError(fmt::format("remaining_s is {}: expected 0 or more", *input.remaining_s));
    if (!setup.battery_file.empty()) {
        input.battery = battery::read_battery(setup.battery_file);
        input.battery_file = setup.battery_file;
    }
    if (!setup.initial_soc_percent) return start;
    if (!(*setup.initial_soc_percent >= 0.0 && *setup.initial_soc_percent <= 100.0))
        throw UsageError(fmt::format("initial_soc_percent is {}: expected 0 to 100", *setup.initial_soc_percent));
    input.initial_soc_percent = setup.initial_soc_percent;
    return start;
}

LiveOptions options_of(const PredictorSetup& setup) {
    LiveOptions options;
    if (!setup.aircraft_id.empty()) options.aircraft_id = setup.aircraft_id;
    options.max_rows = setup.max_rows;
    options.is_mavlink = setup.input == PredictorInput::mavlink;
    if (options.is_mavlink && !setup.definitions_file.empty())
        throw UsageError("definitions_file defines Paparazzi's messages: MAVLink's are known");
    if (setup.input == PredictorInput::samples) {
        options.configuration = sample_configuration();
    } else if (!setup.definitions_file.empty()) {
        options.configuration = telemetry::read_log_configuration(setup.definitions_file);
    }
    return options;
}

FlightPhase phase_of(const std::optional<flight::Phase>& phase) {
    if (!phase) return FlightPhase::ground;
    constexpr std::array phases{FlightPhase::takeoff, FlightPhase::cruise, FlightPhase::landing};
    return phases[static_cast<std::size_t>(*phase)];
}

LandingPrediction landing_of(const LiveState& state) {
    const auto& of = *state.prediction;
    LandingPrediction landing{of.remaining_s,
                              of.landing_s,
                              of.remaining_energy.energy_wh,
                              of.interval.low,
                              of.interval.high,
                              of.flown.energy_wh + of.remaining_energy.energy_wh,
                              state.expected_power_w.value_or(0.0)};
    if (of.battery) {
        landing.soc_percent = of.battery->expected.soc_percent;
        landing.worst_soc_percent = of.battery->worst.soc_percent;
        landing.voltage_v = of.battery->expected.voltage_v;
        landing.fails_in_s = of.battery->expected.fails_after_s;
    }
    if (state.battery) {
        landing.reserve_in_s = state.battery->time_to_reserve_s;
        landing.chance_below_reserve = state.battery->probability_below_reserve;
    }
    if (state.turn_home) landing.turn_home_in_s = state.turn_home->latest_in_s;
    return landing;
}

ScheduleState decision_of(const LiveDecision& of) {
    ScheduleState decision{of.utility_per_s, {}, of.remaining_utility_per_s, of.keeps_reserve, of.changes};
    if (of.next) decision.next_in_s = of.next_in_s;
    return decision;
}

class LivePredictor final : public Predictor {
  public:
    LivePredictor(const PredictorSetup& setup, Start start)
        : input_(setup.input),
          flight_(options_of(setup), std::move(start.input), std::move(start.schedule)),
          compute_(std::move(start.compute)) {
        if (setup.input == PredictorInput::messages && !setup.definitions_file.empty())
            decoder_.emplace(telemetry::read_message_dictionary(setup.definitions_file));
        if (setup.input == PredictorInput::mavlink)
            mavlink_.emplace(std::make_shared<telemetry::MavlinkVehicles>(flight::mavlink_flight_messages()), false);
        state_.components = components_of({});
    }

    bool push_line(std::string_view line) noexcept override {
        return push(PredictorInput::messages, 0.0, [&] {
            auto message = parse_message_line(line);
            if (!message) return void(++not_lines_);
            flight_.receive(std::move(*message), 0.0);
        });
    }
    bool push_message(double time_s, std::string_view message) noexcept override {
        return push(PredictorInput::messages, time_s, [&] { flight_.receive({time_s, std::string(message)}, time_s); });
    }
    bool push_frames(double time_s, std::string_view bytes) noexcept override {
        if (mavlink_)
            return push(PredictorInput::mavlink, time_s, [&] {
                mavlink_->push(bytes, [&](const telemetry::MavlinkMessageOfVehicle& message) {
                    const auto& [sender, name, values, packet, unix_s] = message;
                    flight_.receive({time_s,
                                     fmt::format("{} {}", sender, name),
                                     false,
                                     {values.begin(), values.end()},
                                     std::string(packet)},
                                    time_s);
                });
            });
        return decoder_ && push(PredictorInput::messages, time_s, [&] {
                   decoder_->push(bytes, [&](const telemetry::LinkMessage& message) { receive(message, time_s); });
               });
    }
    bool push_sample(const Sample& sample) noexcept override {
        return push(PredictorInput::samples, sample.time_s, [&] { receive(sample); });
    }
    const PredictorState& update(double silent_s) noexcept override { return update_state(silent_s, false); }
    const PredictorState& end() noexcept override { return update_state(0.0, true); }
    const PredictorState& state() const noexcept override { return state_; }

  private:
    template <typename Receive>
    bool push(PredictorInput kind, double time_s, const Receive& receive) noexcept {
        try {
            if (kind == input_ && std::isfinite(time_s)) return receive(), true;
        } catch (const std::exception&) {
            state_.failure = no_memory;
        }
        ++state_.dropped;
        return false;
    }

    const PredictorState& update_state(double silent_s, bool is_end) noexcept {
        try {
            if (is_end) flush();
            state_ = state_of(flight_.update(silent_s));
        } catch (const std::exception&) {  // LiveFlight does not throw because of telemetry
            state_.failure = no_memory;
        }
        return state_;
    }

    void flush();
    void receive(const Sample& sample);
    void receive(const telemetry::LinkMessage& message, double time_s);
    std::vector<ComponentState> components_of(const LiveState& state) const;
    PredictorState state_of(const LiveState& state) const;

    PredictorInput input_;
    LiveFlight flight_;
    compute::ComputeModel compute_;
    std::optional<telemetry::LinkDecoder> decoder_;
    std::optional<telemetry::MavlinkDecoder> mavlink_;
    std::size_t not_lines_ = 0;
    PredictorState state_;
};

void LivePredictor::receive(const Sample& sample) {
    const auto send = [&](const char* message, std::vector<double> values) {
        for (auto& value : values)
            if (!std::isfinite(value)) value = Sample::unknown;
        const auto is_known = [](double value) { return !std::isnan(value); };
        if (std::ranges::any_of(values, is_known))
            flight_.receive({sample.time_s, message, false, std::move(values)}, sample.time_s);
    };
    send("1 ENERGY", {sample.throttle_percent, sample.voltage_v, sample.current_a, sample.power_w, sample.charge_ah});
    send("1 ESTIMATOR", {sample.altitude_m, sample.climb_m_per_s});
    send("1 AIRSPEED", {sample.airspeed_m_per_s});
    send("1 ATTITUDE", {sample.bank_deg});
}

void LivePredictor::receive(const telemetry::LinkMessage& message, double time_s) {
    if (message.class_id != telemetry::MessageDictionary::telemetry_class) return;
    flight_.receive({message.time_s, std::string(message.text), false, {message.values.begin(), message.values.end()}},
                    time_s);
}

std::vector<ComponentState> LivePredictor::components_of(const LiveState& state) const {
    std::vector<ComponentState> components;
    for (const auto& component : compute_.components) components.push_back({component.name});
    if (!state.decision) return components;
    for (const auto& running : state.decision->run) {
        components[running.component].runs = true;
        components[running.component].quality.assign(running.qos.begin(), running.qos.end());
    }
    return components;
}

PredictorState LivePredictor::state_of(const LiveState& state) const {
    PredictorState now{state.time_s,    phase_of(state.phase), state.landed,    state.began_in_air, state.flight_time_s,
                       state.energy_wh, state.power_w,         state.voltage_v, state.altitude_m};
    if (state.battery && state.battery->state) now.soc_percent = state.battery->state->soc_percent;
    if (state.prediction) now.landing = landing_of(state);
    now.waits_for = state.no_prediction_reason;
    if (state.decision) now.decision = decision_of(*state.decision);
    now.components = components_of(state);
    for (const auto& [kind, grade, text, action] : state.alarms) now.alarms.push_back({kind, grade, text, action});
    now.rows = state.rows;
    now.dropped = state_.dropped;
    now.unusable = not_lines_;
    for (const auto& [reason, count] : state.unusable) now.unusable += count;
    if (decoder_) now.unusable += decoder_->counts().unknown + decoder_->counts().length_mismatches;
    return now;
}

void LivePredictor::flush() {
    if (decoder_) {
        const double time_s = flight_.clock_s().value_or(0.0);
        decoder_->flush([&](const telemetry::LinkMessage& message) { receive(message, time_s); });
    }
    flight_.end();
}

}  // namespace

PredictorOrError make_predictor(const PredictorSetup& setup) noexcept {
    try {
        return {std::make_unique<LivePredictor>(setup, start_of(setup)), ""};
    } catch (const InputError& error) {
        const auto hint = error.hint().empty() ? std::string() : "; " + error.hint();
        return {nullptr, fmt::format("{}: {}{}", to_string(error.where()), error.what(), hint)};
    } catch (const std::exception& error) {
        return {nullptr, error.what()};
    }
}

}  // namespace flightwatt::live
