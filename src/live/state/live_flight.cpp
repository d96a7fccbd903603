#include "live/live_flight.h"

#include "base/units.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"
#include "live/state/aircraft_choice.h"
#include "live/state/moment.h"
#include "live/state/sender_clocks.h"
#include "live/state/telemetry_store.h"
#include "mechanical/prediction.h"
#include "path/path_tracker.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::live {
namespace {

constexpr double judged_every_s = 30.0;  // the record's warnings take as long as all the rest

std::optional<double> last_of(const flight::SelectedTracks& tracks, const char* name) {
    const auto& track = tracks[name];
    return track.empty() ? std::nullopt : std::optional(track.value.back());
}

}  // namespace

/// What cannot be computed from what came in is said, and the watch goes on: whatever a library throws of it.
class LiveFlight::Impl {
  public:
    Impl(LiveOptions options, std::optional<PredictionInput> basis, std::unique_ptr<LiveSchedule> schedule)
        : options_(std::move(options)),
          basis_(std::move(basis)),
          schedule_(std::move(schedule)),
          store_(options_.flight, std::move(options_.configuration),
                 {.bank = basis_ && (basis_->path || basis_->motion), .places = basis_ && basis_->path}),
          choice_(options_.aircraft_id) {
        if (basis_ && basis_->path && !basis_->remaining_s && basis_->path->flown().duration_s > 0.0)
            places_.emplace(*basis_->path);
        if (!basis_ || !basis_->battery) return;
        for (const auto& warning : battery_warnings(*basis_->battery))
            battery_warnings_.push_back(fmt::format("{}: {}", basis_->battery_file, warning));
    }

    void receive(IncomingMessage message, double arrival_s) {
        ++messages_;
        choice_.count(message.text);
        const std::string sender(sender_of(message.text));
        believed_.clear();
        using Scope = SenderClocks::RestartScope;
        const auto scope = clocks_.push(
            {message.time_s.value_or(arrival_s), std::move(message.text), arrival_s, std::move(message.values)},
            message.is_after_restart, believed_);
        const bool is_restart = scope == Scope::all || (scope == Scope::sender && clocks_.is_followed(sender));
        if (scope == Scope::sender) store_.drop(sender);
        if (scope == Scope::all) store_.clear();
        if (is_restart) restart();
        take(is_restart);
    }

    void end() {
        believed_.clear();
        clocks_.flush(believed_);
        take(false);
        ended_ = true;
    }

    std::optional<double> clock_s() const {
        return clocks_.started() ? std::optional(clocks_.latest_s()) : std::nullopt;
    }

    LiveState look(double silent_s);
    const std::optional<LiveState>& last_predicted() const { return last_predicted_; }

  private:
    void take(bool clock_restarted) {
        for (const auto& line : believed_) store_.add(line.time_s, line.text, line.values);
        while (store_.rows() > 2 * options_.most_rows) store_.thin();
        if (!options_.on_lines || believed_.empty()) return;
        std::string lines;
        for (const auto& line : believed_) fmt::format_to(std::back_inserter(lines), "{} {}\n", line.time_s, line.text);
        options_.on_lines(lines, clock_restarted);
    }

    void restart() {
        ++restarts_;
        sorties_before_ += sorties_kept_;
        sorties_kept_ = 0;
        carried_percent_.reset();
        before_restart_ = std::exchange(in_the_air_, std::nullopt);
        rejected_.clear();
        judged_s_.reset();
        warnings_.clear();
        if (schedule_) schedule_->reset();
    }

    void update_flight(const flight::SelectedTracks& tracks, LiveState& state);
    void look_at_battery_of(const flight::SelectedTracks& tracks, LiveState& state,
                            std::optional<battery::DischargeRecord>& record);
    void predict(const flight::SelectedTracks& tracks, const std::optional<battery::DischargeRecord>& record,
                 LiveState& state);
    void look_ahead(LiveState& state) const;
    void decide(LiveState& state);
    void continue_after_restart(const flight::SelectedTracks& tracks, LiveState& state);
    void check_record(const flight::SelectedTracks& tracks, const LiveState& state);
    void trim(const std::optional<battery::DischargeRecord>& record, const LiveState& state);

