#include "cli/output/profile_output.h"

#include "base/text_table.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::compute {

Fields<PowerEstimate> record_fields(const PowerEstimate*) {
    using R = PowerEstimate;
    const auto error_w = [](const R& power) {
        return std::isfinite(power.standard_error_w) ? std::optional(power.standard_error_w) : std::nullopt;
    };
    return {field("power_w", &R::power_w, "mean power", column{"", ".4f"}),
            field("standard_error_w", error_w, "standard error of the mean; null: of a single run", column{"", ".4f"}),
            field("duration_s", &R::duration_s, "measured time", column{"", ".2f"}),
            field("energy_j", &R::energy_j, "energy [J]", column{"", ".2f"}),
            field("samples", &R::samples, "samples", column{}),
            field("repeats", &R::repeats, "runs", column{})};
}

Fields<ProfileRun> record_fields(const ProfileRun*) {
    using R = ProfileRun;
    return {field("configuration", &R::configuration, "number of the configuration"),
            field("repeat", &R::repeat, "number of the run"), field("status", &R::status, "result of the run"),
            field("note", &R::note, "details")};
}

Fields<SamplingJitter> record_fields(const SamplingJitter*) {
    using R = SamplingJitter;
    return {field("mean_s", &R::mean_s, "mean"), field("sd_s", &R::sd_s, "standard deviation"),
            field("max_s", &R::max_s, "maximum")};
}

Fields<LeaveOneOutErrors> record_fields(const LeaveOneOutErrors*) {
    using R = LeaveOneOutErrors;
    return {field("nodes", &R::nodes, "nodes that have neighbours", column{"from others"}),
            field("mean_absolute_error_w", &R::mean_absolute_w, "mean of |error|", column{"mean |error| W", ".4f"}),
            field("mean_absolute_error_percent", &R::mean_absolute_percent, "mean of |error|",
                  column{"mean |error| %", ".2f"}),
            field("rms_error_w", &R::rms_w, "root mean square error", column{"RMS W", ".4f"}),
            field("largest_error_w", &R::largest_w, "largest error", column{"largest W", ".4f"})};
}

}  // namespace flightwatt::compute

namespace flightwatt::cli {
namespace {

/// A configuration as measured.
struct NodeOutput {
    const compute::NodeEstimate* node = nullptr;
    compute::PowerEstimate reported;  ///< above idle if specified
};

/// A component as measured.
struct ComponentOutput {
    const compute::ComponentEstimate* component = nullptr;
    std::vector<NodeOutput> nodes;
};

Fields<NodeOutput> record_fields(const NodeOutput*) {
    using R = NodeOutput;
    using N = compute::NodeEstimate;
    return list_fields<R>(
        field("qos", at(&R::node, &N::qos), "parameters of the configuration"), embedded(&R::reported),
        field("total_power_w", at(&R::node, &N::total, &compute::PowerEstimate::power_w), "with the idle power"));
}

std::vector<NodeOutput> node_outputs(const compute::ComponentEstimate& component, const ProfileOutput& profile) {
    std::vector<NodeOutput> all;
    for (const auto& node : component.nodes) {
        const auto reported = reported_power(node.total, profile.outcome->idle, profile.above_idle);
        auto estimate = node.total;
        estimate.power_w = reported.power_w;
        estimate.standard_error_w = reported.standard_error_w;
        estimate.energy_j = reported.power_w * node.total.duration_s;
        all.push_back({&node, estimate});
    }
    return all;
}

/// A row a configuration: its parameters, then its power.
TextTable component_table(const compute::ComponentEstimate& component, const ProfileOutput& profile) {
    auto table = table_of(node_outputs(component, profile));
    table.header.insert(table.header.begin(), component.parameters.begin(), component.parameters.end());
    for (std::size_t i = 0; i < table.rows.size(); ++i)
        for (std::size_t k = component.parameters.size(); k-- > 0;)
            table.rows[i].insert(table.rows[i].begin(), fmt::format("{}", component.nodes[i].qos[k]));
    return table;
}

Fields<ComponentOutput> record_fields(const ComponentOutput*) {
    using R = ComponentOutput;
    using C = compute::ComponentEstimate;
    return {field("name", at(&R::component, &C::name), "name of the component"),
            field("parameters", at(&R::component, &C::parameters), "names of its parameters"),
            field("nodes", &R::nodes, "configurations"),
            field("failures", at(&R::component, &C::failures), "failed runs")};
}

}  // namespace

Fields<ProfileOutput> record_fields(const ProfileOutput*) {
    using R = ProfileOutput;
    using O = compute::ProfileOutcome;
    const auto components = [](const R& r) {
        std::vector<ComponentOutput> all;
        for (const auto& component : r.outcome->components) all.push_back({&component, node_outputs(component, r)});
        return all;
    };
    return {field("sampler", at(&R::outcome, &O::sampler), "the power sensor"),
            field("above_idle", &R::above_idle, "powers are above the idle power"),
            field("idle", at(&R::outcome, &O::idle), "idle power", optional_key{}),
            field("sampling_interval", at(&R::outcome, &O::jitter), "interval between samples"),
            field("components", components, "components")};
}

std::string profile_text(const ProfileOutput& profile, const Screen& screen) {
    const auto& outcome = *profile.outcome;
    auto text = outcome.idle ? values_text(record_json(*outcome.idle), "idle ") : "";
    text += values_text(record_json(outcome.jitter), "sampling interval ");
    for (const auto& component : outcome.components) {
        text += fmt::format("\n{}{}\n", component.name, profile.above_idle ? ", above idle" : "");
        ScreenTable shown{"", component.parameters};
        shown.first.insert(shown.first.end(), {"power_w", "standard_error_w"});
        text += component.nodes.empty() ? "no configuration was measured\n"
                                        : screen_text(component_table(component, profile), screen, shown);
        for (const auto& run : component.failures)
            text +=
                fmt::format("{} repeat {} {}: {}\n", run.configuration, run.repeat, to_string(run.status), run.note);
    }
    return text;
}

}  // namespace flightwatt::cli
