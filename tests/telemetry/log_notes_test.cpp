#include "telemetry/log_notes.h"

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

TEST(SkippedLines, AreCountedOverAllTimes) {
    const SkippedLines three{"GPS: unknown", {{1.5, 1, 17}, {2.0, 2, 12}}};
    EXPECT_EQ(three.count(), 3U);
    EXPECT_EQ(three.first_line(), 12U);
    EXPECT_EQ(describe(three), "GPS: unknown: 3 lines, first at line 12");
    EXPECT_EQ(describe({"the last line is cut off", {{1.5, 1, 17}}}),
              "the last line is cut off: 1 line, first at line 17");
    EXPECT_EQ(SkippedLines{}.first_line(), 0U);
}

TEST(CurrentOrigin, IsNamedForPeople) {
    EXPECT_EQ(to_string(CurrentOrigin::sensor), "measured by a sensor");
    EXPECT_EQ(to_string(CurrentOrigin::throttle), "computed from throttle");
    EXPECT_EQ(to_string(CurrentOrigin::unknown), "unknown");
}

}  // namespace
}  // namespace flightwatt::telemetry
