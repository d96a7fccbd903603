#include "synthetic/sensor_messages.h"

#include "flight/telemetry_series.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::synthetic {
namespace {

TEST(TelemetryReports, FillTheFieldsThatTheyDeclare) {
    for (const auto& report : telemetry_reports()) {
        EXPECT_EQ(report.fields({}).size(), report.definition.fields.size()) << report.definition.name;
        EXPECT_GT(report.period_s, 0.0) << report.definition.name;
    }
}

TEST(TelemetryReports, HoldWhatFlightsAreReadFrom) {
    std::set<std::string> names;
    for (const auto& report : telemetry_reports()) {
        EXPECT_TRUE(names.insert(report.definition.name).second) << report.definition.name;
    }
    for (const auto* name : {"ENERGY", "ESTIMATOR", "NAVIGATION", "GPS", "PPRZ_MODE", "WIND_INFO"}) {
        EXPECT_TRUE(names.contains(name)) << name;
    }
}

TEST(TelemetryReports, PowerIsVoltageTimesCurrent) {
    const auto reports = telemetry_reports();
    const auto energy = std::find_if(reports.begin(), reports.end(),
                                     [](const auto& report) { return report.definition.name == "ENERGY"; });
    ASSERT_NE(energy, reports.end());
    const auto fields =
        energy->fields({.time_s = 1.0, .state = {}, .voltage_v = 12.0, .current_a = 2.5, .charge_ah = 0.25});
    const auto field = [&](const char* name) { return fields.at(*field_index(energy->definition, name)); };
    EXPECT_EQ(field("power"), "30.");
    EXPECT_EQ(field("voltage"), "12.");
    EXPECT_EQ(field("charge"), "0.25");
}

}  // namespace
}  // namespace flightwatt::synthetic
