#include "live/predictor.h"

#include "base/error.h"
#include "live/live_flight.h"
#include "live/prediction.h"
#include "mission/mission_file.h"
#include "telemetry/link_decoder.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr std::string_view no_memory = "there is not enough memory";

/// The messages of samples.
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
    std::optional<PredictionInput> basis;
    std::unique_ptr<LiveSchedule> schedule;
    compute::ComputeModel compute;
};

Start start_of_mission(const PredictorSetup& setup) {
    if (!setup.model_file.empty()) throw UsageError("mission_file and model_file exclude each other");
    mission::MissionReadOptions reading;
    reading.allow_unplanned = true;
    const auto mission = mission::read_mission(setup.mission_file, reading);
    const auto& of = setup_of(mission);
    if (!of.mechanical)
        throw InputError({setup.mission_file}, "the mission has no mechanical model", "name one: mechanical = FILE");
    Start start{input_from_mission(of, setup.mission_file), nullptr, of.compute};
    if (!start.compute.components.empty() || setup.replan)
        start.schedule = std::make_unique<LiveSchedule>(mission, setup.replan);
    return start;
}

/// What --mission or --model, --battery, --remaining and --initial-soc of the programs are.
Start start_of(const PredictorSetup& setup) {
    Start start;
    if (!setup.mission_file.empty()) {
        start = start_of_mission(setup);
    } else {
        if (setup.model_file.empty()) throw UsageError("no model given: expected mission_file, or model_file");
        if (!setup.remaining_s) throw UsageError("model_file goes with remaining_s");
        if (setup.replan) throw UsageError("decides goes with mission_file");
        start.basis =
            input_from_model(mechanical::read_mechanical_model(setup.model_file), setup.model_file, *setup.remaining_s);
    }
    auto& basis = *start.basis;
    basis.remaining_s = setup.remaining_s;
    if (basis.remaining_s && !(*basis.remaining_s >= 0.0 && std::isfinite(*basis.remaining_s)))
        throw UsageError(fmt::format("remaining_s is {}: expected 0 or more", *basis.remaining_s));
    if (!setup.battery_file.empty()) {
        basis.battery = battery::read_battery(setup.battery_file);
        basis.battery_file = setup.battery_file;
    }
    if (!setup.initial_soc_percent) return start;
    if (!(*setup.initial_soc_percent >= 0.0 && *setup.initial_soc_percent <= 100.0))
        throw UsageError(fmt::format("initial_soc_percent is {}: expected 0 to 100", *setup.initial_soc_percent));
    basis.initial_soc_percent = setup.initial_soc_percent;
    return start;
}

LiveOptions options_of(const PredictorSetup& setup) {
    LiveOptions options;
    if (!setup.aircraft_id.empty()) options.aircraft_id = setup.aircraft_id;
    options.most_rows = setup.max_rows;
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
                              of.interval.low_wh,
                              of.interval.high_wh,
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

}  // namespace

/// Input since the last update, in memory that is allocated once.
class InputBuffer {
  public:
    enum class Kind : std::uint8_t { line, message, frames, sample };

    explicit InputBuffer(std::size_t max_bytes) : bytes_(max_bytes) {}

    /// False where it does not fit.
    bool push(Kind kind, double time_s, std::string_view bytes) {
        const Head head{time_s, bytes.size(), kind};
        if (bytes.size() > bytes_.size() || used_ + sizeof(head) > bytes_.size() - bytes.size()) return false;
        std::memcpy(bytes_.data() + used_, &head, sizeof(head));
        if (!bytes.empty()) std::memcpy(bytes_.data() + used_ + sizeof(head), bytes.data(), bytes.size());
        used_ += sizeof(head) + bytes.size();
        return true;
    }

    static Sample sample_of(std::string_view bytes) {
        Sample sample;
        std::memcpy(&sample, bytes.data(), sizeof(sample));
        return sample;
    }

    /// Hands out all of it, in its order, and is empty.
    template <typename Visit>
    void take(const Visit& visit) {
        const auto end = used_;
        used_ = 0;
        for (std::size_t at = 0; at < end;) {
            Head head;
            std::memcpy(&head, bytes_.data() + at, sizeof(head));
            at += sizeof(head);
            visit(head.kind, head.time_s, std::string_view(bytes_.data() + at, head.size));
            at += head.size;
        }
    }

  private:
    struct Head {
        double time_s = 0.0;
        std::size_t size = 0;
        Kind kind = Kind::line;
    };
    static_assert(std::is_trivially_copyable_v<Sample> && std::is_trivially_copyable_v<Head>);

    std::vector<char> bytes_;
    std::size_t used_ = 0;
};

class Predictor::State {
  public:
    State(const PredictorSetup& setup, Start start)
        : input_(setup.input),
          waiting_(setup.max_pending_bytes),
          flight_(options_of(setup), std::move(start.basis), std::move(start.schedule)),
          compute_(std::move(start.compute)) {
        if (setup.input == PredictorInput::messages && !setup.definitions_file.empty())
            decoder_.emplace(telemetry::read_message_dictionary(setup.definitions_file));
        for (const auto& component : compute_.components)
            quality_.emplace_back(component.profile.parameters.size(), 0.0);
        for (std::size_t c = 0; c < quality_.size(); ++c)
            runs.push_back({compute_.components[c].name, false, quality_[c]});
    }

    bool push(InputBuffer::Kind kind, double time_s, std::string_view bytes) {
        const bool is_of_input = (kind == InputBuffer::Kind::sample) == (input_ == PredictorInput::samples);
        const bool is_wanted = is_of_input && std::isfinite(time_s) && (kind != InputBuffer::Kind::frames || decoder_);
        if (is_wanted && waiting_.push(kind, time_s, bytes)) return true;
        ++outlook.dropped;
        return false;
    }

