// flightwatt profile: runs software over its quality of service and measures its power.

#include "base/atomic_file.h"
#include "base/signal_watch.h"
#include "batch/batch_files.h"
#include "cli/output/profile_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "compute/power_sampler.h"
#include "compute/profile_reader.h"
#include "compute/profile_specification.h"
#include "compute/profiler.h"
#include "stages.h"

#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr int killed_by_signal = 128;  // what shells add to the signal

std::vector<std::string> words_of(const std::string& list) {
    std::vector<std::string> words;
    return boost::algorithm::split(words, list, [](char c) { return c == ','; });
}

struct ProfileArguments {
    bool checks_interpolation = false;
    std::optional<std::string> parameters;
    std::optional<std::string> columns;
};

compute::ProfileNaming naming_of(const ProfileArguments& arguments) {
    compute::ProfileNaming naming;
    naming.where.file = "the command line";
    if (arguments.parameters) naming.parameters = words_of(*arguments.parameters);
    if (arguments.columns) naming.columns = words_of(*arguments.columns);
    return naming;
}

/// A profile of --check-interpolation.
struct CheckedProfile {
    std::string file;
    std::size_t nodes = 0;
    compute::LeaveOneOutErrors errors;
};

Fields<CheckedProfile> record_fields(const CheckedProfile*) {
    using R = CheckedProfile;
    auto columns = embedded(&R::errors);
    for (auto& column : columns) column.in_json = false;
    return list_fields<R>(field("file", &R::file, "file of the profile", column{}),
                          field("nodes", &R::nodes, "its nodes", column{}), std::move(columns),
                          field("leave_one_out", &R::errors, "errors of the interpolation"));
}

/// JSON of --check-interpolation.
struct CheckOutput {
    std::vector<CheckedProfile> profiles;
};

Fields<CheckOutput> record_fields(const CheckOutput*) {
    return {field("profiles", &CheckOutput::profiles, "profiles")};
}

int check_interpolation(const cli::StageCall& call, const ProfileArguments& arguments) {
    const auto screen = call.output ? cli::Screen() : screen_of(call);
    CheckOutput output;
    for (const auto& file : call.inputs) {
        const auto profile = read_power_profile(file, naming_of(arguments));
        auto in_missions = profile;
        if (const auto negative = remove_negative_power(in_missions); !negative.empty()) cli::warn(call, negative);
        output.profiles.push_back({file, profile.power_w.size(), compute::leave_one_out(profile)});
    }
    cli::write_result(call, screen_text(table_of(output.profiles), screen));
    if (call.json) cli::print_json(call, output);
    return cli::ok;
}

void note_run(const cli::StageCall& call, const compute::ProfileRun& run, std::size_t done, std::size_t all) {
    const auto name = run.configuration.empty() ? run.component : run.component + " " + run.configuration;
    const auto what = run.is_from_earlier_run                ? "up to date"
                      : run.status == compute::RunStatus::ok ? fmt::format("{:.4g} W", run.estimate.power_w)
                                                             : std::string(to_string(run.status));
    cli::note(call, fmt::format("[{}/{}] {} repeat {}: {}{}", done, all, name, run.repeat, what,
                                run.note.empty() ? "" : ": " + run.note));
}

compute::ProfilerOptions options_of(const cli::StageCall& call, const SignalWatch& signals) {
    compute::ProfilerOptions options;
    options.folder = *call.output;
    options.signal_fd = signals.fd();
    options.caught = [&signals] { return signals.received().value_or(SIGINT); };
    options.on_sampler_opened = [&call](const compute::PowerSampler& sampler) {
        cli::note(call, fmt::format("sampling with {}: {}", to_string(sampler.kind), sampler.source));
    };
    return options;
}

int conclude(const cli::StageCall& call, const compute::ProfileOutcome& outcome,
             const compute::ProfileSpecification& specification) {
    write_profiles(outcome, specification, *call.output);
    if (call.json) {
        cli::print_json(call, cli::ProfileOutput{&outcome, specification.above_idle});
    } else {
        cli::print(cli::profile_text({&outcome, specification.above_idle}, screen_of(call)));
    }
    std::size_t failed = 0;
    for (const auto& component : outcome.components) failed += component.failures.size();
    if (failed == 0) return cli::ok;
    cli::note(call, fmt::format("{} of {} runs gave no power, see {}/{}; the same command tries them again", failed,
                                outcome.runs.size(), *call.output, compute::runs_name));
    return cli::no_answer;
}

int profile_components(const cli::StageCall& call, const ProfileArguments& arguments) {
    if (arguments.checks_interpolation) return check_interpolation(call, arguments);
    if (call.inputs.size() != 1) throw UsageError("expected one SPEC");
    if (!call.output) throw UsageError("no folder for the results: expected -o DIR");
    const auto specification = compute::read_profile_specification(call.inputs.front());
    const SignalWatch signals;
    auto options = options_of(call, signals);
    std::string runs = "no runs";
    options.progress = [&](const compute::ProfileRun& run, std::size_t done, std::size_t all) {
        runs = fmt::format("{} of {} runs", done, all);
        note_run(call, run, done, all);
    };
    make_directories(options.folder);
    const batch::FolderLock lock(options.folder);
    try {
        return conclude(call, profile(specification, options), specification);
    } catch (const compute::Interrupted& interrupted) {
        cli::note(call, fmt::format("stopped by {} after {}; the same command continues from there",
                                    signal_name(interrupted.signal), runs));
        return killed_by_signal + interrupted.signal;
    }
}

}  // namespace

int flightwatt::stages::profile_stage(int argc, char** argv) {
    cli::StageDefinition stage{"profile", "SPEC -o DIR | --check-interpolation FILE...",
                               R"(Runs each component of SPEC (TOML) over its quality of service while sampling
power. DIR/NAME.csv is layer 2, configuration to mean power, energy and standard error, as missions
take it; DIR/layer1 holds power over time of every run, DIR/runs.csv the result of each, DIR/idle.csv
the idle computer. A component that fails or hangs is recorded and ended with its process group, the
others are run; the exit code is then 4. Ctrl-C ends all processes; the same command continues where
it stopped. Without duration_s in SPEC a run is as long as its command, ended as hung after timeout_s;
with it the command is ended when its time is over, whatever it does. Runs that succeeded are not done
again while their part of SPEC is the same; remove DIR when a program itself has changed.

Samplers: auto, ina3221, rapl, command, recorded.)"};
    stage.output_value = "DIR";
    stage.output_help = "the folder of the results";
    stage.next = [](const auto& call) {
        return call.has("check-interpolation")
                   ? ""
                   : "flightwatt new-mission --model MODEL.toml --battery PACK.toml --profile {}/NAME.csv";
    };
    stage.json_schema = cli::document_schema<cli::ProfileOutput, CheckOutput>;
    stage.examples = {"flightwatt profile detector.toml -o profiles",
                      "flightwatt profile --check-interpolation profiles/detector.csv"};
    stage.shows_table = true;
    ProfileArguments arguments;
    auto& options = stage.options;
    options.add("check-interpolation", arguments.checks_interpolation,
                "of profiles: interpolate each node from the others, and print the errors");
    options.add("parameters", arguments.parameters, {.value = "A,B", .needs = {"check-interpolation"}},
                "the parameters' names, of a profile that has flags");
    options.add("columns", arguments.columns, {.value = "A,B,power_w", .needs = {"check-interpolation"}},
                "the columns' names, of a profile without a header");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return profile_components(call, arguments); });
}
