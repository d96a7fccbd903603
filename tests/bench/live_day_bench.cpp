// A day of made-up telemetry through the live watch: how long a look takes, how much memory it needs.
//   live_day_bench MISSION.toml [HOURS [LOOK_EVERY_S [--replan]]]
// Ten messages a second: 40 minutes on the ground, 30 in the air, again and again; lost and doubled messages, gaps of
// 22 s, another aircraft; where the mission has a path, positions along it, 20 m to its side. Times are of the
// processor; every 30 s a look judges the whole record, and with --replan one a slot plans.

#include "live/live_flight.h"
#include "live/prediction.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "path/remaining_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

double processor_ms() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

double resident_mb() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kilobytes = 0.0;
        if (word == "VmRSS:" && status >> kilobytes) return kilobytes / 1024.0;
    }
    return 0.0;
}

constexpr double ground_s = 2400.0;
constexpr double flight_s = 1800.0;
constexpr double climb_s = 40.0;
constexpr double height_m = 80.0;

/// How high it is, as a part of its height.
double height_part(double in_air_s) { return std::clamp(std::min(in_air_s, flight_s - in_air_s) / climb_s, 0.0, 1.0); }

/// The messages of a tenth of a second.
class MadeUpDay {
  public:
    /// `path`: none, or what is flown.
    explicit MadeUpDay(const path::PathForecast* path) : path_(path) {}

    std::vector<std::string> at(long tick) {
        const double time_s = 0.1 * static_cast<double>(tick);
        const double in_air_s = std::fmod(time_s, ground_s + flight_s) - ground_s;
        const bool flies = in_air_s > 0.0;
        if (!flies && in_air_s + ground_s < 0.05) charge_ah_ = energy_wh_ = 0.0;  // another pack, and a reboot
        const double part = flies ? height_part(in_air_s) : 0.0;
        const double power_w = flies ? (in_air_s < climb_s ? 45.0 : 22.0) + noise_(random_) : 0.4;
        const double voltage_v = 12.5 - 0.9 * std::max(0.0, in_air_s) / flight_s - 0.02 * power_w / 12.0;
        energy_wh_ += power_w / 36000.0;
        charge_ah_ += power_w / voltage_v / 36000.0;
        const double throttle = flies ? 55.0 : 0.0;
        std::vector<std::string> messages;
        switch (tick % 10) {
            case 0:
                messages.push_back(fmt::format("7 ENERGY {} {:.3f} {:.3f} {:.3f} {:.5f} {:.5f}", throttle, voltage_v,
                                               power_w / voltage_v, power_w, charge_ah_, energy_wh_));
                break;
            case 3:
                messages.push_back(
                    fmt::format("7 ESTIMATOR {:.2f} 0", 180.0 + height_m * part + 0.1 * noise_(random_)));
                break;
            case 1:
            case 6:
                if (path_ != nullptr) messages.push_back(position_message(in_air_s));
                break;
            case 5:
                messages.push_back(
                    fmt::format("7 AIR_DATA 101325 0 20 0 180 {:.2f}", flies ? 13.0 + 0.3 * noise_(random_) : 0.0));
                break;
            case 8:
                messages.emplace_back("99 ENERGY 0 12 0 0 0 0");
                break;
            default:
                messages.push_back(fmt::format("7 ATTITUDE {:.3f} 1.5 0.1", 0.1 * noise_(random_)));
        }
        const auto draw = random_() % 100;
        if (draw < 5 || std::fmod(time_s, 600.0) < 22.0) messages.clear();
        if (draw > 97 && !messages.empty()) messages.push_back(messages.back());
        return messages;
    }

  private:
    std::string position_message(double in_air_s) {
        const double on_path_s = std::clamp(in_air_s - climb_s, 0.0, path_->flown().duration_s);
        const auto at = local_position_at(path_->plan().path, position_at(path_->flown(), on_path_s));
        const double side_m = on_path_s > 0.0 ? 20.0 : 0.0;
        return fmt::format("7 NAVIGATION 0 0 {:.1f} {:.1f} 0 0 0 0", at.east_m + side_m + 4.0 * noise_(random_),
                           at.north_m + side_m + 4.0 * noise_(random_));
    }

    const path::PathForecast* path_;
    std::mt19937 random_{1};
    std::normal_distribution<double> noise_{0.0, 1.0};
    double charge_ah_ = 0.0;
    double energy_wh_ = 0.0;
};

struct Times {
    std::vector<double> ms;
    void print(const char* name) {
        if (ms.empty()) return;
        std::ranges::sort(ms);
        std::printf("%-28s %zu, mean %.2f, p99 %.2f, most %.2f ms\n", name, ms.size(),
                    std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size()),
                    ms[ms.size() * 99 / 100], ms.back());
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    const double hours = argc > 2 ? std::atof(argv[2]) : 24.0;
    const long every = argc > 3 ? std::max(1L, std::atol(argv[3])) : 1;
    const bool decides = argc > 4;
    mission::MissionReadOptions reading;
    reading.allow_unplanned = true;
    const auto mission = mission::read_mission(argv[1], reading);
    const auto& setup = setup_of(mission);
    const auto basis = live::input_from_mission(setup, argv[1]);
    live::LiveFlight flight({}, basis, std::make_unique<live::LiveSchedule>(mission, decides));
    MadeUpDay day(basis.path.get());
    Times predicting;
    Times others;
    std::size_t sighted = 0;
    std::size_t changes = 0;
    std::size_t most_rows = 0;
    for (long tick = 0; tick < static_cast<long>(hours * 36000.0); ++tick) {
        for (const auto& text : day.at(tick)) flight.receive({0.1 * static_cast<double>(tick), text}, 0.0);
        if (tick % (10 * every) == 0) {
            const double start_ms = processor_ms();
            const auto state = flight.update();
            const double took_ms = processor_ms() - start_ms;
            (state.prediction ? predicting : others).ms.push_back(took_ms);
            sighted += state.prediction && state.prediction->is_from_position ? 1 : 0;
            changes = state.decision ? state.decision->changes : changes;
            most_rows = std::max(most_rows, state.rows);
        }
        if (tick % 72000 == 0)
            std::printf("%5.1f h  %.1f MB resident\n", static_cast<double>(tick) / 36000.0, resident_mb());
    }
    predicting.print("looks with a prediction");
    others.print("looks without");
    std::printf("%-28s %zu\n", "looks that tell the place", sighted);
    std::printf("most rows %zu, changes of what runs %zu, %.1f MB resident\n", most_rows, changes, resident_mb());
    return 0;
}
