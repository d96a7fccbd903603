#include "flight/log_name.h"

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using namespace std::chrono_literals;

TEST(LogName, TellsWhenTheLogBegan) {
    constexpr auto start = std::chrono::sys_days{2020y / 7 / 5} + 10h + 26min + 44s;
    EXPECT_EQ(start_in_name("20_07_05__10_26_44"), start);
    EXPECT_EQ(start_in_name("field-20_07_05__10_26_44_SD"), start);
}

TEST(LogName, IsNoDateWithoutOne) {
    for (const auto* name : {"", "survey", "20_07_05", "120_07_05__10_26_44", "20_13_05__10_26_44",
                             "20_02_30__10_26_44", "20_07_05__24_26_44", "20_07_05__10_60_44", "20_07_05__10_26_444"})
        EXPECT_FALSE(start_in_name(name)) << name;
}

}  // namespace
}  // namespace flightwatt::flight
