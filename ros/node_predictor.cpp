#include "node_predictor.h"

#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <flightwatt/predictor.h>
#include <nlohmann/json.hpp>

namespace flightwatt::ros {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json json_of(const live::LandingPrediction& landing) {
    return {
        {"remaining_s", landing.remaining_s},
        {"landing_s", landing.landing_s},
        {"energy_wh", landing.energy_wh},
        {"energy_wh_interval_95", {{"low", landing.energy_low_wh}, {"high", landing.energy_high_wh}}},
        {"total_energy_wh", landing.total_energy_wh},
        {"expected_power_w", landing.expected_power_w},
        {"soc_percent", json_of(landing.soc_percent)},
        {"worst_soc_percent", json_of(landing.worst_soc_percent)},
        {"voltage_v", json_of(landing.voltage_v)},
        {"fails_in_s", json_of(landing.fails_in_s)},
        {"reserve_in_s", json_of(landing.reserve_in_s)},
        {"probability_below_reserve", json_of(landing.chance_below_reserve)},
    };
}

const char* name_of(live::FlightPhase phase) {
    static constexpr std::array names{"ground", "takeoff", "cruise", "landing"};
    return names[static_cast<std::size_t>(phase)];
}

std::string prediction_json(const live::PredictorState& now, double start_s) {
    Json json{
        {"format", 1},
        {"time_s", start_s + now.time_s},
        {"phase", name_of(now.phase)},
        {"landed", now.landed},
        {"began_in_air", now.began_in_air},
        {"flight_time_s", now.flight_s},
        {"energy_wh", json_of(now.energy_wh)},
        {"power_w", json_of(now.power_w)},
        {"voltage_v", json_of(now.voltage_v)},
        {"altitude_m", json_of(now.altitude_m)},
        {"soc_percent", json_of(now.soc_percent)},
        {"landing", now.landing ? json_of(*now.landing) : Json(nullptr)},
        {"no_prediction_reason", now.waits_for},
        {"alarms", Json::array()},
        {"dropped", now.dropped},
    };
    for (const auto& alarm : now.alarms)
        json["alarms"].push_back(
            {{"kind", alarm.kind}, {"grade", alarm.grade}, {"text", alarm.text}, {"action", alarm.action}});
    return json.dump();
}

std::string decision_json(const live::PredictorState& now, double start_s) {
    auto run = Json::object();
    for (const auto& component : now.components)
        if (component.runs) run[component.name] = component.quality;
    const Json json{
        {"format", 1},
        {"time_s", start_s + now.time_s},
        {"run", run},
        {"utility_per_s", now.decision->utility_per_s},
        {"next_in_s", json_of(now.decision->next_in_s)},
        {"remaining_utility_per_s", json_of(now.decision->rest_utility)},
        {"keeps_reserve", now.decision->keeps_reserve},
        {"changes", now.decision->changes},
    };
    return json.dump();
}

/// Times of ROS are those since 1970, the predictor's those since the first message.
class SamplePredictor : public NodePredictor {
  public:
    explicit SamplePredictor(std::unique_ptr<live::Predictor> predictor) : predictor_(std::move(predictor)) {}

    /// A sample comes with each reading of one of the batteries.
    bool push(double time_s, const BatteryReading& battery) override {
        constexpr std::size_t max_batteries = 16;
        if (batteries_.size() == max_batteries && !batteries_.contains(battery.location)) return false;
        auto& known = batteries_[battery.location];
        if (std::isnan(known.first_charge_ah)) known.first_charge_ah = battery.charge_ah;
        known.time_s = time_s;
        known.current_a = -battery.current_a;
        known.drawn_ah = known.first_charge_ah - battery.charge_ah;
        const auto is_silent = [&](const Battery& of) { return !(std::abs(time_s - of.time_s) <= silent_s); };
        const auto leading = batteries_.find(leading_);
        if (leading == batteries_.end() || is_silent(leading->second)) leading_ = battery.location;
        if (battery.location != leading_) return true;
        live::Sample sample;
        sample.voltage_v = battery.voltage_v;
        sample.current_a = sample.charge_ah = 0.0;
        for (const auto& [location, of] : batteries_) {
            sample.charge_ah += of.drawn_ah;
            if (!is_silent(of)) sample.current_a += of.current_a;
        }
        return push(time_s, sample);
    }

    bool push(double time_s, const PoseReading& pose) override {
        live::Sample sample;
        sample.altitude_m = pose.altitude_m;
        if (pose.x != 0.0 || pose.y != 0.0 || pose.z != 0.0 || pose.w != 0.0) {
            const double bank_rad =
                std::atan2(2.0 * (pose.w * pose.x + pose.y * pose.z), 1.0 - 2.0 * (pose.x * pose.x + pose.y * pose.y));
            sample.bank_deg = bank_rad * units::degree_per_rad;
        }
        return push(time_s, sample);
    }

    std::optional<NodeTexts> look(double now_s) override {
        if (!start_s_) return std::nullopt;
        const auto& now = predictor_->update(std::max(0.0, now_s - latest_s_));
        NodeTexts texts{prediction_json(now, *start_s_), {}};
        if (now.decision) texts.decision = decision_json(now, *start_s_);
        return texts;
    }

  private:
    struct Battery {
        double time_s = live::Sample::unknown;  ///< of its last reading
        double current_a = 0.0;                 ///< out of it
        double first_charge_ah = live::Sample::unknown;
        double drawn_ah = 0.0;
    };
    static constexpr double silent_s = 10.0;  ///< its last current counts no longer

    bool push(double time_s, live::Sample& sample) {
        if (!start_s_) start_s_ = time_s;
        latest_s_ = time_s;
        sample.time_s = time_s - *start_s_;
        return predictor_->push_sample(sample);
    }

    std::unique_ptr<live::Predictor> predictor_;
    std::optional<double> start_s_;
    double latest_s_ = 0.0;
    std::map<std::string, Battery> batteries_;  ///< by location
    std::string leading_;                       ///< the battery whose readings make samples
};

}  // namespace

MadeNodePredictor make_node_predictor(const Settings& settings) {
    live::PredictorSetup setup;
    setup.input = live::PredictorInput::samples;
    setup.mission_file = settings.mission_file;
    setup.model_file = settings.model_file;
    setup.battery_file = settings.battery_file;
    setup.remaining_s = settings.remaining_s;
    setup.initial_soc_percent = settings.initial_soc_percent;
    setup.replan = settings.decides;
    auto made = live::make_predictor(setup);
    if (!made.predictor) return {nullptr, made.error};
    return {std::make_unique<SamplePredictor>(std::move(made.predictor)), {}};
}

}  // namespace flightwatt::ros
