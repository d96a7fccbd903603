#include "cli/output/profile_output.h"

#include "base/text_table.h"
#include "cli/output/records.h"

#include <fmt/format.h>

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
    if (component.nodes.empty()) return "nothing could be measured\n";
    ScreenTable shown{"", component.parameters};
    shown.first.insert(shown.first.end(), {"power_w", "standard_error_w"});
    return screen_text(table, screen, shown);
}

Json to_json(const compute::PowerEstimate& estimate) {
    return {{"power_w", estimate.power_w},       {"standard_error_w", estimate.standard_error_w},
            {"duration_s", estimate.duration_s}, {"energy_j", estimate.energy_j},
            {"samples", estimate.samples},       {"repeats", estimate.repeats}};
}

Json failure_json(const compute::ProfileRun& run) {
    return {{"configuration", run.configuration},
            {"repeat", run.repeat},
            {"status", to_string(run.status)},
            {"note", run.note}};
}

Json to_json(const compute::ComponentEstimate& component, const compute::ProfileOutcome& outcome, bool above_idle) {
    Json json{{"name", component.name}, {"parameters", component.parameters}};
    json["nodes"] = list_json(component.nodes, [&](const auto& node) {
        const auto reported = reported_power(node.total, outcome.idle, above_idle);
        Json entry{{"qos", node.qos}};
        entry.update(to_json(node.total));
        entry["power_w"] = reported.power_w;
        entry["standard_error_w"] = reported.standard_error_w;
        entry["energy_j"] = reported.power_w * node.total.duration_s;
        entry["total_power_w"] = node.total.power_w;
        return entry;
    });
    json["failures"] = list_json(component.failures, failure_json);
    return json;
}

}  // namespace

Json to_json(const compute::LeaveOneOutErrors& error) {
    return {{"nodes", error.nodes},
            {"mean_absolute_error_w", error.mean_absolute_w},
            {"mean_absolute_error_percent", error.mean_absolute_percent},
            {"rms_error_w", error.rms_w},
            {"largest_error_w", error.largest_w}};
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

Json to_json(const compute::ProfileOutcome& outcome, bool above_idle) {
    Json json{{"sampler", outcome.sampler}, {"above_idle", above_idle}};
    if (outcome.idle) json["idle"] = to_json(*outcome.idle);
    json["sampling_interval"] = {{"mean_s", outcome.jitter.mean_s},
                                 {"standard_deviation_s", outcome.jitter.sd_s},
                                 {"longest_s", outcome.jitter.max_s}};
    json["components"] =
        list_json(outcome.components, [&](const auto& component) { return to_json(component, outcome, above_idle); });
    return json;
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