    void look(double silent_s);
    void end();

    PredictorState outlook;
    std::vector<ComponentState> runs;
    std::vector<AlarmText> alarms;

  private:
    void ingest();
    void receive(const Sample& sample);
    void receive(const telemetry::LinkMessage& message, double time_s);
    void set_runs(const compute::Configuration& configuration);

    PredictorInput input_;
    InputBuffer waiting_;
    LiveFlight flight_;
    compute::ComputeModel compute_;
    std::optional<telemetry::LinkDecoder> decoder_;
    std::vector<std::vector<double>> quality_;
    LiveState state_;
    std::size_t not_lines_ = 0;
};

void Predictor::State::receive(const Sample& sample) {
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

void Predictor::State::receive(const telemetry::LinkMessage& message, double time_s) {
    if (message.class_id != telemetry::MessageDictionary::telemetry_class) return;
    flight_.receive({message.time_s, std::string(message.text), false, {message.values.begin(), message.values.end()}},
                    time_s);
}

void Predictor::State::ingest() {
    using Kind = InputBuffer::Kind;
    waiting_.take([&](Kind kind, double time_s, std::string_view bytes) {
        if (kind == Kind::sample) return receive(InputBuffer::sample_of(bytes));
        if (kind == Kind::message) return flight_.receive({time_s, std::string(bytes)}, time_s);
        if (kind == Kind::frames) {
            return decoder_->push(bytes, [&](const telemetry::LinkMessage& message) { receive(message, time_s); });
        }
        auto message = message_of_line(bytes);
        if (message) return flight_.receive(std::move(*message), 0.0);
        ++not_lines_;
    });
}

void Predictor::State::set_runs(const compute::Configuration& configuration) {
    for (std::size_t c = 0; c < runs.size(); ++c) {
        const auto running = std::ranges::find(configuration, c, &compute::RunningComponent::component);
        runs[c].runs = running != configuration.end();
        if (runs[c].runs)
            std::ranges::copy(running->qos, quality_[c].begin());
        else
            std::ranges::fill(quality_[c], 0.0);
    }
}

void Predictor::State::look(double silent_s) {
    ingest();
    state_ = flight_.update(silent_s);
    PredictorState now{state_.time_s,       phase_of(state_.phase), state_.landed,
                       state_.began_in_air, state_.flight_time_s,   state_.energy_wh,
                       state_.power_w,      state_.voltage_v,       state_.altitude_m};
    if (state_.battery && state_.battery->state) now.soc_percent = state_.battery->state->soc_percent;
    if (state_.prediction) now.landing = landing_of(state_);
    now.waits_for = state_.no_prediction_reason;
    if (state_.decision) {
        now.decision = decision_of(*state_.decision);
        set_runs(state_.decision->run);
    }
    now.rows = state_.rows;
    now.dropped = outlook.dropped;
    now.unusable = not_lines_;
    for (const auto& [reason, count] : state_.unusable) now.unusable += count;
    if (decoder_) now.unusable += decoder_->counts().unknown + decoder_->counts().length_mismatches;
    alarms.clear();
    for (const auto& alarm : state_.alarms) alarms.push_back({alarm.kind, alarm.text});
    outlook = now;
}

void Predictor::State::end() {
    ingest();
    if (decoder_) {
        const double time_s = flight_.clock_s().value_or(0.0);
        decoder_->flush([&](const telemetry::LinkMessage& message) { receive(message, time_s); });
    }
    flight_.end();
    look(0.0);
}

Predictor::Predictor(std::unique_ptr<State> state) : state_(std::move(state)) {}
Predictor::~Predictor() = default;

bool Predictor::push_line(std::string_view line) noexcept { return state_->push(InputBuffer::Kind::line, 0.0, line); }

bool Predictor::push_message(double time_s, std::string_view message) noexcept {
    return state_->push(InputBuffer::Kind::message, time_s, message);
}

bool Predictor::push_frames(double time_s, std::string_view bytes) noexcept {
    return state_->push(InputBuffer::Kind::frames, time_s, bytes);
}

bool Predictor::push_sample(const Sample& sample) noexcept {
    return state_->push(InputBuffer::Kind::sample, sample.time_s,
                        {reinterpret_cast<const char*>(&sample), sizeof(sample)});
}

const PredictorState& Predictor::update(double silent_s) noexcept {
    try {
        state_->look(silent_s);
    } catch (const std::exception&) {  // of telemetry nothing is thrown: LiveFlight
        state_->outlook.failure = no_memory;
    }
    return state_->outlook;
}

const PredictorState& Predictor::end() noexcept {
    try {
        state_->end();
    } catch (const std::exception&) {
        state_->outlook.failure = no_memory;
    }
    return state_->outlook;
}

const PredictorState& Predictor::state() const noexcept { return state_->outlook; }
std::span<const ComponentState> Predictor::component_states() const noexcept { return state_->runs; }
std::span<const AlarmText> Predictor::alarms() const noexcept { return state_->alarms; }

PredictorOrError make_predictor(const PredictorSetup& setup) noexcept {
    try {
        auto state = std::make_unique<Predictor::State>(setup, start_of(setup));
        return {std::unique_ptr<Predictor>(new Predictor(std::move(state))), ""};  // its constructor is private
    } catch (const InputError& error) {
        const auto hint = error.hint().empty() ? std::string() : "; " + error.hint();
        return {nullptr, fmt::format("{}: {}{}", to_string(error.where()), error.what(), hint)};
    } catch (const std::exception& error) {
        return {nullptr, error.what()};
    }
}

}  // namespace flightwatt::live
