#include "compute/profiling/sampler_settings_toml.h"

#include "base/toml_numbers.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

std::string kind_of(const TomlTable& table) {
    auto kind = table.optional_string("kind").value_or(table.has("command") ? "command"
                                                       : table.has("file")  ? "recorded"
                                                                            : "auto");
    const bool known = kind == "ina3221" ||
                       std::find(sampler_kinds.begin(), sampler_kinds.end(), kind) != sampler_kinds.end();
    if (!known) {
        const auto near = nearest_word(kind, sampler_kinds);
        throw InputError(table.where("kind"), fmt::format("there is no sampler '{}'", kind),
                         near.empty() ? fmt::format("there are {}", fmt::join(sampler_kinds, ", "))
                                      : fmt::format("did you mean '{}'?", near));
    }
    return kind;
}

/// A setting of another kind of sampler would do nothing.
void refuse_foreign_key(const TomlTable& table, std::string_view key, const std::string& kind,
                        std::string_view its_kind) {
    if (!table.has(key) || kind == its_kind) return;
    throw InputError(table.where(key),
                     fmt::format("{} belongs to the sampler '{}', not to '{}'", key, its_kind, kind));
}

}  // namespace

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
    refuse_foreign_key(table, "command", settings.kind, "command");
    refuse_foreign_key(table, "file", settings.kind, "recorded");
    refuse_foreign_key(table, "idle_file", settings.kind, "recorded");
    if (settings.kind == "command") {
        settings.command = table.strings("command");
        if (settings.command.empty()) throw InputError(table.where("command"), "an empty command");
    }
    if (settings.kind == "recorded") settings.file = table.string("file");
    settings.idle_file = table.optional_string("idle_file").value_or("");
    return settings;
}

}  // namespace flightwatt::compute
