#include "base/diagnostic.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using testing::ElementsAre;
using enum Severity;

TEST(Diagnostic, AreGroupedBySeverityAndKindEachOnce) {
    const Diagnostic gap{warning, "gaps", "one gap", "a"};
    const Diagnostic other_gap{warning, "gaps", "two gaps", "b"};
    const Diagnostic harmless_gap{note, "gaps", "a small gap", "a"};
    const Diagnostic rejected{error, "rejected", "is empty", "c"};
    const Diagnostic drift{warning, "drift", "it drifts", "a"};
    const auto groups = grouped({harmless_gap, gap, drift, other_gap, gap, rejected});
    EXPECT_THAT(groups, ElementsAre(Diagnostics{rejected}, Diagnostics{gap, other_gap}, Diagnostics{drift},
                                    Diagnostics{harmless_gap}));
}

TEST(Diagnostic, WithoutAKindIsAGroupOfItsOwn) {
    const Diagnostic one{warning, "", "one"};
    const Diagnostic other{warning, "", "other"};
    EXPECT_THAT(grouped({one, other, one}), ElementsAre(Diagnostics{one}, Diagnostics{other}));
}

TEST(Diagnostic, HasTextsByTheLeastSeverity) {
    Diagnostics diagnostics{{error, "k", "e", "f"}};
    append(diagnostics, note, "k", "f", {"n", "m"});
    EXPECT_THAT(texts_of(diagnostics), ElementsAre("e", "n", "m"));
    EXPECT_THAT(texts_of(diagnostics, warning), ElementsAre("e"));
}

TEST(Diagnostic, SeverityHasANameBothWays) {
    for (const auto severity : {note, warning, error}) EXPECT_EQ(severity_from(to_string(severity)), severity);
    EXPECT_THROW(severity_from("fatal"), std::out_of_range);
}

TEST(Diagnostic, KindOfAReasonIsWhatOthersShare) {
    const std::vector<std::pair<std::string, std::string>> kinds{
        {"has no flight in 48 s; no motion", "has no flight"},
        {"no measured power (BAT has no current)", "no measured power"},
        {"power faults: power is negative", "power faults"},
        {"has no telemetry in its 1 lines", "has no telemetry"},
        {"is empty", "is empty"},
        {"it is the same flight as f_2, which is used", "it is the same flight"},
        {"is of aircraft A7", "is of aircraft"},
        {"3 samples", ""}};
    for (const auto& [reason, kind] : kinds) EXPECT_EQ(kind_of_reason(reason), kind);
}

}  // namespace
}  // namespace flightwatt
