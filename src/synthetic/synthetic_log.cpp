#include "synthetic/synthetic_log.h"

#include "base/units.h"
#include "flight/telemetry_series.h"
#include "synthetic/paparazzi/log_writer.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::synthetic {
namespace {

constexpr double tick_s = 0.05;
constexpr auto aircraft_id = "7";

/// Solves P = V I with V = U - R I.
double current_of_power_a(double power_w, double rest_v, double resistance_ohm) {
    return 2.0 * power_w / (rest_v + std::sqrt(rest_v * rest_v - 4.0 * resistance_ohm * power_w));
}

/// Sensors and counters over the flight.
class Simulation {
  public:
    Simulation(const SyntheticSensors& sensors, std::mt19937_64& random) : sensors_(sensors), random_(random) {}

    SensorReadings step(const SyntheticFlight& flight, double time_s) {
        SensorReadings moment;
        moment.time_s = time_s;
        moment.state = state_at(flight, time_s);
        const double rest_v = 12.5 - 1.4 * charge_ah_ / sensors_.pack_capacity_ah;  // typical of three cells
        const double current_a = moment.state.power_w > 0.0
                                     ? current_of_power_a(moment.state.power_w, rest_v, sensors_.pack_resistance_ohm)
                                     : sensors_.idle_current_a;
        moment.voltage_v = rest_v - sensors_.pack_resistance_ohm * current_a;
        // The charge drawn before this step, which determines the voltage.
        moment.charge_ah = charge_ah_;
        moment.energy_wh = energy_wh_;
        charge_ah_ += current_a * tick_s / units::seconds_per_hour;
        energy_wh_ += current_a * moment.voltage_v * tick_s / units::seconds_per_hour;
        const double noisy_a = current_a + sensors_.current_noise_a * normal_(random_);
        moment.current_a = std::round(noisy_a / sensors_.current_step_a) * sensors_.current_step_a;
        moment.altitude_m = moment.state.estimated_altitude_m + sensors_.altitude_noise_m * normal_(random_);
        moment.flight_time_s = std::max(0.0, time_s - flight.lift_off_s);
        return moment;
    }

  private:
    const SyntheticSensors& sensors_;
    std::mt19937_64& random_;
    std::normal_distribution<double> normal_{0.0, 1.0};
    double charge_ah_ = 0.0;
    double energy_wh_ = 0.0;
};

/// Loses single lines, and while the aircraft is far off all lines of some seconds.
class LossyLink {
  public:
    LossyLink(double lost_fraction, std::mt19937_64& random) : lost_fraction_(lost_fraction), random_(random) {
        next_burst_s_ = mean_pause_s() * exponential_(random_);
    }

    bool loses(double time_s, bool far_off) {
        if (time_s >= next_burst_s_) {
            burst_end_s_ = time_s + mean_burst_s * exponential_(random_);
            next_burst_s_ = burst_end_s_ + mean_pause_s() * exponential_(random_);
        }
        return (far_off && time_s < burst_end_s_) || uniform_(random_) < lost_fraction_ / 2.0;
    }

  private:
    static constexpr double mean_burst_s = 2.5;
    double mean_pause_s() const { return mean_burst_s / std::max(lost_fraction_ / 2.0, 1e-9); }

    double lost_fraction_;
    std::mt19937_64& random_;
    std::exponential_distribution<double> exponential_{1.0};
    std::uniform_real_distribution<double> uniform_{0.0, 1.0};
    double next_burst_s_ = 0.0;
    double burst_end_s_ = 0.0;
};

std::string log_text(const SyntheticFlight& flight, const std::vector<PeriodicMessage>& reports,
                     const std::string& name, const std::string& comment) {
    telemetry::AircraftConfiguration aircraft{aircraft_id, "Opterra_synthetic", flight.ground_altitude_m, {}};
    aircraft.block_names = {{0, "Wait GPS"}, {1, "Geo init"}, {2, "Holding point"},   {3, "Takeoff"},
                            {4, "Standby"},  {5, "Survey"},   {6, "Land Right AF-TD"}};
    aircraft.current_origin = telemetry::CurrentOrigin::sensor;
    std::vector<telemetry::MessageDefinition> messages;
    messages.reserve(reports.size() + 2);
    for (const auto& report : reports) messages.push_back(report.definition);
    messages.push_back({"TAKEOFF", {{"cpu_time", "uint16", "s", "", {}}}, ".log"});
    messages.push_back({"INFO_MSG", {{"msg", "char[]", "", "", {}}}, ".log"});
    return to_log_xml(comment, name + ".data", aircraft, messages);
}

std::vector<PeriodicMessage> reports_of(const SyntheticSensors& sensors) {
    auto reports = periodic_messages();
    if (sensors.sends_other_messages) return reports;
    const auto required = flight::flight_messages();
    std::erase_if(reports, [&](const PeriodicMessage& report) {
        const auto& name = report.definition.name;
        return name == "COMMANDS" ||  // ENERGY contains the throttle
               std::ranges::find(required, name, &telemetry::MessageRequest::message) == required.end();
    });
    return reports;
}

}  // namespace

SyntheticLog make_synthetic_log(const SyntheticScenario& scenario, const SyntheticSensors& sensors,
                                const std::string& name, const std::string& made_by, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto reports = reports_of(sensors);
    Simulation simulation(sensors, random);
    LossyLink link(sensors.lost_fraction, random);
    std::vector<double> due_s;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        due_s.push_back(scenario.begin_s + tick_s * static_cast<double>(i));
    }
    SyntheticLog log;
    const auto mark = "SYNTHETIC: no aircraft flew this. " + made_by;
    log.data = data_line(scenario.begin_s, "ground", "INFO_MSG", {'"' + mark + '"'});
    std::size_t current = 0;
    bool takeoff_sent = false;  // of the current flight
    const auto ticks = static_cast<std::size_t>(scenario.end_s / tick_s);
    for (std::size_t tick = 0; tick <= ticks; ++tick) {
        const double time_s = static_cast<double>(tick) * tick_s;
        if (time_s > scenario.flights[current].log_end_s() && current + 1 < scenario.flights.size()) {
            ++current;
            takeoff_sent = false;
        }
        const auto& flight = scenario.flights[current];
        const auto moment = simulation.step(flight, time_s);  // the counters also count before the log begins
        if (!takeoff_sent && moment.state.airborne) {
            if (time_s >= scenario.begin_s)
                log.data +=
                    data_line(time_s, aircraft_id, "TAKEOFF", {fmt::format("{:.0f}", time_s - scenario.begin_s)});
            takeoff_sent = true;
        }
        const bool far_off = time_s > flight.start_s(flight::Phase::cruise) + 10.0 &&
                             time_s < flight.end_s(flight::Phase::cruise) - 10.0;
        for (std::size_t i = 0; i < reports.size(); ++i) {
            if (time_s + 1e-9 < due_s[i]) continue;
            due_s[i] += reports[i].period_s;
            if (link.loses(time_s, far_off)) continue;
            log.data += data_line(time_s, aircraft_id, reports[i].definition.name, reports[i].fields(moment));
        }
    }
    log.log = log_text(scenario.flights.front(), reports, name, " " + mark + " ");
    return log;
}

}  // namespace flightwatt::synthetic
