#include "compute/profiler.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "compute/profiling/spread_nodes.h"
#include "compute/profiling/thin_plate.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <poll.h>

namespace flightwatt::compute {
namespace {

/// As many as say how well they are interpolated: one more than a plane needs.
void require_enough(std::size_t trials, const ProfiledComponent& component) {
    const auto fewest = std::max<std::size_t>(3, component.parameters.size() + 2);
    if (trials >= fewest) return;
    throw UsageError(
        fmt::format("--trials is {}, expected {} or more for {}", trials, fewest, component.name));
}

std::vector<std::vector<std::size_t>> chosen_nodes(const ProfileSpecification& specification,
                                                   std::optional<std::size_t> trials) {
    std::vector<std::vector<std::size_t>> chosen;
    for (const auto& component : specification.components) {
        std::vector<std::size_t> nodes(component.configurations.size());
        std::iota(nodes.begin(), nodes.end(), std::size_t{0});
        if (trials && *trials < nodes.size()) {
            require_enough(*trials, component);
            std::vector<std::vector<double>> points;
            for (const auto& configuration : component.configurations) points.push_back(configuration.qos);
            nodes = spread_nodes(points, *trials);
            std::sort(nodes.begin(), nodes.end());
        }
        chosen.push_back(std::move(nodes));
    }
    return chosen;
}

ComponentRun execute(const ProfileRun& run, const ProfileSpecification& specification,
                     const RunFrame& frame) {
    const auto& settings = specification.sampler;
    const bool is_idle = run.component == idle_component;
    const ProfiledConfiguration* configuration =
        is_idle ? nullptr : &specification.components[run.index].configurations[run.node];
    ProfileTiming timing;
    if (is_idle) {
        timing.duration_s = specification.idle_s;
    } else {
        timing = specification.components[run.index].timing;
    }
    if (settings.kind == "recorded") {
        const auto file = is_idle ? settings.folder / settings.idle_file : configuration->recording;
        if (is_idle) timing.duration_s.reset();  // as long as it is
        const auto interval_s =
            settings.interval_is_given ? std::optional(settings.interval_s) : std::nullopt;
        return run_of_recording(read_power_trace(file, interval_s), timing, settings.interval_s);
    }
    if (is_idle) return run_component({}, timing, frame);
    return run_component(configuration->commands, timing, frame);
}

void do_run(ProfileRun& run, const ProfileSpecification& specification, const ProfilerOptions& options,
            PowerSampler& sampler) {
    const auto path = options.folder / run.layer1;
    make_directories(path.parent_path());
    RunFrame frame;
    frame.sampler = &sampler;
    frame.interval_s = specification.sampler.interval_s;
    frame.output = std::filesystem::path(path).replace_extension(".txt");
    frame.signals = options.signals;
    frame.caught = options.caught;
    auto result = execute(run, specification, frame);
    run.status = result.status;
    run.note = std::move(result.note);
    run.trace = std::move(result.trace);
    run.is_done = true;
    if (run.status == RunStatus::ok) run.estimate = estimate_run(run.trace, result.duration_s);
    write_layer1(run, options.folder);
}

/// A meter takes its time to start, which is none of the first run's. Throws NoAnswerError for one that says
/// nothing.
void await_meter(PowerSampler& sampler, const ProfilerOptions& options) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds patience(30);
    if (sampler.file() < 0) return;  // a sensor, which answers when asked
    for (const auto end = Clock::now() + patience; Clock::now() < end;) {
        pollfd files[2] = {{options.signals, POLLIN, 0}, {sampler.file(), POLLIN, 0}};
        ::poll(files, 2, 100);
        if (files[0].revents != 0) throw Interrupted(options.caught());
        if (!sampler.read().empty()) return;
    }
    throw NoAnswerError(
        fmt::format("the sampler '{}' printed nothing for {} s", sampler.source, patience.count()));
}

void do_runs(std::vector<ProfileRun>& runs, const ProfileSpecification& specification,
             const ProfilerOptions& options, PowerSampler& sampler) {
    std::size_t done = 0;
    if (std::any_of(runs.begin(), runs.end(), [](const auto& run) { return !run.is_done; })) {
        await_meter(sampler, options);
    }
    for (auto& run : runs) {
        if (!run.is_done) {
            do_run(run, specification, options, sampler);
            write_runs(runs, options.folder);
        }
        if (options.progress) options.progress(run, ++done, runs.size());
    }
    write_runs(runs, options.folder);
}

std::vector<PowerEstimate> repeats_of(const std::vector<ProfileRun>& runs, const std::string& component,
                                      std::size_t node) {
    std::vector<PowerEstimate> estimates;
    for (const auto& run : runs) {
        if (run.component == component && run.node == node && run.status == RunStatus::ok) {
            estimates.push_back(run.estimate);
        }
    }
    return estimates;
}

/// Fills in the configurations that were not run.
void interpolate(const std::vector<std::vector<double>>& missing, ComponentEstimate& estimate) {
    if (missing.empty() || estimate.nodes.empty()) return;
    std::vector<std::vector<double>> known;
    std::vector<double> power_w;
    for (const auto& node : estimate.nodes) {
        known.push_back(node.qos);
        power_w.push_back(node.total.power_w);
    }
    const auto choice = choose_scale(known, power_w, missing);
    if (!choice) return;  // too many runs failed: the grid stays incomplete
    estimate.interpolation = choice->error;
    const auto found_w = interpolate_thin_plate(choice->scale, known, power_w, missing);
    for (std::size_t i = 0; i < missing.size(); ++i) {
        NodeEstimate node{missing[i], {}, false};
        node.total.power_w = found_w[i];
        node.total.standard_error_w = estimate.interpolation->rms_w;
        estimate.nodes.push_back(std::move(node));
    }
    std::sort(estimate.nodes.begin(), estimate.nodes.end(),
              [](const auto& a, const auto& b) { return a.qos < b.qos; });
}

PowerEstimate idle_of(const std::vector<ProfileRun>& runs) {
    const auto& idle = runs.front();
    if (idle.status == RunStatus::ok) return idle.estimate;
    throw NoAnswerError(fmt::format("no idle power: {} {}", to_string(idle.status), idle.note));
}

}  // namespace

