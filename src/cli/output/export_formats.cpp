#include "cli/output/export_formats.h"

#include "base/error.h"
#include "base/toml_reader.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

constexpr std::array kind_names{"log or series", "mechanical model", "battery", "mission", "folder"};

std::string name_of(ExportKind kind) { return kind_names.at(static_cast<std::size_t>(kind)); }

struct Format {
    std::string name;
    std::string ending;  ///< of -o that means it; may be empty
    std::set<ExportKind> kinds;
};

const std::vector<Format>& formats() {
    using enum ExportKind;
    static const std::vector<Format> all{{"geojson", ".geojson", {flight}},
                                         {"kml", ".kml", {flight}},
                                         {"gpx", ".gpx", {flight}},
                                         {"csv", ".csv", {flight}},
                                         {"json", ".json", {model, battery}},
                                         {"c", ".h", {model}},
                                         {"px4", ".params", {model, battery, mission}},
                                         {"inav", "", {model, battery, mission}},
                                         {"paparazzi", "", {model, battery, mission}},
                                         {"paparazzi-map", "", {battery, mission}},
                                         {"latex", ".tex", {model, battery, mission, batch}}};
    return all;
}

ExportKind kind_of(const std::string& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) return ExportKind::batch;
    if (std::filesystem::path(file).extension() != ".toml") return ExportKind::flight;
    const auto root = read_toml(file);
    if (root.has("battery") || root.has("mechanical")) return ExportKind::mission;
    return root.has("resistance_ohm") || root.has("voltage_v") || root.has("capacity_ah") ? ExportKind::battery
                                                                                          : ExportKind::model;
}

std::string format_names() {
    std::vector<std::string> names;
    for (const auto& format : formats()) names.push_back(format.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

const Format& format_of(const StageCall& call) {
    const auto name = call.get_optional<std::string>("format");
    const auto ending = call.output ? std::filesystem::path(*call.output).extension().string() : "";
    for (const auto& format : formats())
        if (name ? format.name == *name : !ending.empty() && format.ending == ending) return format;
    if (name) throw UsageError(fmt::format("--format {}: expected one of {}", *name, format_names()));
    throw UsageError(
        fmt::format("expected -o FILE that ends in .geojson, .kml, .gpx, .csv, .json, .h, .params or .tex, or "
                    "--format NAME, one of {}",
                    format_names()));
}

/// What a kind of input can become.
std::string forms_of(ExportKind kind) {
    std::vector<std::string> names;
    for (const auto& format : formats())
        if (format.kinds.contains(kind)) names.push_back(format.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void require_fitting(const ExportInput& input, const Format& format) {
    if (format.kinds.contains(input.kind)) return;
    auto hint = fmt::format("a {} becomes {}", name_of(input.kind), forms_of(input.kind));
    if (input.kind == ExportKind::mission && format.name == "csv")
        hint = fmt::format("its state of charge over time is: flightwatt simulate {} -o FILE.csv", input.file);
    if (input.kind == ExportKind::batch)
        hint = "one of flightwatt batch becomes latex, and its model is model.toml in it";
    throw InputError({input.file}, fmt::format("is a {}, of which no {} is made", name_of(input.kind), format.name),
                     hint);
}

/// Refuses options that the format does not use.
void refuse_idle_options(const StageCall& call, const Format& format) {
    const std::set<std::string> tracks{"geojson", "kml", "gpx"};
    const std::set<std::string> parameters{"px4", "inav", "paparazzi", "paparazzi-map"};
    std::map<std::string, std::set<std::string>> users{
        {"colour", tracks},       {"message", {"csv"}},
        {"cells", parameters},    {"parallel", {"paparazzi", "paparazzi-map"}},
        {"idle-power", {"inav"}}, {"replay", {"latex"}},
        {"capacity", {"latex"}}};
    for (const auto* option : {"aircraft", "sortie", "exclude", "keep", "correct-idle-offset", "messages"})
        users[option] = {"geojson", "kml", "gpx", "csv"};
    for (const auto& [option, names] : users) {
        if (!call.has(option) || names.contains(format.name)) continue;
        throw UsageError(
            fmt::format("--{} is of no use to {}: it is for {}", option, format.name, fmt::join(names, ", ")));
    }
}

/// One input, but for tables of several missions with or without a batch, and parameters from a model and a battery.
void require_few(const std::vector<ExportInput>& inputs, const Format& format) {
    if (inputs.size() == 1) return;
    const auto all = [&](ExportKind kind) {
        return std::ranges::all_of(inputs, [&](const auto& in) { return in.kind == kind; });
    };
    const auto of_kind = [&](ExportKind kind) {
        return static_cast<std::size_t>(std::ranges::count(inputs, kind, &ExportInput::kind));
    };
    const bool tables = format.name == "latex" && of_kind(ExportKind::batch) <= 1 &&
                        of_kind(ExportKind::batch) + of_kind(ExportKind::mission) == inputs.size();
    const std::set<std::string> of_both{"px4", "inav", "paparazzi"};
    const bool pair = inputs.size() == 2 && of_both.contains(format.name) && inputs[0].kind != inputs[1].kind &&
                      !all(ExportKind::mission) && inputs[0].kind != ExportKind::mission &&
                      inputs[1].kind != ExportKind::mission;
    if (tables || pair) return;
    throw UsageError(fmt::format("{} is made of one input{}", format.name,
                                 format.name == "latex"          ? ", or of missions and one folder of flightwatt batch"
                                 : of_both.contains(format.name) ? ": a mission, or a model and a battery"
                                                                 : ""));
}

}  // namespace

ExportRequest read_export_request(const StageCall& call) {
    const auto& format = format_of(call);
    refuse_idle_options(call, format);
    ExportRequest request{format.name, {}};
    for (const auto& file : call.inputs) request.inputs.push_back({file, kind_of(file)});
    for (const auto& input : request.inputs) require_fitting(input, format);
    require_few(request.inputs, format);
    return request;
}

}  // namespace flightwatt::cli
