#include "base/error.h"
#include "flight/flight_identity.h"
#include "report/batch_content.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

using Names = std::vector<std::string>;

bool are_distinct(const Names& names) {
    return std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

/// The folders' own names where they tell them apart, else their paths as given.
Names names_of_folders(std::span<const std::filesystem::path> outs) {
    Names names;
    Names paths;
    for (const auto& out : outs) {
        const auto path = out.lexically_normal();
        paths.push_back(path.string());
        names.push_back((path.has_filename() ? path : path.parent_path()).filename().string());
    }
    return are_distinct(names) ? names : paths;
}

void refuse_one_folder_twice(std::span<const std::filesystem::path> outs) {
    for (std::size_t i = 0; i < outs.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            std::error_code error;
            if (std::filesystem::equivalent(outs[i], outs[j], error))
                throw UsageError(fmt::format("the folder {} is given twice{}", outs[j].string(),
                                             outs[i] == outs[j] ? "" : ", also as " + outs[i].string()));
        }
    }
}

/// Marks flights that an earlier folder holds too; says which.
Names share_flights(std::vector<BatchContent>& batches) {
    flight::SketchIndex known;
    std::vector<ReportFlight*> places;
    Names shared;
    for (auto& batch : batches) {
        for (auto& flight : batch.flights) {
            flight.folders = {batch.folder};
            if (!flight.rejected.empty()) continue;
            auto content = make_sketch(flight.series);
            const auto alike = known.find(content);
            const auto same = std::ranges::find_if(alike, [&](const auto& like) {
                return like.likeness.is_same && places[like.number]->batch != flight.batch;
            });
            if (same == alike.end()) {
                places.push_back(&flight);
                known.add(std::move(content));
                continue;
            }
            auto& first = *places[same->number];
            flight.is_shown_elsewhere = true;
            first.folders.push_back(flight.name == first.name ? batch.folder
                                                              : fmt::format("{} as {}", batch.folder, flight.name));
        }
    }
    for (const auto* flight : places)
        if (flight->folders.size() > 1)
            shared.push_back(fmt::format("{} ({})", flight->name, fmt::join(flight->folders, ", ")));
    return shared;
}

void rename(BatchContent& batch, ReportFlight& flight) {
    const auto renamed = fmt::format("{} ({})", flight.name, batch.folder);
    for (auto& measured : batch.measured) {
        auto& name = measured.samples.flight;
        if (name == flight.name || name.starts_with(flight.name + "#")) name.replace(0, flight.name.size(), renamed);
    }
    for (auto& text : flight.exclusions)
        if (text.starts_with(flight.name + ": ")) text.replace(0, flight.name.size(), renamed);
    flight.name = flight.series.flight = renamed;
}

/// Renames flights of one name that are not one flight; says which.
Names rename_namesakes(std::vector<BatchContent>& batches) {
    std::map<std::string, std::size_t> shown;
    for (const auto& batch : batches)
        for (const auto& flight : batch.flights)
            if (!flight.is_shown_elsewhere) ++shown[flight.name];
    std::erase_if(shown, [](const auto& named) { return named.second < 2; });
    for (auto& batch : batches)
        for (auto& flight : batch.flights)
            if (!flight.is_shown_elsewhere && shown.contains(flight.name)) rename(batch, flight);
    Names names;
    for (const auto& [name, times] : shown) names.push_back(name);
    return names;
}

std::string aircraft_of(const BatchContent& batch) {
    std::set<std::string> aircraft;
    for (const auto& flight : batch.flights)
        if (flight.rejected.empty())
            aircraft.insert(flight::describe_aircraft(flight.series.aircraft_id, flight.series.aircraft_name));
    return fmt::format("{}", fmt::join(aircraft, " and "));
}

/// What the fit was told, but for which flights it was to use.
std::vector<std::pair<std::string, std::string>> told_options(const batch::BatchFit& fit) {
    const auto& options = fit.options;
    Names by_hand;
    for (const auto& weight : options.weights.by_hand)
        by_hand.push_back(fmt::format("{} {:.6g}", weight.flight, weight.weight));
    return {{"order", fmt::format("{}", options.phases.order)},
            {"lowest frequency", fmt::format("{:.6g} rad a phase", options.phases.min_theta_rad)},
            {"most periods", fmt::format("{:.6g} a phase", options.phases.max_periods)},
            {"weights", std::string(to_string(options.weights.weighting))},
            {"weights by hand", by_hand.empty() ? "none" : fmt::format("{}", fmt::join(by_hand, " and "))}};
}

/// "order 3 (a), 2 (b)" for each option in which the fits differ.
Names differing_options(const std::vector<BatchContent>& batches) {
    std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>> told;
    for (const auto& batch : batches)
        if (batch.fit) told.emplace_back(batch.folder, told_options(*batch.fit));
    Names differing;
    for (std::size_t i = 0; told.size() > 1 && i < told.front().second.size(); ++i) {
        const auto differs = [&](const auto& one) { return one.second[i] != told.front().second[i]; };
        if (std::ranges::none_of(told, differs)) continue;
        Names values;
        for (const auto& [folder, options] : told) values.push_back(fmt::format("{} ({})", options[i].second, folder));
        differing.push_back(fmt::format("{} {}", told.front().second[i].first, fmt::join(values, ", ")));
    }
    return differing;
}

}  // namespace

BatchContents read_batch_contents(std::span<const std::filesystem::path> outs) {
    refuse_one_folder_twice(outs);
    BatchContents contents;
    for (const auto& out : outs) contents.batches.push_back(read_batch_content(out));
    if (outs.size() < 2) return contents;
    auto& [batches, notes] = contents;
    const auto names = names_of_folders(outs);
    for (std::size_t i = 0; i < batches.size(); ++i) {
        batches[i].folder = names[i];
        for (auto& flight : batches[i].flights) flight.batch = i;
    }
    if (const auto shared = share_flights(batches); !shared.empty())
        notes.push_back(fmt::format("In several folders, and shown once: {}.", fmt::join(shared, "; ")));
    if (const auto namesakes = rename_namesakes(batches); !namesakes.empty())
        notes.push_back(
            fmt::format("Flights of one name in several folders, which are not the same flight, have their "
                        "folder behind their name: {}.",
                        fmt::join(namesakes, ", ")));
    std::set<std::string> aircraft;
    Names flown;
    for (const auto& batch : batches) {
        const auto& name = *aircraft.insert(aircraft_of(batch)).first;
        if (!name.empty()) flown.push_back(fmt::format("{} ({})", name, batch.folder));
    }
    aircraft.erase("");
    if (aircraft.size() > 1)
        notes.push_back(
            fmt::format("The folders are of different aircraft, each with its own model: {}.", fmt::join(flown, ", ")));
    if (const auto options = differing_options(batches); !options.empty())
        notes.push_back(
            fmt::format("The folders' models were fitted with different options: {}.", fmt::join(options, "; ")));
    return contents;
}

std::vector<ReportFlight> take_shown_flights(std::vector<BatchContent>& batches) {
    std::vector<ReportFlight> flights;
    for (auto& batch : batches) {
        std::erase_if(batch.flights, [](const auto& flight) { return flight.is_shown_elsewhere; });
        std::ranges::move(batch.flights, std::back_inserter(flights));
        batch.flights.clear();
    }
    std::ranges::stable_sort(flights, {}, [](const auto& flight) { return !flight.unusable_power.empty(); });
    return flights;
}

}  // namespace flightwatt::report
