#include "compute/sensors/power_sampler.h"

#include "base/toml_reader.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// In the order of SamplerKind; the last one is another name for two of the others, and is not advertised.
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

/// A setting of another kind of sampler would do nothing.
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

}  // namespace flightwatt::compute
