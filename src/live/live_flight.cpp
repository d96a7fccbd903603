#include "live/live_flight.h"

#include "base/units.h"
#include "flight/link_gaps.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/select.h"
#include "live/recorder.h"
#include "live/state/moment.h"
#include "live/state/soc_estimation.h"
#include "live/state/telemetry_store.h"
#include "mechanical/prediction.h"
#include "path/path_tracker.h"
#include "telemetry/mavlink_decoder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::live {
namespace {

/// Infinite for data without tracks.
double first_time_s(const flight::FlightData& data) {
    double first_s = std::numeric_limits<double>::infinity();
    for (const auto& [name, member] : flight::track_members())
        if (const auto& time_s = (data.*member).time_s; !time_s.empty()) first_s = std::min(first_s, time_s.front());
    return first_s;
}

}  // namespace

/// Results that cannot be computed are reported in the state, whatever the called functions throw.
class LiveFlight::Impl {
  public:
    Impl(LiveOptions options, std::optional<PredictionInput> input, std::unique_ptr<LiveSchedule> schedule)
        : options_(std::move(options)),
          schedule_(std::move(schedule)),
          store_(options_.flight, std::move(options_.configuration),
                 options_.is_mavlink || (input && (input->path || input->motion)), options_.is_mavlink) {
        if (options_.aircraft_id) store_.keep_only(aircraft_ = *options_.aircraft_id);
        if (input) set_input(std::move(*input));
    }

    void set_input(PredictionInput input) {
        input_ = std::move(input);
        input_warnings_.clear();
        for (const auto& reason : input_->uncertain)
            input_warnings_.push_back(fmt::format("what is ahead may take more: {}", reason));
        if (!input_->battery) return;
        for (const auto& warning : battery_warnings(*input_->battery))
            input_warnings_.push_back(fmt::format("{}: {}", input_->battery_file, warning));
    }

    void receive(IncomingMessage message, double arrival_s) {
        ++messages_;
        arrival_s_ = arrival_s;
        const auto sender = message.text.substr(0, message.text.find(' '));
        if (messages_of_.size() < max_senders || messages_of_.contains(sender)) ++messages_of_[sender];
        if (followed_.empty() || sender == followed_) heard_s_ = arrival_s;
        if (!message.time_s) message.time_s = arrival_s;
        begin_unix_s_ = message.begin_unix_s.value_or(begin_unix_s_);
        const bool is_known = clocks_.contains(sender);
        const auto name = is_known || clocks_.size() < max_senders ? sender : std::string();
        // In a new file, an earlier time needs no confirmation.
        const bool all_restart =
            message.is_after_restart && clocks_[is_known ? sender : followed_].is_late(*message.time_s);
        if (all_restart) clocks_.clear();
        accepted_.clear();
        const bool restarts = clocks_[name].push(std::move(message), accepted_);
        if (restarts) store_.drop(sender);
        if (all_restart) store_.clear();
        const bool is_restart = all_restart || (restarts && sender == followed_);
        if (is_restart) restart();
        store_accepted(is_restart);
    }

    void end() {
        accepted_.clear();
        for (auto& [sender, clock] : clocks_) clock.flush(accepted_);
        store_accepted(false);
        ended_ = true;
    }

    /// Before the aircraft is known, the latest of all.
    std::optional<double> clock_s() const {
        if (const auto followed = clocks_.find(followed_); followed != clocks_.end())
            return followed->second.latest_s();
        std::optional<double> latest_s;
        for (const auto& [sender, clock] : clocks_)
            latest_s = std::max(latest_s.value_or(clock.latest_s()), clock.latest_s());
        return latest_s;
    }

    LiveState update(double silent_s);
    const std::optional<LiveState>& last_predicted() const { return last_predicted_; }

  private:
    void store_accepted(bool clock_restarted) {
        for (const auto& line : accepted_) store_.add(*line.time_s, line.text, line.values, line.packet);
        while (store_.rows() > 2 * options_.max_rows) store_.thin();
        if (!options_.on_lines || accepted_.empty()) return;
        std::string lines;
        for (const auto& line : accepted_) {
            if (line.packet.empty())
                fmt::format_to(std::back_inserter(lines), "{} {}\n", *line.time_s, line.text);
            else
                lines += telemetry::tlog_entry(begin_unix_s_ + *line.time_s, line.packet);
        }
        options_.on_lines(lines, clock_restarted);
    }