    LiveOptions options_;
    std::optional<PredictionInput> basis_;
    std::unique_ptr<LiveSchedule> schedule_;
    TelemetryStore store_;
    SenderClocks clocks_;
    AircraftSelector choice_;
    std::optional<path::PathTracker> places_;  ///< where the path is to go on from
    std::vector<ClockFilter::Line> believed_;  ///< of the last message: its memory is used again
    std::size_t messages_ = 0;
    std::size_t restarts_ = 0;
    std::size_t sorties_before_ = 0;  ///< those that are not kept any more
    std::size_t sorties_kept_ = 0;
    std::size_t deciding_for_ = 0;  ///< the sortie that the schedule has seen
    std::optional<double> carried_percent_;
    std::optional<CarriedFlight> in_the_air_;      ///< at the last update
    std::optional<CarriedFlight> before_restart_;  ///< of the flight that goes on
    std::string rejected_;                         ///< why the power record is; empty if it is not
    std::optional<double> judged_s_;
    std::optional<double> looked_s_;
    bool ended_ = false;
    std::vector<std::string> warnings_;
    std::vector<std::string> battery_warnings_;  ///< of its file
    flight::FlightPhases phases_;
    std::string not_segmented_;  ///< why; empty if it is
    std::optional<LiveState> last_predicted_;
};

LiveState LiveFlight::Impl::look(double silent_s) {
    LiveState state;
    state.messages = messages_;
    state.restarts = restarts_;
    auto series = choice_.choose(store_);
    clocks_.follow(series.aircraft_id);
    state.time_s = clocks_.latest_s();
    state.time_since_message_s = silent_s + clocks_.silent_s();
    // What is known at the moment of the last power or altitude, as it is cut by predict.
    if (const double now_s = mechanical::last_time_s(series); std::isfinite(now_s))
        series = truncate_series(std::move(series), now_s);
    const flight::SelectedTracks tracks(series);
    state.aircraft_id = series.aircraft_id;
    state.aircraft_name = series.aircraft_name;
    state.other_senders = choice_.others();
    std::optional<battery::DischargeRecord> record;
    update_flight(tracks, state);
    look_at_battery_of(tracks, state, record);
    continue_after_restart(tracks, state);
    check_record(tracks, state);
    predict(tracks, record, state);
    try {
        look_ahead(state);
    } catch (const std::exception& error) {
        state.warnings.emplace_back(error.what());
    }
    decide(state);
    state.warnings.insert(state.warnings.begin(), warnings_.begin(), warnings_.end());
    state.warnings.insert(state.warnings.begin(), battery_warnings_.begin(), battery_warnings_.end());
    state.unusable = store_.skipped();
    if (clocks_.unconfirmed() > 0) state.unusable["a time that no other line confirms"] = clocks_.unconfirmed();
    if (const auto steps = clocks_.steps_back(); steps > 0)
        state.warnings.push_back(
            fmt::format("the clock of the telemetry went back {} time{}", steps, steps == 1 ? "" : "s"));
    if (const double set_s = clocks_.set_ahead_s(); set_s > 0.0)
        state.warnings.push_back(fmt::format(
            "the clock of the telemetry was set ahead by {:.0f} s: as seen by the arrival of its lines", set_s));
    for (const auto& [message, stride] : store_.thinned())
        state.warnings.push_back(fmt::format("of {} every {}th row is kept", message, stride));
    state.alarms = alarms_of(state, basis_, options_.silence_threshold_s);
    trim(record, state);
    state.rows = store_.rows();
    if (state.prediction) last_predicted_ = state;
    if (!rejected_.empty()) last_predicted_.reset();
    in_the_air_ = state.phase ? std::optional(carried_flight(state, tracks)) : std::nullopt;
    return state;
}

void LiveFlight::Impl::update_flight(const flight::SelectedTracks& tracks, LiveState& state) {
    phases_ = {};
    not_segmented_.clear();
    try {
        if (!tracks["altitude_m"].empty()) phases_ = segment(tracks);
    } catch (const std::exception& error) {
        not_segmented_ = error.what();
        state.no_prediction_reason = without_flight_name(not_segmented_, tracks.series().flight);
    }
    sorties_kept_ = phases_.sorties.size();
    state.sortie = sorties_before_ + sorties_kept_;
    state.power_w = last_of(tracks, "power_w");
    state.voltage_v = last_of(tracks, "voltage_v");
    state.current_a = last_of(tracks, "current_a");
    state.altitude_m = last_of(tracks, "altitude_m");
    if (phases_.sorties.empty()) return;
    choice_.keep(store_);
    const auto& sortie = phases_.sorties.back();
    const double now_s = mechanical::last_time_s(tracks.series());
    update_flight_times(sortie, tracks["altitude_m"], now_s,
                        ended_ || state.time_since_message_s >= options_.silence_threshold_s, state);
    if (!state.power_w) return;
    state.energy_wh = integrated_energy_wh(tracks["power_w"], sortie.start_s(), state.landed ? sortie.end_s() : now_s);
}

