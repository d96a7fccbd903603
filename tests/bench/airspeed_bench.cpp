// Airspeed and wind of wings without a sensor (flight/select/airspeed.h), as tables for studies/airspeed. Without
// files: made-up flights. With logs of one aircraft: its flights with their sensor hidden, and without what the log
// states of the wind, against the sensor.
// usage: airspeed_bench [--flights N] [LOG...]: 100 made-up flights a row

#include "base/number.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/load_flight.h"
#include "flight/select.h"
#include "mechanical/measured_flight.h"
#include "mechanical/physical_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

namespace {

using namespace flightwatt;
using mechanical::BinnedFlight;
using mechanical::FlightBin;

constexpr double bin_s = 30.0;
constexpr double within_95 = 1.96;

double share_percent(double held, double of) { return of > 0.0 ? units::percentage(held, of) : 0.0; }

double mean_between(const flight::Track& track, double start_s, double end_s) {
    const auto first = std::ranges::lower_bound(track.time_s, start_s) - track.time_s.begin();
    const auto last = std::ranges::upper_bound(track.time_s, end_s) - track.time_s.begin();
    return first == last ? std::nan("")
                         : mean(std::span(track.value)
                                    .subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first)));
}

/// Errors of estimated against true values, and how many 95 % intervals hold them.
struct Errors {
    double squares = 0.0;
    double sum = 0.0;
    double held = 0.0;
    double count = 0.0;

    void add(double error, double sd) {
        squares += error * error;
        sum += error;
        held += std::abs(error) <= within_95 * sd ? 1.0 : 0.0;
        ++count;
    }
    double rms() const { return std::sqrt(squares / count); }
    double bias() const { return sum / count; }
    double held_percent() const { return share_percent(held, count); }
};

/// A made-up wing: circles, or a square of legs, at an airspeed that wanders, in a wind with gusts.
struct MadeUpWing {
    double wind_m_per_s = 0.0;
    bool flies_circles = true;
    double wander_m_per_s = 0.5;
    double duration_s = 600.0;
};

struct MadeUpFlight {
    flight::FlightSeries series;
    flight::Track airspeed;
    double wind_east = 0.0;
    double wind_north = 0.0;
};

/// Values with exponential correlation over 10 s, one a second.
class Wandering {
  public:
    Wandering(double sd, std::mt19937& random) : sd_(sd), random_(random), value_(sd * normal_(random)) {}
    double next() {
        constexpr double kept = 0.9048;
        return value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * sd_ * normal_(random_);
    }

  private:
    double sd_;
    std::mt19937& random_;
    std::normal_distribution<double> normal_;
    double value_;
};

MadeUpFlight fly(const MadeUpWing& wing, unsigned seed) {
    constexpr double gust_part = 0.15;
    constexpr double gps_sd_m_per_s = 0.2;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> any(0.0, 360.0);
    const double from = any(random) / units::degree_per_rad;
    const double first_deg = any(random);
    MadeUpFlight flight;
    flight.wind_east = wing.wind_m_per_s * std::sin(from);
    flight.wind_north = wing.wind_m_per_s * std::cos(from);
    Wandering airspeed(wing.wander_m_per_s, random);
    Wandering gust_east(gust_part * wing.wind_m_per_s, random);
    Wandering gust_north(gust_part * wing.wind_m_per_s, random);
    flight::Track speed{"ground_speed_m_per_s", "GPS.speed"};
    flight::Track course{"course_deg", "GPS.course"};
    for (double t = 0.0; t < wing.duration_s; t += 1.0) {
        constexpr double leg_s = 40.0;
        constexpr double turn_s = 5.0;
        const double in_leg_s = std::fmod(t, leg_s);
        const double legs = std::floor(t / leg_s) + std::max(0.0, (in_leg_s - leg_s + turn_s) / turn_s);
        const double heading_deg = first_deg + (wing.flies_circles ? 9.0 * t : 90.0 * legs);
        const double heading = heading_deg / units::degree_per_rad;
        const double v = 13.0 + airspeed.next();
        const double east =
            v * std::sin(heading) + flight.wind_east + gust_east.next() + gps_sd_m_per_s * normal(random);
        const double north =
            v * std::cos(heading) + flight.wind_north + gust_north.next() + gps_sd_m_per_s * normal(random);
        for (auto* track : {&speed, &course, &flight.airspeed}) track->time_s.push_back(t);
        speed.value.push_back(std::hypot(east, north));
        course.value.push_back(std::fmod(std::atan2(east, north) * units::degree_per_rad + 360.0, 360.0));
        flight.airspeed.value.push_back(v);
    }
    flight.series.firmware = "fixedwing";
    flight.series.tracks = {speed, course};
    return flight;
}

