// flightwatt synthesize: synthetic Paparazzi logs of flights after a mechanical model.

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/overwrite_guard.h"
#include "base/text.h"
#include "cli/stage.h"
#include "mechanical/mechanical_model.h"
#include "stages.h"
#include "synthetic/synthetic_flight.h"
#include "synthetic/synthetic_log.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

struct WrittenLog {
    std::string flight;
    std::size_t bytes = 0;
};

Fields<WrittenLog> record_fields(const WrittenLog*) {
    return {field("flight", &WrittenLog::flight, "name of the flight"),
            field("bytes", &WrittenLog::bytes, "size of the log")};
}

/// JSON of the stage.
struct SynthesizeOutput {
    std::vector<WrittenLog> flights;
};

Fields<SynthesizeOutput> record_fields(const SynthesizeOutput*) {
    return {field("flights", &SynthesizeOutput::flights, "logs that were written")};
}

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

using Anomalies = std::vector<std::string>;

struct SynthesizeArguments {
    std::size_t flights = 6;
    std::uint64_t seed = 1;
    std::optional<std::string> name;
    synthetic::SpreadOptions spread;
    synthetic::SyntheticSensors sensors;
    std::optional<double> cruise_s;
    bool flight_messages_only = false;
    bool with_truth = false;
    Anomalies anomalies;
};

/// The choices of --anomaly: none, each by its name, and all.
std::vector<std::pair<std::string, Anomalies>> anomaly_choices() {
    std::vector<std::pair<std::string, Anomalies>> choices{{"none", {""}}};
    for (const auto& anomaly : synthetic::anomaly_names()) choices.push_back({anomaly, {anomaly}});
    choices.emplace_back("all", synthetic::anomaly_names());
    return choices;
}

/// Name and origin of a synthetic log.
struct LogIdentity {
    std::string name;
    std::string made_by;
};

std::string log_name(const std::string& name, std::size_t number, const std::string& anomaly) {
    return fmt::format("{}_{:02}{}{}", name, number, anomaly.empty() ? "" : "_", anomaly);
}

/// Refuses what would replace an input before the first log is written.
void register_logs(const cli::StageCall& call, const SynthesizeArguments& arguments) {
    for (std::size_t i = 1; i <= arguments.flights; ++i) {
        for (const auto& anomaly : arguments.anomalies) {
            const auto name = log_name(*arguments.name, i, anomaly);
            const auto stem = (std::filesystem::path(*call.output) / name).string();
            for (const auto* ending : {".log", ".data", ".truth.csv"}) register_output(stem + ending);
        }
    }
}

/// Writes NAME.log, NAME.data and, if asked for, NAME.truth.csv; returns the log's size in bytes.
std::size_t write_log(const cli::StageCall& call, const SynthesizeArguments& arguments,
                      const synthetic::SyntheticScenario& scenario, const LogIdentity& identity, std::uint64_t seed) {
    const auto log = make_synthetic_log(scenario, arguments.sensors, identity.name, identity.made_by, seed);
    const auto stem = std::filesystem::path(*call.output) / identity.name;
    write_file_atomically(stem.string() + ".log", log.log);
    write_file_atomically(stem.string() + ".data", log.data);
    if (arguments.with_truth) write_file_atomically(stem.string() + ".truth.csv", truth_csv(scenario));
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
            throw InputError({file}, fmt::format("{} takes {} s, expected at most {} s", phase_word(phase), duration_s,
                                                 max_phase_s));
        }
        if (!(max_w <= max_power_w)) {
            throw InputError({file}, fmt::format("the coefficients of {} add up to {} W, expected at most {} W",
                                                 phase_word(phase), max_w, max_power_w));
        }
    }
}

/// Refuses a name that cannot begin the name of a file.
void check_name(const std::string& name) {
    if (name.empty() || name.find('/') != std::string::npos)
        throw UsageError(fmt::format("--name is '{}', expected the beginning of a file name, without '/'", name));
}

