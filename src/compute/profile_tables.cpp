#include "compute/profile_tables.h"

#include "base/atomic_file.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

std::string comments_of(const ComponentEstimate& component, const ProfileOutcome& outcome,
                        const ProfileSpecification& specification) {
    std::string text = fmt::format("# Power of {}, profiled by flightwatt after {}; sampled by {}\n", component.name,
                                   specification.file, outcome.sampler);
    if (specification.above_idle) {
        text += fmt::format(
            "# power_w is the power above that of the idle computer, {:.5g} W (idle.csv, a component of its own)\n",
            outcome.idle->power_w);
    } else if (outcome.idle) {
        text += fmt::format(
            "# power_w includes the idle computer, {:.5g} W: in a mission, at most one component may include it\n",
            outcome.idle->power_w);
    } else {
        text += "# power_w includes the idle computer, whose power was not measured\n";
    }
    for (const auto& run : component.failures) {
        text += fmt::format("# {} repeat {} {}: {}\n", run.configuration, run.repeat, to_string(run.status), run.note);
    }
    return text;
}

std::string row_of(const NodeEstimate& node, const std::optional<PowerEstimate>& idle, bool above_idle) {
    const auto reported = reported_power(node.total, idle, above_idle);
    std::string row;
    for (const double value : node.qos) row += fmt::format("{},", value);
    row += fmt::format("{:.6f},{},{:.6f},", reported.power_w, number_or(reported.standard_error_w, 6, ""),
                       node.total.power_w);
    if (idle) row += fmt::format("{:.6f},", node.total.power_w - idle->power_w);
    return row + fmt::format("{:.6f},{:.6f},{},{}\n", node.total.duration_s, reported.power_w * node.total.duration_s,
                             node.total.samples, node.total.repeats);
}

/// The idle computer as a component without parameters, for missions of profiles above it.
std::string idle_csv(const PowerEstimate& idle) {
    return fmt::format(
        "# Power of the idle computer, before the components ran\n"
        "power_w,standard_error_w,above_idle_power_w,duration_s,energy_j,samples\n{:.6f},{},0,{:.6f},{:.6f},{}\n",
        idle.power_w, number_or(idle.standard_error_w, 6, ""), idle.duration_s, idle.energy_j, idle.samples);
}

}  // namespace

std::string number_or(double value, int decimals, const std::string& unknown) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : unknown;
}

ReportedPower reported_power(const PowerEstimate& total, const std::optional<PowerEstimate>& idle, bool above_idle) {
    if (!above_idle) return {total.power_w, total.standard_error_w};
    return {total.power_w - idle->power_w, std::hypot(total.standard_error_w, idle->standard_error_w)};
}

std::string layer2_csv(const ComponentEstimate& component, const ProfileOutcome& outcome,
                       const ProfileSpecification& specification) {
    auto text = comments_of(component, outcome, specification);
    for (const auto& name : component.parameters) text += name + ",";
    text += "power_w,standard_error_w,total_power_w,";
    if (outcome.idle) text += "above_idle_power_w,";
    text += "duration_s,energy_j,samples,repeats\n";
    for (const auto& node : component.nodes) text += row_of(node, outcome.idle, specification.above_idle);
    return text;
}

void write_profiles(const ProfileOutcome& outcome, const ProfileSpecification& specification,
                    const std::filesystem::path& folder) {
    if (outcome.idle) write_file_atomically(folder / "idle.csv", idle_csv(*outcome.idle));
    for (const auto& component : outcome.components) {
        const auto path = folder / (component.name + ".csv");
        if (component.nodes.empty()) {
            std::error_code error;
            std::filesystem::remove(path, error);  // of an earlier call
            if (error) throw OutputError(fmt::format("cannot remove {}: {}", path.string(), error.message()));
            continue;
        }
        write_file_atomically(path, layer2_csv(component, outcome, specification));
    }
}

}  // namespace flightwatt::compute
