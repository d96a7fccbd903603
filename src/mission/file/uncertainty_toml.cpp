#include "mission/file/uncertainty_toml.h"

#include "base/toml_numbers.h"

namespace flightwatt::mission {
namespace {

std::optional<double> optional_sd(const TomlTable& table, std::string_view key) {
    return optional_number_in(at_least(0.0), table, key);
}

flight::PerPhase<std::optional<double>> read_phases(const TomlTable& uncertainty, std::string_view key) {
    flight::PerPhase<std::optional<double>> phases;
    const auto table = uncertainty.optional_table(key);
    if (!table) return phases;
    for (const auto phase : flight::all_phases) phases[phase] = optional_sd(*table, to_string(phase));
    table->refuse_unknown_keys();
    return phases;
}

}  // namespace

Uncertainty read_uncertainty(const TomlTable& mission, const compute::ComputeModel& compute,
                             bool has_mechanical) {
    Uncertainty read;
    read.compute_sd_percent.resize(compute.components.size());
    const auto table = mission.optional_table("uncertainty");
    if (!table) return read;
    table->refuse_keys_except(
        {"level_sd_percent", "duration_sd_s", "compute_sd_percent", "capacity_sd_percent"});
    if (table->has("level_sd_percent") && !has_mechanical) {
        throw InputError(table->where("level_sd_percent"),
                         "level_sd_percent has no meaning with mechanical = \"none\"", "leave it out");
    }
    read.level_sd_percent = read_phases(*table, "level_sd_percent");
    read.duration_sd_s = read_phases(*table, "duration_sd_s");
    read.capacity_sd_percent = optional_sd(*table, "capacity_sd_percent");
    if (const auto components = table->optional_table("compute_sd_percent")) {
        for (std::size_t i = 0; i < compute.components.size(); ++i)
            read.compute_sd_percent[i] = optional_sd(*components, compute.components[i].name);
        components->refuse_unknown_keys();
    }
    return read;
}

}  // namespace flightwatt::mission