    void restart() {
        ++restarts_;
        sorties_before_ += std::exchange(phases_, {}).sorties.size();
        carried_.reset();
        rejected_.clear();
        checked_s_.reset();
        warnings_.clear();
        alarms_.clear();
        if (schedule_) schedule_->reset();
    }

    flight::FlightData data_of(const std::string& sender) const;
    bool flies(const std::string& sender) const;
    void update_flight(const flight::FlightData& data, LiveState& state);
    void update_battery(const flight::FlightData& data, LiveState& state);
    void check_record(const flight::FlightData& data, const LiveState& state);
    std::string no_prediction_reason(const flight::FlightData& data, const LiveState& state) const;
    void predict(const flight::FlightData& data, LiveState& state);
    void predict_battery(LiveState& state, Remarks& remarks) const;
    void forecast(LiveState& state) const;
    void decide(LiveState& state);
    void add_warnings(LiveState& state) const;
    void trim(const LiveState& state);

    LiveOptions options_;
    std::optional<PredictionInput> input_;
    std::unique_ptr<LiveSchedule> schedule_;
    TelemetryStore store_;
    double begin_unix_s_ = recording_start_unix_s(
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count());
    static constexpr std::size_t max_senders = 32;            ///< with clocks and counts; further ones share a clock
    std::map<std::string, ClockFilter, std::less<>> clocks_;  ///< of the senders
    std::map<std::string, std::size_t, std::less<>> messages_of_;  ///< the senders
    std::string aircraft_;                                         ///< empty: not known yet
    std::string followed_;    ///< the aircraft of the last update; empty: not known yet
    double arrival_s_ = 0.0;  ///< of the last message, and of the aircraft's last one
    double heard_s_ = 0.0;
    std::vector<IncomingMessage> accepted_;  ///< of the last message; a member to reuse its memory
    std::size_t messages_ = 0;
    std::size_t restarts_ = 0;
    std::size_t sorties_before_ = 0;        ///< sorties that are not in `phases_` any more
    std::size_t scheduled_sortie_ = 0;      ///< sortie of the schedule
    std::optional<InitialCharge> carried_;  ///< state of charge at the start of the stored rows
    std::string rejected_;                  ///< faults of the power record; empty if it is valid
    std::optional<double> checked_s_;       ///< time of the last check of the record
    std::optional<double> updated_s_;
    bool ended_ = false;
    std::vector<LiveAlarm> alarms_;            ///< of the last update
    std::vector<std::string> warnings_;        ///< of the last check
    std::vector<std::string> input_warnings_;  ///< of the mission and the battery's file
    flight::FlightPhases phases_;
    std::vector<flight::LinkGap> gaps_;               ///< of the power, in the last update
    std::optional<battery::DischargeRecord> record_;  ///< of the last update
    std::string segmentation_error_;
    std::optional<LiveState> last_predicted_;
};

/// The tracks of a sender, which end with its last power or altitude, as for predict.
flight::FlightData LiveFlight::Impl::data_of(const std::string& sender) const {
    auto series = sender.empty() ? flight::FlightSeries() : store_.series(sender);
    if (const double now_s = last_time_s(series); std::isfinite(now_s))
        series = truncate_series(std::move(series), now_s);
    return select_tracks(series);
}

bool LiveFlight::Impl::flies(const std::string& sender) const {
    try {
        const auto data = data_of(sender);
        return !data.altitude_m.empty() && !segment(data).sorties.empty();
    } catch (const std::exception&) {  // what it sends shows no flight
        return false;
    }
}

