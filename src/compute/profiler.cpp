#include "compute/profiler.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "compute/profiling/component_run.h"
#include "compute/profiling/profile_runs.h"
#include "compute/sensors/power_trace.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>

#include <boost/algorithm/string.hpp>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

std::filesystem::path folder_of(const ProfileSpecification& specification) {
    return std::filesystem::path(specification.file).parent_path();
}

/// Whether the program, a path or a name to be found along PATH, can be executed.
bool is_executable(const std::string& program, const std::filesystem::path& folder) {
    std::vector<std::string> places{folder.string()};
    const char* const path = std::getenv("PATH");
    if (program.find('/') == std::string::npos)
        boost::split(places, path != nullptr ? path : "/usr/bin:/bin", boost::is_any_of(":"));
    return std::ranges::any_of(
        places, [&](const std::filesystem::path& place) { return ::access((place / program).c_str(), X_OK) == 0; });
}

/// Throws InputError for a program that is absent, before anything is measured.
void require_programs(const ProfileSpecification& specification, const std::vector<ProfileRun>& runs) {
    const auto folder = (std::filesystem::current_path() / folder_of(specification)).lexically_normal();
    for (const auto& run : runs) {
        if (run.is_done || run.component == idle_component) continue;
        for (const auto& command : specification.components[run.index].configurations[run.node].commands) {
            const auto& program = command.front();
            const bool is_path = program.find('/') != std::string::npos;
            if (is_executable(program, folder)) continue;
            throw InputError({specification.file},
                             fmt::format("component {}: there is no program {} that can be executed {}", run.component,
                                         program, is_path ? "in " + folder.string() : "along PATH"),
                             "paths are relative to the specification, as in [\"./detector\"]");
        }
    }
}

ComponentRun execute(const ProfileRun& run, const ProfileSpecification& specification, const RunContext& frame) {
    const auto& settings = specification.sampler;
    const bool is_idle = run.component == idle_component;
    const bool is_recorded = settings.kind == SamplerKind::recorded;
    ProfiledConfiguration configuration{{}, {}, settings.folder / settings.idle_file};
    ProfileTiming timing;
    if (!is_idle) {
        const auto& component = specification.components[run.index];
        configuration = component.configurations[run.node];
        timing = component.timing;
    } else if (!is_recorded) {
        timing.duration_s = specification.idle_s;  // a recording counts as a whole
    }
    if (!is_recorded) return run_component(configuration.commands, timing, frame);
    const auto interval_s = settings.interval_is_given ? std::optional(settings.interval_s) : std::nullopt;
    return run_of_recording(read_power_trace(configuration.recording, interval_s), timing, settings.interval_s);
}

void do_run(ProfileRun& run, const ProfileSpecification& specification, const ProfilerOptions& options,
            PowerSampler& sampler) {
    const auto path = options.folder / run.layer1;
    make_directories(path.parent_path());
    auto output = std::filesystem::path(path).replace_extension(".txt");
    auto result = execute(run, specification,
                          {&sampler, specification.sampler.interval_s, std::move(output), options.signal_fd,
                           options.caught, 2.0, folder_of(specification)});
    run.status = result.status;
    run.note = std::move(result.note);
    run.trace = std::move(result.trace);
    run.is_done = true;
    if (run.status == RunStatus::ok) run.estimate = estimate_run(run.trace, result.duration_s);
    write_layer1(run, options.folder);
}

/// Waits for the first reading of a program. Throws NoResultError after 30 s.
void await_meter(PowerSampler& sampler, const ProfilerOptions& options) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds patience(30);
    if (sampler.file() < 0) return;  // a sensor
    for (const auto end = Clock::now() + patience; Clock::now() < end;) {
        pollfd files[2] = {{options.signal_fd, POLLIN, 0}, {sampler.file(), POLLIN, 0}};
        ::poll(files, 2, 100);
        if (files[0].revents != 0) throw Interrupted(options.caught());
        if (!sampler.read().empty()) return;
    }
    throw NoResultError(fmt::format("the sampler '{}' printed nothing for {} s", sampler.source, patience.count()));
}

void do_runs(std::vector<ProfileRun>& runs, const ProfileSpecification& specification, const ProfilerOptions& options,
             PowerSampler& sampler) {
    std::size_t done = 0;
    if (!std::ranges::all_of(runs, &ProfileRun::is_done)) await_meter(sampler, options);
    for (auto& run : runs) {
        if (!run.is_done) {
            do_run(run, specification, options, sampler);
            write_runs(runs, options.folder);
        }
        if (options.progress) options.progress(run, ++done, runs.size());
    }
    write_runs(runs, options.folder);
}

PowerEstimate idle_of(const std::vector<ProfileRun>& runs) {
    const auto& idle = runs.front();
    if (idle.status == RunStatus::ok) return idle.estimate;
    throw NoResultError(fmt::format("no idle power: {} {}", to_string(idle.status), idle.note));
}

/// Layer 2 of the runs, without failed configurations.
ComponentEstimate estimate_component(const ProfiledComponent& component, std::size_t index,
                                     const std::vector<ProfileRun>& runs) {
    ComponentEstimate estimate{component.name, component.parameters, {}, {}};
    std::map<std::size_t, std::vector<PowerEstimate>> repeats;
    for (const auto& run : runs) {
        if (run.component == idle_component || run.index != index) continue;
        auto& of_node = repeats[run.node];
        if (run.status == RunStatus::ok)
            of_node.push_back(run.estimate);
        else
            estimate.failures.push_back(run);
    }
    for (std::size_t node = 0; node < component.configurations.size(); ++node) {
        const auto& of_node = repeats[node];
        if (of_node.empty()) continue;
        estimate.nodes.push_back({component.configurations[node].qos, combine_repeats(of_node)});
    }
    return estimate;
}

}  // namespace

ProfileOutcome profile(const ProfileSpecification& specification, const ProfilerOptions& options) {
    ProfileOutcome outcome;
    outcome.runs = planned_runs(specification);
    check_result_files(specification, outcome.runs, options.folder);
    load_completed_runs(outcome.runs, options.folder);
    const bool is_recorded = specification.sampler.kind == SamplerKind::recorded;
    PowerSampler sampler{SamplerKind::recorded, "recorded", {}};
    if (!is_recorded) require_programs(specification, outcome.runs);
    if (!is_recorded) sampler = open_sampler(specification.sampler);
    if (options.on_sampler_opened) options.on_sampler_opened(sampler);
    outcome.sampler = to_string(sampler.kind);
    if (!is_recorded) outcome.sampler += ": " + sampler.source;
    make_directories(options.folder);
    do_runs(outcome.runs, specification, options, sampler);
    if (specification.idle_s > 0.0) outcome.idle = idle_of(outcome.runs);
    std::vector<PowerTrace> traces;
    for (const auto& run : outcome.runs)
        if (run.status == RunStatus::ok) traces.push_back(run.trace);
    outcome.jitter = jitter_of(traces);
    for (std::size_t i = 0; i < specification.components.size(); ++i) {
        outcome.components.push_back(estimate_component(specification.components[i], i, outcome.runs));
    }
    return outcome;
}

}  // namespace flightwatt::compute
