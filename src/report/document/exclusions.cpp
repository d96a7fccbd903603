#include "report/document/exclusions.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {

Fields<ExclusionGroup> record_fields(const ExclusionGroup*) {
    using R = ExclusionGroup;
    const auto names = [](const R& group) { return fmt::format("{}", fmt::join(group.flights, ", ")); };
    return {field("flight_names", names, "", column{"flights"}, not_in_json{}), field("flights", &R::flights),
            field("number", &R::number, "", column{}), field("not_used", &R::from, "", column{"not used"}),
            field("reason", &R::reason, "", column{})};
}

std::vector<ExclusionGroup> group_exclusions(std::span<const Exclusion> exclusions) {
    constexpr std::size_t max_names = 10;
    std::vector<ExclusionGroup> groups;
    for (const auto& [flight, from, reason] : exclusions) {
        const auto same = std::ranges::find_if(groups, [&, &from = from, &reason = reason](const auto& group) {
            return group.from == from && group.reason == reason;
        });
        auto& group = same == groups.end() ? groups.emplace_back(ExclusionGroup{{}, 0, from, reason}) : *same;
        if (++group.number <= max_names) group.flights.push_back(flight);
    }
    for (auto& group : groups)
        if (group.number > max_names) group.flights.push_back(fmt::format("{} more", group.number - max_names));
    return groups;
}

}  // namespace flightwatt::report