void print_made_up(std::size_t flights) {
    fmt::print(
        "| made-up flights of 10 min | wind, m/s | airspeed wanders by, m/s | estimated | wind RMS error, m/s | "
        "95 % interval holds, % | airspeed of 30 s RMS error, m/s | holds, % |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|\n");
    for (const bool circles : {true, false})
        for (const double wander : {0.5, 1.5})
            for (const double wind : {0.0, 2.0, 4.0, 6.0, 8.0}) {
                Errors of_wind;
                Errors of_airspeed;
                std::size_t estimated = 0;
                for (std::size_t i = 0; i < flights; ++i) {
                    const auto flown = fly({wind, circles, wander}, static_cast<unsigned>(1 + i));
                    const auto data = select_tracks(flown.series);
                    if (!data.airspeed_estimate) continue;
                    ++estimated;
                    const auto& found = data.airspeed_estimate->winds.front();
                    of_wind.add(found.east_m_per_s - flown.wind_east, std::sqrt(found.east_variance));
                    of_wind.add(found.north_m_per_s - flown.wind_north, std::sqrt(found.north_variance));
                    for (double t = 0.0; t + bin_s <= 600.0; t += bin_s)
                        of_airspeed.add(mean_between(data.airspeed_m_per_s, t, t + bin_s) -
                                            mean_between(flown.airspeed, t, t + bin_s),
                                        data.airspeed_estimate->sd_m_per_s);
                }
                fmt::print("| {} | {:.0f} | {:.1f} | {} of {} | {:.2f} | {:.0f} | {:.2f} | {:.0f} |\n",
                           circles ? "circles of 40 s" : "squares of 40 s legs", wind, wander, estimated, flights,
                           of_wind.rms(), of_wind.held_percent(), of_airspeed.rms(), of_airspeed.held_percent());
            }
}

/// A flight with its sensor, and without it.
struct Hidden {
    flight::FlightData seen;
    flight::FlightData hidden;
    BinnedFlight motion_seen;
    BinnedFlight motion_hidden;
    std::array<double, 3> truth;  ///< wind to the east and north by the sensor, and its scale
};

/// Wind and scale of the sensor with |velocity - wind| nearest to scale * airspeed, by Gauss and Newton.
std::array<double, 3> wind_by_sensor(const flight::FlightData& data, double start_s, double end_s) {
    Eigen::Vector3d found(0.0, 0.0, 1.0);
    for (int round = 0; round < 20; ++round) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        const auto& speed = data.ground_speed_m_per_s;
        for (std::size_t i = 0; i < speed.time_s.size(); ++i) {
            const double t = speed.time_s[i];
            if (t < start_s || t > end_s) continue;
            const double course = state_at(data.course_deg, t) / units::degree_per_rad;
            const Eigen::Vector2d air =
                speed.value[i] * Eigen::Vector2d(std::sin(course), std::cos(course)) - found.head<2>();
            const double measured = value_at(data.airspeed_m_per_s, t);
            const double off = air.norm() - found[2] * measured;
            Eigen::Vector3d slope;
            slope << -air.normalized(), -measured;
            const double weight = 1.0 / (1.0 + off * off);
            normal += weight * slope * slope.transpose();
            right -= weight * off * slope;
        }
        found += normal.ldlt().solve(right);
    }
    return {found[0], found[1], found[2]};
}

Hidden hide_sensor(const char* log, double width_s) {
    const auto loaded = flight::load_flight(log);
    auto series = loaded.series;
    std::erase_if(series.tracks, [](const flight::Track& track) {
        return track.name == "airspeed_m_per_s" || track.name.starts_with("wind_");
    });
    series.firmware = "fixedwing";
    Hidden flight{loaded.data, select_tracks(series), {}, {}, {}};
    const auto& sortie = loaded.phases.sorties.at(0);
    flight.motion_seen = mechanical::bin_flight(flight.seen, mechanical::phase_spans(sortie), width_s);
    flight.motion_hidden = mechanical::bin_flight(flight.hidden, mechanical::phase_spans(sortie), width_s);
    const auto& phases = sortie.phases;
    flight.truth = wind_by_sensor(flight.seen, phases.front().start.time_s, phases.back().end.time_s);
    return flight;
}