/// The model, with another duration of its cruise where one is asked for: its curve is scaled in time.
mechanical::MechanicalModel read_model(const cli::StageCall& call, const std::optional<double>& cruise_s) {
    auto model = mechanical::read_mechanical_model(call.inputs.front());
    if (cruise_s) {
        auto& cruise = model.phases[flight::Phase::cruise];
        cruise.fourier = time_scaled_model(cruise, *cruise_s, mechanical::PhaseTimeScaling::scaled);
        cruise.duration_s = *cruise_s;
    }
    require_flyable(model, call.inputs.front());
    return model;
}

int synthesize(const cli::StageCall& call, SynthesizeArguments arguments) {
    if (!call.output) throw UsageError("no folder for the results: expected -o DIR");
    const auto& [count, seed] = std::tie(arguments.flights, arguments.seed);
    arguments.sensors.sends_other_messages = !arguments.flight_messages_only;
    const auto model = read_model(call, arguments.cruise_s);
    if (!arguments.name) arguments.name = model.name + "_synthetic";
    check_name(*arguments.name);
    register_logs(call, arguments);
    make_directories(*call.output);
    const auto flights = draw_flights(model, count, seed, arguments.spread);
    SynthesizeOutput output;
    for (std::size_t i = 0; i < count; ++i) {
        std::mt19937_64 random(seed + 1000 * (i + 1));
        const auto flight = make_flight(flights[i], random);
        const auto log_seed = random();
        for (const auto& anomaly : arguments.anomalies) {
            LogIdentity identity;
            identity.name = log_name(*arguments.name, i + 1, anomaly);
            identity.made_by =
                fmt::format("Made by flightwatt synthesize: model {}, flight {} of {}, seed {}{}{}.", model.name, i + 1,
                            count, seed, anomaly.empty() ? "" : ", anomaly ", anomaly);
            const auto bytes = write_log(call, arguments, make_scenario(flight, anomaly), identity, log_seed);
            output.flights.push_back({identity.name, bytes});
        }
    }
    if (call.json) cli::print_json(call, output);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::synthesize_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "synthesize", "MODEL.toml -o FOLDER",
        R"(Writes synthetic Paparazzi logs (.log and .data) of flights whose power follows a mechanical model, with
sensor noise, lost lines, durations and power that vary between flights. The files are marked as
synthetic. The same seed gives the same files.)"};
    stage.next = [](const auto&) { return "flightwatt batch {} -o OUT"; };
    stage.json_schema = cli::document_schema<SynthesizeOutput>;
    stage.max_inputs = 1;
    stage.output_value = "DIR";
    stage.output_help = "the folder to write into";
    stage.examples = {"flightwatt synthesize model.toml -o logs --flights 12 --seed 7",
                      "flightwatt synthesize model.toml -o logs --anomaly two-sorties --truth"};
    SynthesizeArguments arguments;
    const auto anomalies = anomaly_choices();
    arguments.anomalies = anomalies.front().second;
    auto& options = stage.options;
    options.add("flights", arguments.flights, {.value = "N", .min = 1, .max = 1000}, "number of flights");
    options.add("seed", arguments.seed, {.value = "S"}, "seed of everything random");
    options.add("name", arguments.name, {.value = "NAME"},
                "beginning of the file names; default: the model's name, and _synthetic");
    options.add("spread", arguments.spread.band_scale, {.value = "X", .min = 0.0, .max = 100.0},
                "variability between flights, as a multiple of the paper's bands");
    options.add("current-noise", arguments.sensors.current_noise_a,
                {.value = "A", .min = 0.0, .max = 1000.0, .unit = "A"},
                "noise of the current sensor, as a standard deviation");
    options.add("cruise", arguments.cruise_s, {.value = "S", .min = 60.0, .max = 1e5, .unit = "s"},
                "duration of the cruise in seconds; default: the model's");
    options.add("flight-messages-only", arguments.flight_messages_only,
                "write only the messages from which flights are read: small logs");
    options.add("truth", arguments.with_truth, "write the true phases next to each log, as NAME.truth.csv");
    options.add_choice(
        "anomaly", arguments.anomalies, anomalies, {.value = "NAME", .old_name = "hazard"},
        fmt::format("an event of real logs that must not mislead the segmentation: {}, or all, a log each",
                    fmt::join(synthetic::anomaly_names(), ", ")));
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return synthesize(call, arguments); });
}
