// flightwatt synthesize: made-up Paparazzi logs of flights after a mechanical model.

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/stage.h"
#include "flight/synthetic_log.h"
#include "mechanical/flight_spread.h"
#include "mechanical/mechanical_model.h"

#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

using namespace flightwatt;

SyntheticFlight make_flight(const PerPhase<PhaseModel>& phases, std::mt19937_64& random) {
    SyntheticFlight flight;
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
    for (const auto phase : all_phases) flight.duration_s[phase] = phases[phase].duration_s;
    flight.power_w = [phases](Phase phase, double tau) {
        return std::max(0.0, power_w(phases[phase].fourier, tau * phases[phase].duration_s));
    };
    return flight;
}

std::string truth_csv(const SyntheticFlight& flight) {
    std::string text = "phase,start_s,end_s\n";
    for (const auto phase : all_phases) {
        text += fmt::format("{},{},{}\n", to_string(phase), flight.start_s(phase), flight.end_s(phase));
    }
    return text;
}

int synthesize(const cli::StageCall& call) {
    const auto count = call.get<unsigned>("flights");
    const auto seed = call.get<std::uint64_t>("seed");
    const auto spread = call.get<double>("spread");
    if (count == 0) throw UsageError("--flights is 0, expected at least 1");
    if (!call.output) throw UsageError("no folder given: expected -o FOLDER");
    if (!(spread >= 0.0)) throw UsageError(fmt::format("--spread is {}, expected 0 or more", spread));
    SyntheticSensors sensors;
    sensors.current_noise_a = call.get<double>("current-noise");
    if (!(sensors.current_noise_a >= 0.0))
        throw UsageError("--current-noise is negative, expected 0 A or more");
    const auto model = read_mechanical_model(call.inputs.front());
    const std::filesystem::path folder = *call.output;
    make_directories(folder);
    SpreadOptions spread_options;
    spread_options.bands = spread;
    const auto flights = draw_flights(model, count, seed, spread_options);
    nlohmann::ordered_json written = nlohmann::ordered_json::array();
    for (unsigned i = 0; i < count; ++i) {
        const auto name = fmt::format("{}_{:02}", call.get<std::string>("name"), i + 1);
        std::mt19937_64 random(seed + 1000 * (i + 1));
        const auto flight = make_flight(flights[i], random);
        const auto made_by = fmt::format("Made by flightwatt synthesize: model {}, flight {} of {}, seed {}.",
                                         model.name, i + 1, count, seed);
        const auto log = make_synthetic_log(flight, sensors, name, made_by, random());
        write_file_atomically(folder / (name + ".log"), log.log);
        write_file_atomically(folder / (name + ".data"), log.data);
        if (call.has("truth")) write_file_atomically(folder / (name + ".truth.csv"), truth_csv(flight));
        written.push_back({{"flight", name}, {"bytes", log.data.size() + log.log.size()}});
        if (!call.json)
            cli::note(call, fmt::format("{}: synthetic flight of {:.0f} s", (folder / name).string(),
                                        flight.log_end_s()));
    }
    if (call.json) cli::print(nlohmann::ordered_json{{"flights", written}}.dump(2) + "\n");
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    namespace po = boost::program_options;
    cli::StageDefinition stage;
    stage.name = "synthesize";
    stage.arguments = "MODEL.toml -o FOLDER";
    stage.description =
        "Writes made-up Paparazzi logs (.log and .data) of flights whose power follows a mechanical model, "
        "with\n"
        "sensor noise, lost lines, durations that vary and a spread between flights. The files say that they "
        "are\n"
        "synthetic. The same seed gives the same files.";
    stage.max_inputs = 1;
    stage.output_help = "the folder to write into";
    stage.options.add_options()("flights", po::value<unsigned>()->value_name("N")->default_value(6),
                                "how many")(
        "seed", po::value<std::uint64_t>()->value_name("S")->default_value(1), "seed of everything random")(
        "name", po::value<std::string>()->value_name("NAME")->default_value("opterra_synthetic"),
        "file names begin with it")("spread", po::value<double>()->value_name("X")->default_value(1.0, "1"),
                                    "flight-to-flight spread, as a multiple of the paper's bands")(
        "current-noise",
        po::value<double>()->value_name("A")->default_value(SyntheticSensors{}.current_noise_a, "0.001"),
        "noise of the current sensor, as a standard deviation")(
        "truth", "write the true phases beside each log, as NAME.truth.csv");
    return cli::run_stage(argc, argv, stage, synthesize);
}