void LiveFlight::Impl::look_at_battery_of(const flight::SelectedTracks& tracks, LiveState& state,
                                          std::optional<battery::DischargeRecord>& record) {
    if (!basis_ || !basis_->battery) return;
    state.battery = estimate_soc(*basis_, carried_percent_, tracks, record);
    if (state.began_in_air && !record) estimate_soc_from_counter(*basis_, tracks.series(), *state.battery);
}

void LiveFlight::Impl::predict(const flight::SelectedTracks& tracks,
                               const std::optional<battery::DischargeRecord>& record, LiveState& state) {
    if (!basis_) {
        state.no_prediction_reason = "a model: give --model or --mission";
        return;
    }
    if (!basis_->no_prediction_reason.empty()) {
        state.no_prediction_reason = basis_->no_prediction_reason;
        return;
    }
    const double now_s = mechanical::last_time_s(tracks.series());
    if (!rejected_.empty()) {
        state.no_prediction_reason = "a power record that can be trusted: " + rejected_;
        return;
    }
    if (state.landed) {
        state.no_prediction_reason = fmt::format("at {:.1f} s of the log the aircraft has landed", now_s);
        return;
    }
    if (!state.power_w) {
        const auto why = no_power_reason(tracks.series());
        state.no_prediction_reason = why.empty() ? "telemetry that tells of power" : "measured power: " + why;
        return;
    }
    if (!state.no_prediction_reason.empty()) return;  // it cannot be segmented
    Diagnostics remarks;
    try {
        if (state.began_in_air) {
            state.prediction = predict_airborne_start(*basis_, tracks.series(), phases_.sorties.back(),
                                                      state.battery ? &*state.battery : nullptr,
                                                      places_ ? &*places_ : nullptr, remarks);
            state.expected_power_w = remaining_power(*state.prediction).front().power_w;
            state.warnings.insert(state.warnings.end(), remarks.warnings.begin(), remarks.warnings.end());
            return;
        }
        const auto* sortie = phases_.sorties.empty() ? nullptr : &phases_.sorties.back();
        const auto flown = mechanical::progress_of(tracks, sortie, now_s);
        state.expected_power_w = units::joule_from_wh(flown.cruise_energy_wh) / flown.cruise_s();
        std::optional<path::PathFix> sighting;
        if (places_) sighting = places_->find(tracks, flown.cruise_start_s, flown.until_s);
        auto energy = predict_energy(*basis_, flown, sighting, remarks);
        if (record && state.battery && state.battery->soc_percent) {
            const auto state_of = [&](const auto& pack) {
                return state_after(pack, *record, state.battery->initial_soc_percent);
            };
            energy.battery = forecast_battery(*basis_->battery, basis_->limits, state_of, energy);
            energy.battery->initial_soc_percent = state.battery->initial_soc_percent;
            energy.battery->initial_is_measured = state.battery->initial_is_from_voltage;
        }
        state.prediction = std::move(energy);
        state.expected_power_w = remaining_power(*state.prediction).front().power_w;
    } catch (const std::exception& error) {
        state.no_prediction_reason = without_flight_name(error.what(), tracks.series().flight);
    }
    state.warnings.insert(state.warnings.end(), remarks.warnings.begin(), remarks.warnings.end());
}

void LiveFlight::Impl::look_ahead(LiveState& state) const {
    if (!state.expected_power_w || !state.battery || !state.battery->state) return;
    const auto& now = *state.battery->state;
    // Where nobody knows for how long the cruise goes on, it does so as it was.
    const double cruise_w =
        state.prediction ? state.prediction->cruise.remaining_mean_w : state.expected_power_w.value();
    const std::vector<battery::ConstantLoad> nothing{{cruise_w, 0.0}};
    state.battery->time_to_reserve_s =
        forecast_landing(*basis_->battery, now, nothing, cruise_w, basis_->limits).endurance_s;
    if (!state.prediction) return;
    const auto& prediction = *state.prediction;
    state.battery->probability_below_reserve = probability_below_reserve(*basis_, prediction, *state.battery);
    if (!basis_->path || basis_->remaining_s || state.phase != flight::Phase::cruise) return;
    const double part = prediction.remaining_energy.energy_wh > 0.0
                            ? prediction.interval.high_wh / prediction.remaining_energy.energy_wh
                            : 1.0;
    ReturnFlightInput budget{*basis_->battery, now, basis_->limits, remaining_power(prediction, part), {}, 1.0};
    double planned_j = 0.0;
    double expected_j = 0.0;
    for (const auto& stretch : prediction.remaining_power) planned_j += stretch.power_w * stretch.duration_s;
    if (prediction.landing_s > 0.0) {
        budget.landing = budget.cruise_ahead.back();
        budget.cruise_ahead.pop_back();
    }
    for (const auto& stretch : budget.cruise_ahead) expected_j += stretch.power_w * stretch.duration_s;
    if (planned_j > 0.0) budget.power_factor = expected_j / planned_j;
    state.turn_home = latest_return(*basis_->path, prediction.on_path_s.value(), budget);
}