LiveState LiveFlight::Impl::update(double silent_s) {
    LiveState state;
    state.messages = messages_;
    state.restarts = restarts_;
    state.silence_threshold_s = options_.silence_threshold_s;
    if (input_ && input_->battery) state.reserve_soc_percent = input_->limits.reserve_soc_percent;
    if (const auto senders = store_.senders(); !senders.empty()) {  // one only, once that flies
        const auto flying = senders.size() == 1
                                ? senders.begin()
                                : std::ranges::find_if(senders, [&](const auto& of) { return flies(of); });
        aircraft_ = flying == senders.end() ? senders.front() : *flying;
    }
    if (!aircraft_.empty() && aircraft_ != std::exchange(followed_, aircraft_)) heard_s_ = arrival_s_;
    state.time_s = clock_s().value_or(0.0);
    state.time_since_message_s = silent_s + arrival_s_ - heard_s_;
    auto data = data_of(aircraft_);
    gaps_ = bridge_link_gaps(data);
    state.aircraft_id = data.aircraft_id;
    state.aircraft_name = data.aircraft_name;
    state.other_senders = {messages_of_.begin(), messages_of_.end()};
    state.other_senders.erase(aircraft_);
    update_flight(data, state);
    update_battery(data, state);
    check_record(data, state);
    predict(data, state);
    try {
        forecast(state);
    } catch (const std::exception& error) {
        state.warnings.emplace_back(error.what());
    }
    decide(state);
    add_warnings(state);
    alarms_ = state.alarms = find_alarms(state, input_, alarms_);
    trim(state);
    state.rows = store_.rows();
    if (state.prediction) last_predicted_ = state;
    if (!rejected_.empty()) last_predicted_.reset();
    return state;
}

void LiveFlight::Impl::update_flight(const flight::FlightData& data, LiveState& state) {
    phases_ = {};
    segmentation_error_.clear();
    try {
        if (!data.altitude_m.empty()) phases_ = segment(data);
    } catch (const std::exception& error) {
        segmentation_error_ = error.what();
    }
    state.sortie = sorties_before_ + phases_.sorties.size();
    state.power_w = last_value(data.power_w);
    state.voltage_v = last_value(data.voltage_v);
    state.current_a = last_value(data.current_a);
    state.altitude_m = last_value(data.altitude_m);
    if (phases_.sorties.empty()) return;
    store_.keep_only(aircraft_);
    const auto& sortie = phases_.sorties.back();
    const double now_s = data.last_s;
    update_flight_times(sortie, data, ended_ || state.time_since_message_s >= options_.silence_threshold_s, state);
    state.time_without_power_s = time_without_power_s(data.power_w, state);
    if (state.time_without_power_s > 0.0) state.power_w = state.voltage_v = state.current_a = std::nullopt;
    if (!state.power_w || !unknown_energy_reason(gaps_, {&sortie, 1}).empty()) return;
    state.energy_wh = integrated_energy_wh(data.power_w, sortie.start_s(), state.landed ? sortie.end_s() : now_s);
}

void LiveFlight::Impl::update_battery(const flight::FlightData& data, LiveState& state) {
    record_.reset();
    if (!input_ || !input_->battery || state.time_without_power_s > 0.0) return;
    state.battery = estimate_soc(*input_, carried_, data, record_);
    const bool is_counted = state.began_in_air && !record_ && restarts_ == 0;
    if (is_counted && input_->initial_soc_percent)
        estimate_soc_from_counter(data.charge_ah, input_->battery->capacity_ah, *input_->initial_soc_percent,
                                  *state.battery);
    // Without the alarm's delay, as predict has none.
    const double missing_v = -state.battery->voltage_residual_v.value_or(0.0);
    if (missing_v >= contradicting_v(state.battery->voltage_explained_v)) use_voltage_if_lower(*state.battery);
}

/// Why there can be no prediction now; empty: there can.
std::string LiveFlight::Impl::no_prediction_reason(const flight::FlightData& data, const LiveState& state) const {
    if (!input_) return "a model: give --model or --mission";
    if (!input_->no_prediction_reason.empty()) return input_->no_prediction_reason;
    if (!rejected_.empty()) return "a valid power record: " + rejected_;
    if (state.landed) return fmt::format("at {:.1f} s of the log the aircraft has landed", data.last_s);
    if (state.time_without_power_s > 0.0)
        return fmt::format("telemetry of power: none for {:.0f} s", state.time_without_power_s);
    if (phases_.sorties.empty() && states_flight(data))
        return "a flight in the altitude: the autopilot states that it is in the air";
    if (!state.power_w) {
        const auto reason = no_power_reason(data);
        return reason.empty() ? "telemetry of power" : "measured power: " + reason;
    }
    return without_flight_name(segmentation_error_, data.flight);
}

