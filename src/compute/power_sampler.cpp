#include "compute/power_sampler.h"

#include "base/toml_reader.h"
#include "compute/sensors/power_rails.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// In the order of SamplerKind.
const std::vector<std::string> kind_names{"auto", "ina3221", "rapl", "command", "recorded"};

SamplerKind kind_of(const TomlTable& table) {
    const auto name = table.optional_string("kind");
    if (!name) {
        return table.has("command") ? SamplerKind::command
               : table.has("file")  ? SamplerKind::recorded
                                    : SamplerKind::automatic;
    }
    const auto known = std::ranges::find(kind_names, *name);
    if (known != kind_names.end()) return static_cast<SamplerKind>(known - kind_names.begin());
    const auto near = nearest_word(*name, kind_names);
    throw InputError(table.where("kind"), fmt::format("there is no sampler '{}'", *name),
                     near.empty() ? fmt::format("there are {}", fmt::join(kind_names, ", "))
                                  : fmt::format("did you mean '{}'?", near));
}

/// Refuses a key that has no effect with this kind.
void refuse_foreign_key(const TomlTable& table, std::string_view key, SamplerKind kind, SamplerKind its_kind) {
    if (!table.has(key) || kind == its_kind) return;
    throw InputError(table.where(key), fmt::format("{} belongs to the sampler '{}', not to '{}'", key,
                                                   to_string(its_kind), to_string(kind)));
}

}  // namespace

std::string_view to_string(SamplerKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

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
};

PowerSampler sampler_of(const Sensor& sensor, const std::vector<std::string>& wanted) {
    std::vector<PowerRail> chosen;
    std::vector<std::string> names;
    std::vector<std::string> sources;
    for (const auto& rail : sensor.rails) names.push_back(rail.name);
    for (const auto index : rails_of_total(names, wanted)) {
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
    const std::vector<Sensor> sensors{{SamplerKind::ina3221, ina3221_rails(settings.sysfs)},
                                      {SamplerKind::rapl, rapl_rails(settings.sysfs)}};
    for (const auto& sensor : sensors) {
        const bool is_wanted = settings.kind == SamplerKind::automatic || settings.kind == sensor.kind;
        if (is_wanted && !sensor.rails.empty()) return sampler_of(sensor, settings.rails);
    }
    throw NoResultError(fmt::format(
        "there is no {} below {} that can be read; searched for INA3221 (bus/i2c/drivers/ina3221*, bus/iio, "
        "class/hwmon) and RAPL (class/powercap, often for root alone); a [sampler] of kind \"command\" reads any other "
        "meter",
        settings.kind == SamplerKind::automatic ? "power sensor"
                                                : fmt::format("sensor of kind {}", to_string(settings.kind)),
        settings.sysfs.string()));
}

}  // namespace flightwatt::compute