/// The airspeed of both in means over 30 s of the flight; the wind in the mean of its parts.
void print_airspeed(const Hidden& flight) {
    const auto& estimate = flight.hidden.airspeed_estimate;
    if (!estimate) {
        fmt::print("| {} | not estimated: {} | | | | | |\n", flight.seen.flight,
                   flight.hidden.airspeed_m_per_s.not_chosen.front());
        return;
    }
    double east = 0.0;
    double north = 0.0;
    double variance = 0.0;
    for (const auto& wind : estimate->winds) {
        east += wind.east_m_per_s / static_cast<double>(estimate->winds.size());
        north += wind.north_m_per_s / static_cast<double>(estimate->winds.size());
        variance += 0.5 * (wind.east_variance + wind.north_variance) / std::pow(estimate->winds.size(), 2);
    }
    Errors raw;
    Errors scaled;
    const auto& bins = flight.motion_hidden.bins;
    for (double t = bins.front().start_s; t + bin_s < bins.back().start_s; t += bin_s) {
        const double estimated = mean_between(flight.hidden.airspeed_m_per_s, t, t + bin_s);
        const double measured = mean_between(flight.seen.airspeed_m_per_s, t, t + bin_s);
        if (std::isnan(estimated) || std::isnan(measured)) continue;
        raw.add(estimated - measured, estimate->sd_m_per_s);
        scaled.add(estimated - flight.truth[2] * measured, estimate->sd_m_per_s);
    }
    fmt::print("| {} | {:.1f} | {:.1f} ({:.1f}) | {:+.1f} | {:.1f}, {:.0f} | {:.2f} | {:.1f}, {:.0f} |\n",
               flight.seen.flight, std::hypot(flight.truth[0], flight.truth[1]),
               std::hypot(east - flight.truth[0], north - flight.truth[1]), std::sqrt(2.0 * variance), raw.bias(),
               raw.rms(), raw.held_percent(), flight.truth[2], scaled.rms(), scaled.held_percent());
}

/// Error of the energy of bins [%], error of a bin [% of the mean power] and how many 95 % intervals hold the bins.
std::string predicted(std::span<const BinnedFlight> flown, std::span<const FlightBin> ahead) {
    const auto model = mechanical::fit_physical_model(flown).model;
    double energy = 0.0;
    double error = 0.0;
    double seconds = 0.0;
    Errors bins;
    for (const auto& bin : ahead) {
        const auto power = predicted_power(model, bin.values, bin.duration_s);
        energy += bin.power_w * bin.duration_s;
        error += (power.mean_w - bin.power_w) * bin.duration_s;
        seconds += bin.duration_s;
        const double half = power.sd_w ? student_t_half_width(power.degrees_of_freedom) * *power.sd_w / within_95 : 0.0;
        bins.add(power.mean_w - bin.power_w, half);
    }
    return fmt::format("{:+.1f} | {:.0f} | {}", units::percentage(error, energy),
                       units::percentage(bins.rms(), energy / seconds),
                       model.level_sd ? fmt::format("{:.0f}", bins.held_percent()) : "-");
}

/// The power of the second half by a model of the first; of several flights, of each by a model of the others.
void print_power(std::span<const Hidden> flights) {
    for (const bool hidden : {false, true}) {
        for (std::size_t out = 0; out < flights.size(); ++out) {
            std::vector<BinnedFlight> flown;
            std::vector<FlightBin> ahead;
            for (std::size_t i = 0; i < flights.size(); ++i) {
                auto motion = hidden ? flights[i].motion_hidden : flights[i].motion_seen;
                if (i == out) ahead = motion.bins;
                if (i == out && flights.size() > 1) continue;
                if (i == out) {
                    const auto half = std::ssize(motion.bins) / 2;
                    ahead.erase(ahead.begin(), ahead.begin() + half);
                    motion.bins.resize(static_cast<std::size_t>(half));
                }
                flown.push_back(std::move(motion));
            }
            fmt::print("| {} | {} | {} |", flights[out].seen.flight,
                       flights.size() > 1 ? "the other flights" : "its first half", hidden ? "hidden" : "measured");
            try {
                fmt::print(" {} |\n", predicted(flown, ahead));
            } catch (const std::exception& error) {
                fmt::print(" {} | | |\n", error.what());
            }
        }
    }
}

void print_real(std::span<char*> logs) {
    std::vector<Hidden> flights;
    constexpr double short_bin_s = 10.0;  // as half of a flight has few long ones
    for (const char* log : logs) flights.push_back(hide_sensor(log, logs.size() > 1 ? bin_s : short_bin_s));
    fmt::print(
        "| flight, sensor hidden | wind, m/s | wind's error (1 sd stated), m/s | mean of estimated less measured "
        "airspeed, m/s | RMS of 30 s, m/s, and interval holds, % | scale of the sensor | the same with this "
        "scale |\n|---|---:|---:|---:|---:|---:|---:|\n");
    for (const auto& flight : flights) print_airspeed(flight);
    fmt::print(
        "\n| power of | predicted by | airspeed | energy error, % | RMS of bins, % | 95 % interval holds, % "
        "|\n|---|---|---|---:|---:|---:|\n");
    print_power(flights);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        std::span arguments(argv + 1, static_cast<std::size_t>(argc - 1));
        std::size_t flights = 100;
        if (arguments.size() > 1 && std::string_view(arguments[0]) == "--flights") {
            flights = static_cast<std::size_t>(parse_number(arguments[1]).value());
            arguments = arguments.subspan(2);
        }
        if (arguments.empty())
            print_made_up(flights);
        else
            print_real(arguments);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "airspeed_bench: {}\n", error.what());
        return 1;
    }
}
