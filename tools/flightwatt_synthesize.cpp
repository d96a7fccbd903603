// flightwatt synthesize: synthetic Paparazzi logs of flights after a mechanical model.

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/duration_text.h"
#include "base/error.h"
#include "base/overwrite_guard.h"
#include "cli/stage.h"
#include "mechanical/mechanical_model.h"
#include "stages.h"
#include "synthetic/flight_spread.h"
#include "synthetic/synthetic_flight.h"
#include "synthetic/synthetic_log.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

synthetic::SyntheticFlight make_flight(const flight::PerPhase<mechanical::PhaseModel>& phases,
                                       std::mt19937_64& random) {
    synthetic::SyntheticFlight flight;
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    flight.motor_run_up_s = between(22.0, 30.0);
    flight.lift_off_s = flight.motor_run_up_s + between(25.0, 40.0);
    flight.ground_after_s = between(25.0, 45.0);
    flight.height_m = between(80.0, 100.0);
    flight.circle_radius_m = between(70.0, 90.0);
    flight.airspeed_m_per_s = between(12.0, 14.0);
    flight.wind_east_m_per_s = between(-3.0, 3.0);
    flight.wind_north_m_per_s = between(-3.0, 3.0);
    for (const auto phase : flight::all_phases) flight.duration_s[phase] = phases[phase].duration_s;
    flight.power_w = [phases](flight::Phase phase, double tau) {
        return std::max(0.0, power_w(phases[phase].fourier, tau * phases[phase].duration_s));
    };
    return flight;
}

/// The phases that the log shows, cut where it begins and ends.
std::string truth_csv(const synthetic::SyntheticScenario& scenario) {
    CsvWriter csv({"sortie", "phase", "start_s", "end_s", "complete"});
    for (std::size_t s = 0; s < scenario.flights.size(); ++s) {
        const auto& flight = scenario.flights[s];
        for (const auto phase : flight::all_phases) {
            const double start_s = std::max(flight.start_s(phase), scenario.begin_s);
            const double end_s = std::min(flight.end_s(phase), scenario.end_s);
            if (end_s <= start_s) continue;
            const bool complete = start_s == flight.start_s(phase) && end_s == flight.end_s(phase);
            csv.add(s + 1, to_string(phase), start_s, end_s, complete);
        }
    }
    return csv.text();
}

/// The hazards asked for: none, one by its name, or all.
std::vector<std::pair<std::string, synthetic::LogAnomaly>> chosen_hazards(const std::string& name) {
    if (name == "none") return {{"", synthetic::LogAnomaly::none}};
    if (name == "all") return synthetic::anomaly_names();
    std::vector<std::string> names{"none", "all"};
    for (const auto& known : synthetic::anomaly_names()) {
        if (known.first == name) return {known};
        names.push_back(known.first);
    }
    throw UsageError(fmt::format("--hazard {}: expected {}", name, fmt::join(names, ", ")));
}

/// What one synthetic log is of, for its names.
struct LogIdentity {
    std::string name;
    std::string made_by;
};

std::string log_name(const std::string& name, std::size_t number, const std::string& hazard) {
    return fmt::format("{}_{:02}{}{}", name, number, hazard.empty() ? "" : "_", hazard);
}

/// Refuses what would replace an input before the first log is written.
template <typename Hazards>
void declare_logs(const cli::StageCall& call, const std::string& name, std::size_t count, const Hazards& hazards) {
    for (std::size_t i = 1; i <= count; ++i) {
        for (const auto& hazard : hazards) {
            const auto stem = (std::filesystem::path(*call.output) / log_name(name, i, hazard.first)).string();
            for (const auto* ending : {".log", ".data", ".truth.csv"}) register_output(stem + ending);
        }
    }
}

/// Writes NAME.log, NAME.data and, if asked for, NAME.truth.csv; returns the log's size in bytes.
std::size_t write_log(const cli::StageCall& call, const synthetic::SyntheticScenario& scenario,
                      const synthetic::SyntheticSensors& sensors, const LogIdentity& identity, std::uint64_t seed) {
    const auto log = make_synthetic_log(scenario, sensors, identity.name, identity.made_by, seed);
    const auto stem = std::filesystem::path(*call.output) / identity.name;
    write_file_atomically(stem.string() + ".log", log.log);
    write_file_atomically(stem.string() + ".data", log.data);
    if (call.has("truth")) write_file_atomically(stem.string() + ".truth.csv", truth_csv(scenario));
    if (!call.json) {
        cli::note(call, fmt::format("{}: synthetic log of {}", stem.string(),
                                    duration_text(scenario.end_s - scenario.begin_s)));
    }
    return log.data.size() + log.log.size();
}

