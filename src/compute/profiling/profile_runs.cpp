#include "compute/profiling/profile_runs.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "base/number.h"
#include "base/overwrite_guard.h"
#include "compute/compute_model.h"
#include "compute/sensors/power_trace.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// Of the settings and recordings that a run's result depends on; not of programs' files or the order of the runs.
std::string fingerprint_of(const SamplerSettings& sampler, const ProfileTiming& timing,
                           const ProfiledConfiguration& configuration) {
    Fingerprint fingerprint;
    const auto add = [&](const std::string& text) { fingerprint.add(text); };
    add(std::string(to_string(sampler.kind)));
    add(sampler.sysfs.string());
    add(fmt::format("{} {} {}", sampler.interval_s, fmt::join(sampler.rails, "\n"), fmt::join(sampler.command, "\n")));
    add(fmt::format("{} {} {}", timing.duration_s.value_or(-1.0), timing.warm_up_s, timing.timeout_s));
    for (const auto& command : configuration.commands) add(fmt::format("{}", fmt::join(command, "\n")));
    add(configuration.recording.string());
    if (!configuration.recording.empty()) add(read_file(configuration.recording));
    return fingerprint.hex();
}

std::string layer1_name(const std::string& component, std::string configuration, std::size_t repeat) {
    std::ranges::replace(configuration, ' ', '_');
    return fmt::format("layer1/{}/{}{}repeat_{}.csv", component, configuration, configuration.empty() ? "" : "_",
                       repeat);
}

ProfileRun idle_run(const ProfileSpecification& specification) {
    ProfiledConfiguration configuration;
    if (!specification.sampler.idle_file.empty()) {
        configuration.recording = specification.sampler.folder / specification.sampler.idle_file;
    }
    ProfileRun run;
    run.component = idle_component;
    run.layer1 = layer1_name(idle_component, "", 1);
    run.fingerprint = fingerprint_of(specification.sampler, {specification.idle_s, 0.0, 0.0}, configuration);
    return run;
}

/// Sets the result of a run from its layer 1, unless that is missing or damaged.
void restore(ProfileRun& run, const std::filesystem::path& folder, double duration_s, const std::string& note) {
    try {
        run.trace = read_power_trace(folder / run.layer1, std::nullopt);
    } catch (const InputError&) {
        return;
    }
    run.estimate = estimate_run(run.trace, duration_s);
    run.status = RunStatus::ok;
    run.note = note;
    run.is_done = run.is_from_earlier_run = true;
}

void add_row(CsvWriter& csv, const ProfileRun& run) {
    const bool has_power = run.status == RunStatus::ok;
    const auto& estimate = run.estimate;
    const auto jitter = jitter_of({run.trace});
    const auto number = [&](double value) {
        return has_power && std::isfinite(value) ? fmt::format("{:.6f}", value) : "";
    };
    csv.add(run.component, run.configuration, run.repeat, to_string(run.status), run.note,
            has_power ? std::optional(estimate.samples) : std::nullopt, number(estimate.duration_s),
            number(estimate.power_w), number(estimate.standard_error_w), number(estimate.energy_j),
            number(jitter.mean_s), number(jitter.sd_s), number(jitter.max_s), has_power ? run.layer1 : "",
            run.fingerprint);
}

}  // namespace

std::vector<ProfileRun> planned_runs(const ProfileSpecification& specification) {
    std::vector<ProfileRun> runs;
    if (specification.idle_s > 0.0) runs.push_back(idle_run(specification));
    std::mt19937_64 random(specification.seed);
    for (std::size_t repeat = 1; repeat <= specification.repeats; ++repeat) {
        const auto first = runs.size();
        for (std::size_t index = 0; index < specification.components.size(); ++index) {
            const auto& component = specification.components[index];
            for (std::size_t node = 0; node < component.configurations.size(); ++node) {
                const auto& configuration = component.configurations[node];
                ProfileRun run;
                run.component = component.name;
                run.index = index;
                run.node = node;
                run.configuration = format_qos(component.parameters, configuration.qos);
                run.repeat = repeat;
                run.fingerprint = fingerprint_of(specification.sampler, component.timing, configuration);
                run.layer1 = layer1_name(component.name, run.configuration, repeat);
                runs.push_back(std::move(run));
            }
        }
        std::shuffle(runs.begin() + static_cast<std::ptrdiff_t>(first), runs.end(), random);
    }
    return runs;
}

void check_result_files(const ProfileSpecification& specification, const std::vector<ProfileRun>& runs,
                        const std::filesystem::path& folder) {
    const OverwriteExemption own;
    const auto claim = [&](const std::string& name, std::string_view beginning) {
        const auto file = folder / name;
        register_output(file);
        std::error_code none;
        if (!std::filesystem::exists(file, none) || read_file(file).starts_with(beginning)) return;
        throw UsageError(fmt::format(
            "{} exists and is not of a profile; move it away, or choose another folder with -o", file.string()));
    };
    claim(runs_name, "component,configuration,repeat,");
    // The first lines of write_profiles.
    claim("idle.csv", "# Power of the idle computer");
    for (const auto& component : specification.components) {
        claim(component.name + ".csv", fmt::format("# Power of {}, profiled by flightwatt", component.name));
    }
    for (const auto& run : runs) register_output(folder / run.layer1);
}

void load_completed_runs(std::vector<ProfileRun>& runs, const std::filesystem::path& folder) {
    const OverwriteExemption own;
    std::error_code none;
    if (!std::filesystem::exists(folder / runs_name, none)) return;
    try {
        const auto table = read_csv(folder / runs_name);
        const auto layer1 = column_index(table, "layer1");
        const auto fingerprint = column_index(table, "fingerprint");
        const auto duration = column_index(table, "duration_s");
        const auto note = column_index(table, "note");
        std::map<std::string_view, const CsvTable::Row*> rows;
        for (const auto& row : table.rows) rows[row.cells[layer1].text] = &row;
        for (auto& run : runs) {
            const auto found = rows.find(run.layer1);
            if (found == rows.end() || found->second->cells[fingerprint].text != run.fingerprint) continue;
            const auto duration_s = parse_number(found->second->cells[duration].text);
            if (duration_s) restore(run, folder, *duration_s, found->second->cells[note].text);
        }
    } catch (const InputError&) {
        return;  // of another program, or damaged: all runs are done again
    }
}

void write_layer1(const ProfileRun& run, const std::filesystem::path& folder) {
    const auto path = folder / run.layer1;
    std::error_code ignored;
    if (run.status != RunStatus::ok) {
        std::filesystem::remove(path, ignored);  // of an earlier call
        return;
    }
    write_file_atomically(
        path, to_csv(run.trace, {fmt::format("{} {} repeat {}: time since its start, after the warm-up", run.component,
                                             run.configuration, run.repeat)}));
}

void write_runs(const std::vector<ProfileRun>& runs, const std::filesystem::path& folder) {
    CsvWriter csv({"component", "configuration", "repeat", "status", "note", "samples", "duration_s", "power_w",
                   "standard_error_w", "energy_j", "interval_mean_s", "interval_sd_s", "interval_max_s", "layer1",
                   "fingerprint"});
    for (const auto& run : runs)
        if (run.is_done) add_row(csv, run);
    const OverwriteExemption own;  // rewritten after each run
    write_file_atomically(folder / runs_name, csv.text());
}

}  // namespace flightwatt::compute