void LiveFlight::Impl::predict(const flight::FlightData& data, LiveState& state) {
    state.no_prediction_reason = no_prediction_reason(data, state);
    if (!state.no_prediction_reason.empty()) return;
    Remarks remarks;
    try {
        const auto* sortie = phases_.sorties.empty() ? nullptr : &phases_.sorties.back();
        const auto flown =
            state.began_in_air ? airborne_progress(data, *sortie) : mechanical::progress_of(data, sortie, data.last_s);
        const bool is_cruising = flown.cruise_s() > 0.0;
        if (is_cruising) state.expected_power_w = units::joule_from_wh(flown.cruise_energy_wh) / flown.cruise_s();
        const bool has_cruise_start =
            is_cruising && (!state.began_in_air || sortie->phases.front().phase == flight::Phase::takeoff);
        std::optional<path::PathFix> fix;
        if (input_->path && !input_->remaining_s && has_cruise_start)
            fix = locate_on_path(*input_->path, data, flown.cruise_start_s, flown.until_s);
        state.prediction = state.began_in_air ? predict_airborne_start(*input_, flown, has_cruise_start, fix, remarks)
                                              : predict_energy(*input_, flown, fix, remarks);
        predict_battery(state, remarks);
        state.expected_power_w = remaining_power(*state.prediction).front().power_w;
    } catch (const std::exception& error) {
        state.prediction.reset();
        state.no_prediction_reason = without_flight_name(error.what(), data.flight);
    }
    state.warnings.insert(state.warnings.end(), remarks.warnings.begin(), remarks.warnings.end());
}

void LiveFlight::Impl::predict_battery(LiveState& state, Remarks& remarks) const {
    if (!state.battery) return;
    const auto& now = *state.battery;
    const bool has_record = !state.began_in_air && record_ && now.soc_percent;
    if (!has_record && !(state.began_in_air && now.state)) return;
    auto from = battery_now(now);
    if (!has_record) from.drawn_ah = 0.0;
    auto result = forecast_battery(*input_->battery, input_->limits, from, *state.prediction);
    if (!has_record) result.initial.soc_percent = now.state->soc_percent;
    result.initial_soc_is_current = !has_record || now.is_by_voltage;
    if (now.is_by_voltage) remarks.warnings.push_back(voltage_warning(*now.soc_percent, now.state->soc_percent));
    if (!has_record)
        remarks.warnings.emplace_back(now.soc_percent
                                          ? "the telemetry begins in the air: the state of charge is by the "
                                            "autopilot's counter, from --initial-soc or the mission"
                                          : "the telemetry begins in the air: the state of charge is by the voltage");
    state.prediction->battery = result;
}

/// What follows from the battery's state and the prediction.
void LiveFlight::Impl::forecast(LiveState& state) const {
    if (!state.expected_power_w || !state.battery || !state.battery->state) return;
    const auto& now = *state.battery->state;
    // A cruise of unknown duration continues at its mean power.
    const double cruise_w = state.prediction
                                ? state.prediction->cruise.remaining_mean_w + state.prediction->cruise.beyond_w
                                : *state.expected_power_w;
    const std::vector<battery::ConstantLoad> at_once{{cruise_w, 0.0}};
    const auto left_s = [&](double from_last_message_s) {
        return std::max(0.0, from_last_message_s - state.time_since_message_s);
    };
    state.battery->time_to_reserve_s =
        left_s(forecast_landing(*input_->battery, now, at_once, cruise_w, input_->limits).endurance_s);
    if (!state.prediction) return;
    state.battery->probability_below_reserve = probability_below_reserve(*input_, *state.prediction, *state.battery);
    if (!(input_->path && input_->remaining_s) && state.phase == flight::Phase::cruise)
        state.turn_home = latest_return(*input_, *state.prediction, now);
    if (state.turn_home && state.turn_home->latest_in_s)
        state.turn_home->latest_in_s = left_s(*state.turn_home->latest_in_s);
}

void LiveFlight::Impl::decide(LiveState& state) {
    if (!schedule_ || state.landed) return;
    if (state.phase && state.sortie != scheduled_sortie_) {
        if (scheduled_sortie_ > 0) schedule_->reset();
        scheduled_sortie_ = state.sortie;
    }
    const auto phase = state.phase.value_or(flight::Phase::takeoff);
    const auto now = state.battery ? state.battery->state : std::nullopt;
    try {
        state.decision = schedule_->at({phase, state.phase ? state.phase_time_s : 0.0}, state.time_s, now);
    } catch (const std::exception& error) {
        state.warnings.push_back(fmt::format("no schedule: {}", error.what()));
    }
}

