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
    return {field("power_w", &R::power_w, "mean power"),
            field("standard_error_w", error_w, "standard error of the mean; null: of a single run"),
            field("duration_s", &R::duration_s, "measured time"),
            field("energy_j", &R::energy_j, "energy [J]"),
            field("samples", &R::samples, "samples"),
            field("repeats", &R::repeats, "runs")};
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
    return {field("nodes", &R::nodes, "nodes that have neighbours"),
            field("mean_absolute_error_w", &R::mean_absolute_w, "mean of |error|"),
            field("mean_absolute_error_percent", &R::mean_absolute_percent, "mean of |error|"),
            field("rms_error_w", &R::rms_w, "root mean square error"),
            field("largest_error_w", &R::largest_w, "largest error")};
}

}  // namespace flightwatt::compute

namespace flightwatt::cli {
namespace {

std::string component_table(const compute::ComponentEstimate& component, const compute::ProfileOutcome& outcome,
                            bool above_idle, const Screen& screen) {
    TextTable table;
    table.header = component.parameters;
    table.header.insert(table.header.end(),
                        {"power_w", "standard_error_w", "duration_s", "energy_j", "samples", "repeats"});
    for (const auto& node : component.nodes) {
        const auto reported = reported_power(node.total, outcome.idle, above_idle);
        std::vector<std::string> row;
        for (const double value : node.qos) row.push_back(fmt::format("{}", value));
        row.push_back(fixed(reported.power_w, 4));
        row.push_back(compute::number_or(reported.standard_error_w, 4, "-"));
        row.push_back(fixed(node.total.duration_s, 2));
        row.push_back(fixed(reported.power_w * node.total.duration_s, 2));
        row.push_back(fmt::format("{}", node.total.samples));
        row.push_back(fmt::format("{}", node.total.repeats));
        table.rows.push_back(std::move(row));
    }
    if (component.nodes.empty()) return "no configuration was measured\n";
    ScreenTable shown{"", component.parameters};
    shown.first.insert(shown.first.end(), {"power_w", "standard_error_w"});
    return screen_text(table, screen, shown);
}

/// A configuration as measured.
struct NodeOutput {
    const compute::NodeEstimate& node;
    compute::PowerEstimate reported;  ///< above idle if specified
};

/// A component as measured.
struct ComponentOutput {
    const compute::ComponentEstimate& component;
    const ProfileOutput& profile;
};

Fields<NodeOutput> record_fields(const NodeOutput*) {
    using R = NodeOutput;
    return list_fields<R>(field(
                              "qos", [](const R& r) { return r.node.qos; }, "parameters of the configuration"),
                          embedded([](const R& r) { return &r.reported; }),
                          field(
                              "total_power_w", [](const R& r) { return r.node.total.power_w; }, "with the idle power"));
}

Fields<ComponentOutput> record_fields(const ComponentOutput*) {
    using R = ComponentOutput;
    const auto nodes = [](const R& r) {
        std::vector<NodeOutput> all;
        for (const auto& node : r.component.nodes) {
            auto reported = reported_power(node.total, r.profile.outcome.idle, r.profile.above_idle);
            auto estimate = node.total;
            estimate.power_w = reported.power_w;
            estimate.standard_error_w = reported.standard_error_w;
            estimate.energy_j = reported.power_w * node.total.duration_s;
            all.push_back({node, estimate});
        }
        return all;
    };
    return {field(
                "name", [](const R& r) { return r.component.name; }, "name of the component"),
            field(
                "parameters", [](const R& r) { return r.component.parameters; }, "names of its parameters"),
            field("nodes", nodes, "configurations"),
            field(
                "failures", [](const R& r) { return r.component.failures; }, "failed runs")};
}

}  // namespace

Fields<ProfileOutput> record_fields(const ProfileOutput*) {
    using R = ProfileOutput;
    const auto components = [](const R& r) {
        std::vector<ComponentOutput> all;
        for (const auto& component : r.outcome.components) all.push_back({component, r});
        return all;
    };
    return {field(
                "sampler", [](const R& r) { return r.outcome.sampler; }, "the power sensor"),
            field("above_idle", &R::above_idle, "powers are above the idle power"),
            field(
                "idle", [](const R& r) { return r.outcome.idle; }, "idle power", optional_key{}),
            field(
                "sampling_interval", [](const R& r) { return r.outcome.jitter; }, "interval between samples"),
            field("components", components, "components")};
}

std::string profile_text(const compute::ProfileOutcome& outcome, bool above_idle, const Screen& screen) {
    std::string text;
    if (outcome.idle) {
        text += fmt::format("idle: {:.4f} W, standard error {} W, {} samples in {:.2f} s\n", outcome.idle->power_w,
                            compute::number_or(outcome.idle->standard_error_w, 4, "-"), outcome.idle->samples,
                            outcome.idle->duration_s);
    }
    text += fmt::format("sampling interval: mean {:.4f} s, standard deviation {:.4f} s, longest {:.4f} s\n",
                        outcome.jitter.mean_s, outcome.jitter.sd_s, outcome.jitter.max_s);
    for (const auto& component : outcome.components) {
        text += fmt::format("\n{}{}\n", component.name, above_idle ? ", above idle" : "");
        text += component_table(component, outcome, above_idle, screen);
        for (const auto& run : component.failures) {
            text +=
                fmt::format("{} repeat {} {}: {}\n", run.configuration, run.repeat, to_string(run.status), run.note);
        }
    }
    return text;
}

std::string interpolation_text(const std::string& file, std::size_t nodes, const compute::LeaveOneOutErrors& error,
                               const Screen& screen) {
    TextTable table;
    table.header = {"nodes found from the others", "mean |error| W", "mean |error| %", "RMS W", "largest W"};
    table.rows.push_back({fmt::format("{} of {}", error.nodes, nodes), fixed(error.mean_absolute_w, 4),
                          compute::number_or(error.mean_absolute_percent, 2, "-"), fixed(error.rms_w, 4),
                          fixed(error.largest_w, 4)});
    return file + "\n" + screen_text(table, screen);
}

}  // namespace flightwatt::cli
