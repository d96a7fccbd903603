#include "path/plan_blocks.h"

#include "base/text.h"
#include "base/toml_reader.h"
#include "path/plans/block_reader.h"
#include "path/plans/flight_plan.h"
#include "path/plans/mission_files.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::path {
namespace {

std::vector<std::string> block_names(const FlightPlan& plan) {
    std::vector<std::string> names;
    for (const auto& block : plan.root.child("blocks").children("block")) names.push_back(attribute(block, "name"));
    return names;
}

/// Names of the procedures whose blocks are in other files.
std::vector<std::string> included_procedures(const FlightPlan& plan) {
    std::vector<std::string> names;
    for (const auto& include : plan.root.child("includes").children("include"))
        names.push_back(attribute(include, "procedure"));
    return names;
}

std::size_t block_number(const FlightPlan& plan, const std::string& name) {
    const auto names = block_names(plan);
    const auto found = std::ranges::find(names, name);
    if (found != names.end() && std::ranges::count(names, name) == 1)
        return static_cast<std::size_t>(found - names.begin());
    if (found != names.end())
        throw InputError({plan.file}, fmt::format("there are several blocks '{}'", name),
                         "give each a name of its own");
    const auto near = nearest_word(name, names);
    const auto known = names.empty() ? "the plan has no blocks" : "the plan has " + short_list(names);
    const auto procedures = included_procedures(plan);
    throw InputError({plan.file}, fmt::format("there is no block '{}'", name),
                     (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) + known +
                         (procedures.empty() ? "" : "; blocks of " + short_list(procedures) + " are not read"));
}

/// Over the ground; no rate or altitude is needed for it. Adds what leaves the plan's fence to the remarks.
FlightPath path_over_ground(const PlanEntries& plan, std::vector<std::string>& remarks) {
    auto entries = plan.entries;
    entries.emplace_back().hold_s = 1.0;  // without it a single position is no path
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 1.0;
    defaults.altitude_m = 0.0;
    defaults.rates = {1.0, 1.0};
    defaults.starts_at_first_place = plan.starts_at_first_place;
    auto path = build_path(entries, defaults);
    if (const auto origin = path_origin(entries, defaults))
        for (auto& note : fence_notes(plan.fence, path, *origin)) remarks.push_back(std::move(note));
    return path;
}

/// The block with what its entries fly; an InputError of `read` becomes the reason why it is not flown.
template <typename Read>
PlanBlock summarised(PlanBlock block, const Read& read) {
    try {
        const auto plan = read();
        block.not_flown = plan.not_flown;
        if (plan.entries.empty() && block.not_flown.empty()) block.not_flown.emplace_back("no movement");
        if (plan.entries.empty()) return block;
        double circles = 0.0;
        std::size_t legs = 0, holds = 0;
        for (const auto& element : path_over_ground(plan, block.not_flown).elements) {
            if (const auto* circle = std::get_if<Circles>(&element.shape)) {
                circles += circle->turns;
                block.length_m += 2.0 * std::numbers::pi * circle->radius_m * circle->turns;
            } else if (const auto* leg = std::get_if<Leg>(&element.shape)) {
                ++legs;
                block.length_m += leg->length_m;
            }
        }
        for (const auto& entry : plan.entries)
            if (entry.hold_s) ++holds;
        std::vector<std::string> parts;
        if (legs > 0) parts.push_back(fmt::format("{} leg{}", legs, legs == 1 ? "" : "s"));
        if (circles > 0.0) parts.push_back(fmt::format("{:.4g} circle{}", circles, circles == 1.0 ? "" : "s"));
        if (holds > 0) parts.push_back(fmt::format("{} hold{}", holds, holds == 1 ? "" : "s"));
        block.flown = parts.empty() ? "a position" : fmt::format("{}", fmt::join(parts, ", "));
    } catch (const InputError& error) {
        block.not_flown.push_back(fmt::format(
            "{}{}", error.where().line > 0 ? fmt::format("line {}: ", error.where().line) : "", error.what()));
        if (!error.hint().empty()) block.not_flown.back() += "; " + error.hint();
        block.flown.clear();
        block.length_m = 0.0;
    }
    return block;
}

/// Every block of a flight plan.
std::vector<PlanBlock> flight_plan_blocks(std::string_view text, const std::string& file,
                                          const AutopilotSettings& settings) {
    const auto plan = load_flight_plan(text, file);
    std::vector<PlanBlock> all;
    for (const auto& node : plan.root.child("blocks").children("block")) {
        all.push_back(summarised({attribute(node, "name"), where(plan, node).line}, [&] {
            BlockState state;
            auto not_flown = read_block(plan, node, settings, state).all;
            return PlanEntries{std::move(state.entries), std::move(not_flown), {}, true};
        }));
    }
    for (const auto& procedure : included_procedures(plan))
        all.push_back({procedure, 0, "", 0.0, {"a procedure in another file, whose blocks are not read"}});
    return all;
}

}  // namespace

PlanFormat plan_format(std::string_view text) {
    text = without_byte_order_mark(text);
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.starts_with('<')) return PlanFormat::flight_plan;
    if (text.starts_with('{')) return PlanFormat::qgroundcontrol;
    return text.starts_with("QGC WPL") ? PlanFormat::ardupilot : PlanFormat::none;
}

std::vector<PlanBlock> parse_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings) {
    const auto format = plan_format(text);
    if (format == PlanFormat::flight_plan) return flight_plan_blocks(text, file, settings);
    auto plan =
        format == PlanFormat::ardupilot ? parse_wpl(text, file, settings) : parse_qgc_plan(text, file, settings);
    return {summarised({"mission"}, [&] { return std::move(plan); })};
}

PlanEntries parse_plan_blocks(std::string_view text, const std::string& file, const std::vector<std::string>& blocks,
                              const AutopilotSettings& settings) {
    const auto plan = load_flight_plan(text, file);
    BlockState state;
    const auto nodes = plan.root.child("blocks").children("block");
    PlanEntries result;
    result.starts_at_first_place = true;
    for (const auto& name : blocks) {
        const auto block = *std::next(nodes.begin(), static_cast<std::ptrdiff_t>(block_number(plan, name)));
        const auto before = state.entries.size();
        const auto not_flown = read_block(plan, block, settings, state);
        const auto remarks = fmt::format("{}", fmt::join(not_flown.all, "; "));
        for (const auto& text : not_flown.missing) result.missing.push_back(fmt::format("block '{}': {}", name, text));
        if (state.entries.size() == before)
            throw InputError(where(plan, block), fmt::format("block '{}' has no movement that can be flown", name),
                             remarks.empty() ? "name other blocks" : remarks);
        if (!remarks.empty()) result.not_flown.push_back(truncated(fmt::format("block '{}': {}", name, remarks)));
    }
    if (plan.root.child("exceptions").child("exception"))
        result.not_flown.emplace_back("the plan's exceptions are not followed");
    result.entries = std::move(state.entries);
    return result;
}

std::pair<GeodeticPosition, std::optional<double>> flight_plan_origin(std::string_view text, const std::string& file) {
    const auto plan = load_flight_plan(text, file);
    return {origin_of(plan), evaluate(plan, "ground_alt")};
}

std::vector<PathEntry> parse_flight_plan(std::string_view text, const std::string& file,
                                         const std::vector<std::string>& names) {
    const auto plan = load_flight_plan(text, file);
    std::vector<PathEntry> entries;
    entries.reserve(names.size());
    for (const auto& name : names) entries.push_back(waypoint_entry(plan, waypoint_number(plan, name, {file})));
    return entries;
}

}  // namespace flightwatt::path
