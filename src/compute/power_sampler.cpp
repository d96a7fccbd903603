#include "compute/power_sampler.h"

#include <algorithm>

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

}  // namespace flightwatt::compute
