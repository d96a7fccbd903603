#include "compute/power_sampler.h"

#include "base/toml_reader.h"
#include "compute/sensors/power_rails.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// In the order of SamplerKind; error messages do not list the last one, which means two of the others.
const std::vector<std::string_view> kind_names{"auto",         "ina238",  "ina3221-iio", "ina3221-hwmon", "rapl",
                                               "power_supply", "command", "recorded",    "ina3221"};

SamplerKind kind_of(const TomlTable& table) {
    const auto name = table.optional_string("kind");
    if (!name) {
        return table.has("command") ? SamplerKind::command
               : table.has("file")  ? SamplerKind::recorded
                                    : SamplerKind::automatic;
    }
    if (const auto kind = sampler_kind_from(*name)) return *kind;
    const std::vector<std::string> names(kind_names.begin(), kind_names.end() - 1);
    const auto near = nearest_word(*name, names);
    throw InputError(
        table.where("kind"), fmt::format("there is no sampler '{}'", *name),
        near.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : fmt::format("did you mean '{}'?", near));
}

/// Refuses a key that has no effect with this kind.
void refuse_foreign_key(const TomlTable& table, std::string_view key, SamplerKind kind, SamplerKind its_kind) {
    if (!table.has(key) || kind == its_kind) return;
    throw InputError(table.where(key), fmt::format("{} belongs to the sampler '{}', not to '{}'", key,
                                                   to_string(its_kind), to_string(kind)));
}

}  // namespace

std::string_view to_string(SamplerKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

std::optional<SamplerKind> sampler_kind_from(std::string_view name) {
    const auto found = std::ranges::find(kind_names, name);
    if (found == kind_names.end()) return std::nullopt;
    return static_cast<SamplerKind>(found - kind_names.begin());
}

SamplerSettings read_sampler_settings(const TomlTable& root, const std::filesystem::path& folder) {
    SamplerSettings settings;
    settings.folder = folder;
    settings.where = root.where();
    const auto given = root.optional_table("sampler");
    if (!given) return settings;
    const auto& table = *given;
    table.refuse_keys_except({"kind", "interval_s", "rails", "command", "file", "idle_file", "sysfs"});
    settings.where = table.where();
    settings.kind = kind_of(table);
    settings.interval_is_given = table.has("interval_s");
    settings.interval_s = number_in_or(more_than(0.0), table, "interval_s", settings.interval_s);
    if (table.has("rails")) settings.rails = table.strings("rails");
    if (const auto sysfs = table.optional_string("sysfs")) settings.sysfs = settings.folder / *sysfs;
    refuse_foreign_key(table, "command", settings.kind, SamplerKind::command);
    refuse_foreign_key(table, "file", settings.kind, SamplerKind::recorded);
    refuse_foreign_key(table, "idle_file", settings.kind, SamplerKind::recorded);
    if (settings.kind == SamplerKind::command) {
        settings.command = table.strings("command");
        if (settings.command.empty()) throw InputError(table.where("command"), "an empty command");
    }
    if (settings.kind == SamplerKind::recorded) settings.file = table.string("file");
    settings.idle_file = table.optional_string("idle_file").value_or("");
    return settings;
}

namespace {

struct Sensor {
    SamplerKind kind;
    std::vector<PowerRail> rails;

    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& rail : rails) all.push_back(rail.name);
        return all;
    }

    bool is_asked_for(SamplerKind asked) const {
        const bool is_ina3221 = kind == SamplerKind::ina3221_iio || kind == SamplerKind::ina3221_hwmon;
        return asked == SamplerKind::automatic || asked == kind || (asked == SamplerKind::ina3221 && is_ina3221);
    }
};

std::vector<Sensor> probe(const std::filesystem::path& sysfs) {
    return {{SamplerKind::ina238, ina238_rails(sysfs)},
            {SamplerKind::ina3221_iio, iio_rails(sysfs)},
            {SamplerKind::ina3221_hwmon, hwmon_rails(sysfs)},
            {SamplerKind::rapl, rapl_rails(sysfs)},
            {SamplerKind::power_supply, power_supply_rails(sysfs)}};
}

PowerSampler sampler_of(const Sensor& sensor, const std::vector<std::string>& wanted) {
    std::vector<PowerRail> chosen;
    std::vector<std::string> sources;
    for (const auto index : rails_of_total(sensor.names(), wanted)) {
        chosen.push_back(sensor.rails[index]);
        sources.push_back(fmt::format("{} ({})", chosen.back().name, chosen.back().source));
    }
    PowerSampler sampler;
    sampler.kind = sensor.kind;
    sampler.source = fmt::format("{}", fmt::join(sources, " + "));
    sampler.read = [chosen]() -> std::vector<PowerReading> {
        const auto before = std::chrono::steady_clock::now();
        double power_w = 0.0;
        for (const auto& rail : chosen) power_w += rail.read(before);
        if (std::isnan(power_w)) return {};
        // The time stamp is the middle of the reading.
        return {{before + (std::chrono::steady_clock::now() - before) / 2, power_w}};
    };
    return sampler;
}

}  // namespace

PowerSampler open_sampler(const SamplerSettings& settings) {
    if (settings.kind == SamplerKind::command) return open_command_sampler(settings);
    std::error_code none;
    const auto inner = settings.sysfs / "sys";
    const auto sysfs = std::filesystem::is_directory(inner, none) ? inner : settings.sysfs;
    const auto sensors = probe(sysfs);
    for (const auto& sensor : sensors) {
        if (!sensor.is_asked_for(settings.kind) || sensor.rails.empty()) continue;
        auto sampler = sampler_of(sensor, settings.rails);
        for (const auto& found : sensors)
            if (!found.rails.empty())
                sampler.found.push_back(fmt::format("{}: {}", to_string(found.kind), fmt::join(found.names(), ", ")));
        return sampler;
    }
    throw NoResultError(fmt::format(
        "there is no {} below {} that can be read; searched for INA238 and INA3221 (bus/i2c/drivers/ina*, bus/iio, "
        "class/hwmon), RAPL (class/powercap, often for root alone) and class/power_supply; a [sampler] of "
        "kind \"command\" reads any other meter",
        settings.kind == SamplerKind::automatic ? "power sensor"
                                                : fmt::format("sensor of kind {}", to_string(settings.kind)),
        sysfs.string()));
}

}  // namespace flightwatt::compute
