#include "flight/flight_phases.h"

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(Phase, IsFoundByItsNameAlone) {
    for (const auto phase : all_phases) EXPECT_EQ(phase_from(to_string(phase)), phase);
    EXPECT_EQ(phase_from("take-off"), std::nullopt);
    EXPECT_EQ(phase_from("ground"), std::nullopt);
    EXPECT_EQ(phase_from(""), std::nullopt);
}

TEST(PerPhase, HoldsAValueOfEach) {
    PerPhase<double> duration_s{{28.0, 600.0, 60.0}};
    EXPECT_EQ(duration_s[Phase::takeoff], 28.0);
    EXPECT_EQ(duration_s[Phase::landing], 60.0);
    duration_s[Phase::cruise] = 900.0;
    EXPECT_EQ(duration_s[Phase::cruise], 900.0);
}

}  // namespace
}  // namespace flightwatt::flight
