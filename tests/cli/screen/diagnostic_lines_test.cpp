#include "cli/screen/diagnostic_lines.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using enum Severity;

/// One of this kind in each of so many flights.
Diagnostics in_flights(int count, Severity severity, const std::string& kind) {
    Diagnostics all;
    for (int i = 1; i <= count; ++i)
        all.push_back({severity, kind, fmt::format("{} of {}", kind, i), fmt::format("f{}", i)});
    return all;
}

TEST(DiagnosticLines, HaveOneForAKindOfSeveralFlights) {
    auto all = in_flights(5, warning, "gaps in the power");
    all.push_back({warning, "sensor drift", "it drifts", "f2"});
    all.push_back({warning, "sensor drift", "it drifts again", "f2"});
    all.push_back({note, "cut at power-off", "3 bytes", "f1"});
    EXPECT_THAT(diagnostic_lines(all, false),
                ElementsAre("warning: gaps in the power: 5 logs (f1, f2, f3 and 2 more), the first: gaps in the power "
                            "of 1",
                            "warning: f2: it drifts (and 1 more)"));
    EXPECT_THAT(diagnostic_lines(all, true), SizeIs(8));
}

TEST(DiagnosticLines, ListEachOfOneFlight) {
    const Diagnostics all{{warning, "gaps", "one gap", "f"}, {warning, "gaps", "two gaps", "f"}, {warning, "", "odd"}};
    EXPECT_THAT(diagnostic_lines(all, false),
                ElementsAre("warning: f: one gap", "warning: f: two gaps", "warning: odd"));
}

TEST(DiagnosticLines, ListUpToFiveErrorsOfAKindFirst) {
    auto few = in_flights(5, error, "rejected");
    few.insert(few.begin(), {warning, "gaps", "one gap", "f1"});
    EXPECT_THAT(diagnostic_lines(few, false),
                ElementsAre("f1: error: rejected of 1", "f2: error: rejected of 2", "f3: error: rejected of 3",
                            "f4: error: rejected of 4", "f5: error: rejected of 5", "warning: f1: one gap"));
    EXPECT_THAT(diagnostic_lines(in_flights(6, error, "rejected"), false),
                ElementsAre("error: rejected: 6 logs (f1, f2, f3 and 3 more), the first: rejected of 1"));
}

TEST(DiagnosticLines, NameTheKindsOfNotesInOne) {
    auto all = in_flights(2, note, "cut at power-off");
    all.push_back({note, "no .log", "no .log", "f1"});
    all.push_back({warning, "gaps", "one gap", "f1"});
    EXPECT_EQ(notes_line(all), "notes: cut at power-off (2 logs), no .log; --notes lists them");
    EXPECT_EQ(notes_line({{warning, "gaps", "one gap", "f1"}}), "");
    EXPECT_THAT(diagnostic_lines(in_flights(2, note, "cut at power-off"), false), IsEmpty());
}

}  // namespace
}  // namespace flightwatt::cli
