#include "cli/output/aircraft_choice.h"

#include "base/error.h"
#include "cli/terminal.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

std::vector<std::string> names_of(const batch::AircraftGroup& group, FlownAircraft flights) {
    std::vector<std::string> names;
    for (const auto number : group.flights) names.push_back(flights[number].flight);
    return names;
}

void warn_of_uncertain(const StageCall& call, const batch::AircraftGroup& group, FlownAircraft flights) {
    const auto text =
        fmt::format("not used: may be of {}: nothing in the log contradicts either", fmt::join(group.may_be, " or "));
    for (const auto& name : names_of(group, flights))
        add_diagnostic(call, {Severity::warning, "of an uncertain aircraft", text, name});
}

}  // namespace

std::string show_aircraft(const StageCall& call, AircraftGroups groups, FlownAircraft flights, bool has_each) {
    constexpr std::size_t max_command = 200;  // characters; the names of many files are left out
    const auto& most = *std::ranges::max_element(groups, {}, [](const auto& group) { return group.flights.size(); });
    const auto one = " --aircraft " + shell_quoted(most.selector);
    const auto command = call.command.size() > max_command ? std::string("the same command, with") : call.command;
    print_lines(aircraft_table(groups, flights, terminal_columns(stderr)));
    print_lines(fmt::format("for one of them:  {}{}\n", command, one));
    const bool is_folder = call.output && std::filesystem::path(*call.output).extension().empty();
    if (has_each && is_folder) print_lines(fmt::format("for each:         {} --each\n", command));
    if (has_each && !is_folder) print_lines("for each:         the same command, with --each -o FOLDER\n");
    return fmt::format(
        "the flights are of {} aircraft; choose one with --aircraft{}, or use all as if they were of one "
        "with --mix-aircraft",
        groups.size(), has_each ? " or each with --each" : "");
}

void note_other_flights(const StageCall& call, AircraftGroups groups, const batch::AircraftGroup& chosen,
                        FlownAircraft flights) {
    std::vector<std::string> others;
    for (const auto& group : groups) {
        if (&group == &chosen) continue;
        if (std::ranges::find(group.may_be, chosen.selector) != group.may_be.end())
            warn_of_uncertain(call, group, flights);
        else
            std::ranges::move(names_of(group, flights), std::back_inserter(others));
    }
    if (!others.empty()) note(call, fmt::format("not used, as of other aircraft: {}", short_list(others)));
}

ChosenAircraft choose_aircraft(const StageCall& call, const std::optional<std::string>& aircraft,
                               batch::BatchFlights& flights) {
    ChosenAircraft chosen{fitted_aircraft(flights), {}};
    chosen.groups = batch::group_aircraft(chosen.flights);
    if (!aircraft || chosen.groups.empty()) return chosen;
    const auto& group = find_aircraft(*aircraft, chosen.groups, chosen.flights);
    note_other_flights(call, chosen.groups, group, chosen.flights);
    chosen.others = keep_aircraft(flights, group, chosen.flights);
    return chosen;
}

Fields<AircraftFolder> record_fields(const AircraftFolder*) {
    using R = AircraftFolder;
    return {field("aircraft", &R::aircraft, "text for --aircraft"), field("folder", &R::folder, "folder of its batch"),
            field("flights", &R::flights, "flights of its fit, as in logs; its folder counts logs of one name apart"),
            field("has_model", &R::has_model, "a model was fitted")};
}

std::vector<batch::AircraftGroup> certain_aircraft(const StageCall& call, AircraftGroups groups,
                                                   FlownAircraft flights) {
    std::vector<batch::AircraftGroup> certain;
    for (const auto& group : groups) {
        group.may_be.empty() ? certain.push_back(group) : warn_of_uncertain(call, group, flights);
        if (group.id.empty() && group.name.empty()) continue;
        for (const auto number : group.flights)
            if (const auto& flight = flights[number]; flight.id.empty() && flight.name.empty())
                warn(call, fmt::format("{}: its log names no aircraft: it is taken as a flight of {}, which nothing "
                                       "contradicts; --exclude {} leaves it out",
                                       flight.flight, flight::describe_aircraft(group.id, group.name), flight.flight));
    }
    return certain;
}

std::string file_name_of(std::string selector) {
    const auto is_unusual = [](unsigned char c) { return c < 0x80 && std::isalnum(c) == 0 && c != '-' && c != '_'; };
    std::ranges::replace_if(selector, is_unusual, '_');
    return selector;
}

std::vector<std::string> files_of_aircraft(const StageCall& call, const std::vector<std::string>& files,
                                           flight::LoadOptions options) {
    if (!options.aircraft) return files;
    options.aircraft_required = false;
    std::vector<std::string> chosen;
    std::vector<std::string> readable;
    std::vector<batch::FlightAircraft> flown;
    for (const auto& file : files) {
        try {
            flown.push_back(batch::aircraft_of(flight::load_flight(std::filesystem::path(file), options)));
            readable.push_back(file);
        } catch (const InputError&) {
            chosen.push_back(file);  // the stage reports it
        }
    }
    if (flown.empty()) return files;
    const auto groups = batch::group_aircraft(flown);
    const auto& group = find_aircraft(*options.aircraft, groups, flown);
    note_other_flights(call, groups, group, flown);
    for (const auto number : group.flights) chosen.push_back(readable[number]);
    std::ranges::sort(chosen, {}, [&](const auto& file) { return std::ranges::find(files, file) - files.begin(); });
    return chosen;
}

}  // namespace flightwatt::cli