/// Refuses models of which no log could be made: days long, or with power beyond any number.
void require_flyable(const mechanical::MechanicalModel& model, const std::string& file) {
    constexpr double max_phase_s = 1e5;
    constexpr double max_power_w = 1e6;
    for (const auto phase : flight::all_phases) {
        const auto& fourier = model.phases[phase].fourier;
        const double duration_s = model.phases[phase].duration_s;
        double max_w = std::abs(fourier.a0_w);
        for (const double part_w : fourier.cos_w) max_w += std::abs(part_w);
        for (const double part_w : fourier.sin_w) max_w += std::abs(part_w);
        if (duration_s > max_phase_s) {
            throw InputError(
                {file}, fmt::format("{} takes {} s, expected at most {} s", to_string(phase), duration_s, max_phase_s));
        }
        if (!(max_w <= max_power_w)) {
            throw InputError({file}, fmt::format("the coefficients of {} add up to {} W, expected at most {} W",
                                                 to_string(phase), max_w, max_power_w));
        }
    }
}

/// --name, where it can begin the name of a file.
std::string read_name(const cli::StageCall& call) {
    auto name = call.get<std::string>("name");
    if (!name.empty() && name.find('/') == std::string::npos) return name;
    throw UsageError(fmt::format("--name is '{}', expected the beginning of a file name, without '/'", name));
}

/// The model, with another duration of cruise where one is asked for: its curve stretched.
mechanical::MechanicalModel read_model(const cli::StageCall& call) {
    auto model = mechanical::read_mechanical_model(call.inputs.front());
    if (call.has("cruise")) {
        auto& cruise = model.phases[flight::Phase::cruise];
        const double duration_s = cli::number_option(call, "cruise", 60.0, 1e5);
        cruise.fourier = time_scaled_model(cruise, duration_s, mechanical::PhaseTimeScaling::stretched);
        cruise.duration_s = duration_s;
    }
    require_flyable(model, call.inputs.front());
    return model;
}

int synthesize(const cli::StageCall& call) {
    if (!call.output) throw UsageError("no folder given: expected -o FOLDER");
    const auto count = cli::count_option(call, "flights", 1, 1000);
    const auto seed = cli::count_option(call, "seed");
    const auto name = read_name(call);
    synthetic::SpreadOptions spread;
    spread.band_scale = cli::number_option(call, "spread", 0.0, 100.0);  // beyond, hardly a flight has power left
    synthetic::SyntheticSensors sensors;
    sensors.current_noise_a = cli::number_option(call, "current-noise", 0.0, 1000.0);
    sensors.sends_other_messages = !call.has("flight-messages-only");
    const auto hazard_list = chosen_hazards(call.get<std::string>("hazard"));
    const auto model = read_model(call);
    declare_logs(call, name, count, hazard_list);
    make_directories(*call.output);
    const auto flights = draw_flights(model, count, seed, spread);
    cli::Json written = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < count; ++i) {
        std::mt19937_64 random(seed + 1000 * (i + 1));
        const auto flight = make_flight(flights[i], random);
        const auto log_seed = random();
        for (const auto& [hazard_name, hazard] : hazard_list) {
            LogIdentity identity;
            identity.name = log_name(name, i + 1, hazard_name);
            identity.made_by =
                fmt::format("Made by flightwatt synthesize: model {}, flight {} of {}, seed {}{}{}.", model.name, i + 1,
                            count, seed, hazard_name.empty() ? "" : ", hazard ", hazard_name);
            const auto bytes = write_log(call, scenario_with_anomaly(flight, hazard), sensors, identity, log_seed);
            written.push_back({{"flight", identity.name}, {"bytes", bytes}});
        }
    }
    if (call.json) cli::print(cli::json_text({{"flights", written}}));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::synthesize_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "synthesize", "MODEL.toml -o FOLDER",
        R"(Writes synthetic Paparazzi logs (.log and .data) of flights whose power follows a mechanical model, with
sensor noise, lost lines, durations that vary and a spread between flights. The files say that they are
synthetic. The same seed gives the same files.)"};
    stage.max_inputs = 1;
    stage.output_help = "the folder to write into";
    auto add = stage.options.add_options();
    add("flights", cli::value("N")->default_value("6"), "how many");
    add("seed", cli::value("S")->default_value("1"), "seed of everything random");
    add("name", cli::value("NAME")->default_value("opterra_synthetic"), "file names begin with it");
    add("spread", cli::value<double>("X")->default_value(1.0, "1"),
        "flight-to-flight spread, as a multiple of the paper's bands");
    add("current-noise", cli::value<double>("A")->default_value(synthetic::SyntheticSensors{}.current_noise_a, "0.001"),
        "noise of the current sensor, as a standard deviation");
    add("cruise", cli::value<double>("S"), "how long flights cruise, in seconds (the model's)");
    add("flight-messages-only", "leave out the messages that no flight is read from: small logs");
    add("truth", "write the true phases beside each log, as NAME.truth.csv");
    add("hazard", cli::value("NAME")->default_value("none"),
        "something that real logs do and that must not fool the segmentation: estimator-starts-at-zero, "
        "dives-in-cruise, run-up, power-burst-after-landing, throttle-burst-before-touchdown, two-sorties, "
        "begins-in-the-air, ends-in-the-air, landing-in-steps, works-low, or all, a log each");
    return cli::run_stage(argc, argv, stage, synthesize);
}