ComponentEstimate estimate_component(const ProfiledComponent& component, std::size_t index,
                                     const std::vector<ProfileRun>& runs) {
    ComponentEstimate estimate{
        component.name, component.parameters, {}, component.configurations.size(), {}, {}};
    std::set<std::size_t> tried;
    for (const auto& run : runs) {
        if (run.component == idle_component || run.index != index) continue;
        tried.insert(run.node);
        if (run.status != RunStatus::ok) estimate.failures.push_back(run);
    }
    std::vector<std::vector<double>> missing;
    for (std::size_t node = 0; node < component.configurations.size(); ++node) {
        const auto& qos = component.configurations[node].qos;
        const auto repeats = repeats_of(runs, component.name, node);
        if (!repeats.empty())
            estimate.nodes.push_back({qos, combine_repeats(repeats), true});
        else if (!tried.contains(node))
            missing.push_back(qos);
    }
    interpolate(missing, estimate);
    return estimate;
}

ProfileOutcome profile(const ProfileSpecification& specification, const ProfilerOptions& options) {
    ProfileOutcome outcome;
    outcome.runs = planned_runs(specification, chosen_nodes(specification, options.trials));
    recall_runs(outcome.runs, options.folder);
    PowerSampler sampler;
    if (specification.sampler.kind == "recorded") {
        sampler.kind = sampler.source = "recorded";
    } else {
        sampler = open_sampler(specification.sampler);
    }
    if (options.opened) options.opened(sampler);
    outcome.sampler = sampler.source == sampler.kind ? sampler.kind : sampler.kind + ": " + sampler.source;
    make_directories(options.folder);
    do_runs(outcome.runs, specification, options, sampler);
    if (specification.idle_s > 0.0) outcome.idle = idle_of(outcome.runs);
    std::vector<PowerTrace> traces;
    for (const auto& run : outcome.runs) {
        if (run.status == RunStatus::ok) traces.push_back(run.trace);
    }
    outcome.jitter = jitter_of(traces);
    for (std::size_t i = 0; i < specification.components.size(); ++i) {
        outcome.components.push_back(estimate_component(specification.components[i], i, outcome.runs));
    }
    return outcome;
}

}  // namespace flightwatt::compute
