#include "report/sections/exclusions.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {

TextTable exclusions_table(std::span<const Exclusion> exclusions) {
    constexpr std::size_t max_names = 10;
    std::vector<std::vector<const Exclusion*>> groups;
    for (const auto& exclusion : exclusions) {
        const auto same = std::ranges::find_if(groups, [&](const auto& group) {
            return group.front()->from == exclusion.from && group.front()->reason == exclusion.reason;
        });
        (same == groups.end() ? groups.emplace_back() : *same).push_back(&exclusion);
    }
    TextTable table{{"flights", "number", "not used", "reason"}, {}};
    for (const auto& group : groups) {
        std::vector<std::string> names;
        names.reserve(group.size());
        for (const auto* exclusion : group) names.push_back(exclusion->flight);
        if (names.size() > max_names) {
            names.resize(max_names);
            names.push_back(fmt::format("{} more", group.size() - max_names));
        }
        table.rows.push_back({fmt::format("{}", fmt::join(names, ", ")), fmt::format("{}", group.size()),
                              group.front()->from, group.front()->reason});
    }
    return table;
}

}  // namespace flightwatt::report