void LiveFlight::Impl::decide(LiveState& state) {
    if (!schedule_ || state.landed) return;
    if (state.phase && state.sortie != deciding_for_) {
        if (deciding_for_ > 0) schedule_->reset();
        deciding_for_ = state.sortie;
    }
    const auto phase = state.phase.value_or(flight::Phase::takeoff);
    const auto now = state.battery ? state.battery->state : std::nullopt;
    try {
        state.decision = schedule_->at({phase, state.phase ? state.phase_time_s : 0.0}, state.time_s, now);
    } catch (const std::exception& error) {
        state.warnings.push_back(fmt::format("no schedule: {}", error.what()));
    }
}

void LiveFlight::Impl::continue_after_restart(const flight::SelectedTracks& tracks, LiveState& state) {
    if (!before_restart_ || phases_.sorties.empty()) return;
    if (!state.began_in_air || phases_.sorties.size() > 1) {
        before_restart_.reset();  // another flight
        return;
    }
    const double until_s = state.landed ? phases_.sorties.back().end_s() : mechanical::last_time_s(tracks.series());
    continue_flight(*before_restart_, tracks, until_s, basis_ ? basis_->battery : std::nullopt, state);
}

void LiveFlight::Impl::check_record(const flight::SelectedTracks& tracks, const LiveState& state) {
    constexpr double gap_s = 10.0;  // what was written across it is in doubt at once
    if (looked_s_ && std::abs(state.time_s - *looked_s_) > gap_s) judged_s_.reset();
    looked_s_ = state.time_s;
    if (judged_s_ && state.time_s < *judged_s_ + judged_every_s && !state.landed && !ended_) return;
    judged_s_ = state.time_s;
    if (tracks.series().tracks.empty()) return;
    if (!not_segmented_.empty()) {
        warnings_ = {not_segmented_};
        return;
    }
    try {
        auto judgement = assess_flight(tracks, phases_);
        const auto& faults = judgement.power.power_faults;
        rejected_ = faults.empty() ? "" : fmt::format("{}", fmt::join(faults, ", "));
        warnings_ = std::move(judgement.warnings);
    } catch (const std::exception& error) {
        warnings_ = {error.what()};
    }
}

void LiveFlight::Impl::trim(const std::optional<battery::DischargeRecord>& record, const LiveState& state) {
    if (store_.rows() <= options_.most_rows) return;
    const double from_s = retention_start_s(phases_, state);
    if (record && state.battery && state.battery->soc_percent) {
        if (const auto percent = soc_at(*basis_->battery, *record, state.battery->initial_soc_percent, from_s))
            carried_percent_ = percent;
    }
    for (const auto& sortie : phases_.sorties) sorties_before_ += sortie.end_s() < from_s ? 1 : 0;
    store_.drop_before(from_s);
    while (store_.rows() > options_.most_rows) store_.thin();
}

LiveFlight::LiveFlight(LiveOptions options, std::optional<PredictionInput> basis,
                       std::unique_ptr<LiveSchedule> schedule)
    : watch_(std::make_unique<Impl>(std::move(options), std::move(basis), std::move(schedule))) {}

LiveFlight::~LiveFlight() = default;

void LiveFlight::receive(IncomingMessage message, double arrival_s) { watch_->receive(std::move(message), arrival_s); }

std::optional<double> LiveFlight::clock_s() const { return watch_->clock_s(); }

void LiveFlight::end() { watch_->end(); }

LiveState LiveFlight::update(double silent_s) { return watch_->look(silent_s); }

const std::optional<LiveState>& LiveFlight::last_predicted() const { return watch_->last_predicted(); }

}  // namespace flightwatt::live