/// Every 30 s, as it takes as long as the rest of an update; at once after a gap. Without power first after 10 s: what
/// comes first is often a heartbeat.
void LiveFlight::Impl::check_record(const flight::FlightData& data, const LiveState& state) {
    constexpr double interval_s = 30.0;
    constexpr double gap_s = 10.0;
    constexpr double first_power_s = 10.0;
    if (data.power_w.empty() && state.time_s < first_time_s(data) + first_power_s && !ended_) return;
    if (updated_s_ && std::abs(state.time_s - *updated_s_) > gap_s) checked_s_.reset();
    updated_s_ = state.time_s;
    if (checked_s_ && state.time_s < *checked_s_ + interval_s && !state.landed && !ended_) return;
    checked_s_ = state.time_s;
    if (track_sources(data).empty()) return;
    if (!segmentation_error_.empty()) {
        warnings_ = {segmentation_error_};
        return;
    }
    try {
        auto assessment = assess_flight(data, phases_);
        rejected_ = fmt::format("{}", fmt::join(assessment.power.power_faults, ", "));
        warnings_ = texts_of(assessment.diagnostics, Severity::warning);
        std::ranges::move(gap_warnings(gaps_, phases_.sorties), std::back_inserter(warnings_));
        if (rejected_.empty() && !phases_.sorties.empty())
            rejected_ = unknown_energy_reason(gaps_, {&phases_.sorties.back(), 1});
    } catch (const std::exception& error) {
        warnings_ = {error.what()};
    }
}

void LiveFlight::Impl::add_warnings(LiveState& state) const {
    auto warnings = input_warnings_;
    warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
    state.warnings.insert(state.warnings.begin(), warnings.begin(), warnings.end());
    state.unusable = store_.skipped();
    std::size_t unconfirmed = 0;
    for (const auto& [sender, clock] : clocks_) unconfirmed += clock.unconfirmed();
    if (unconfirmed > 0) state.unusable["a time that no other line confirms"] = unconfirmed;
    const auto followed = clocks_.find(followed_);
    if (const auto steps = followed == clocks_.end() ? 0 : followed->second.steps_back(); steps > 0)
        state.warnings.push_back(
            fmt::format("the clock of the telemetry was set back {} time{}", steps, steps == 1 ? "" : "s"));
    for (const auto& [message, stride] : store_.thinned())
        state.warnings.push_back(fmt::format("of {} every {}th row is retained", message, stride));
}

void LiveFlight::Impl::trim(const LiveState& state) {
    if (store_.rows() <= options_.max_rows) return;
    const double from_s = retention_start_s(phases_, state);
    if (record_ && state.battery && state.battery->soc_percent) {
        const auto& [initial_percent, sd_percent] = state.battery->initial;
        if (const auto percent = soc_at(*input_->battery, *record_, initial_percent, from_s))
            carried_ = InitialCharge{*percent, sd_percent};
    }
    for (const auto& sortie : phases_.sorties) sorties_before_ += sortie.end_s() < from_s ? 1 : 0;
    store_.drop_before(from_s);
    while (store_.rows() > options_.max_rows) store_.thin();
}

LiveFlight::LiveFlight(LiveOptions options, std::optional<PredictionInput> input,
                       std::unique_ptr<LiveSchedule> schedule)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(input), std::move(schedule))) {}

LiveFlight::~LiveFlight() = default;

void LiveFlight::set_input(PredictionInput input) { impl_->set_input(std::move(input)); }
void LiveFlight::receive(IncomingMessage message, double arrival_s) { impl_->receive(std::move(message), arrival_s); }

std::optional<double> LiveFlight::clock_s() const { return impl_->clock_s(); }

void LiveFlight::end() { impl_->end(); }

LiveState LiveFlight::update(double silent_s) { return impl_->update(silent_s); }

const std::optional<LiveState>& LiveFlight::last_predicted() const { return impl_->last_predicted(); }

}  // namespace flightwatt::live
