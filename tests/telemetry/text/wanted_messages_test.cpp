#include "telemetry/text/wanted_messages.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

std::uint8_t find(const MessageNameSet& wanted, const std::string& name) {
    const auto padded = name + "\nthe text goes on";
    return wanted.find(std::string_view(padded).substr(0, name.size()));
}

TEST(WantedMessages, FindsNamesOfEveryLengthAndNoOthers) {
    std::vector<std::string> names;
    MessageNameSet wanted;
    for (std::size_t size = 1; size <= 40; ++size) wanted.add(names.emplace_back(size, 'A'));
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(find(wanted, names[i]), i);
        auto other = names[i];
        for (std::size_t at = 0; at < other.size(); ++at) {
            other[at] = 'B';
            EXPECT_EQ(find(wanted, other), MessageNameSet::none) << other;
            other[at] = 'A';
        }
    }
    EXPECT_EQ(find(wanted, ""), MessageNameSet::none);
    EXPECT_EQ(find(wanted, std::string(41, 'A')), MessageNameSet::none);
}

}  // namespace
}  // namespace flightwatt::telemetry
