#include "synthetic/paparazzi/log_writer.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::synthetic {
namespace {

TEST(OcamlFloat, WritesAsPaparazziDoes) {
    EXPECT_EQ(ocaml_float(235.0), "235.");
    EXPECT_EQ(ocaml_float(-0.0), "-0.");
    EXPECT_EQ(ocaml_float(-3e-06), "-3e-06");
    EXPECT_EQ(ocaml_float(12.4214591), "12.421459");
}

TEST(OcamlFloat, RoundsToTheMillionth) {
    EXPECT_EQ(ocaml_float(0.1234567891), "0.123457");
    EXPECT_EQ(ocaml_float(123456.7891234), "123456.789123");
}

TEST(DataLine, IsTimeSenderNameAndFields) {
    EXPECT_EQ(data_line(335.1494, "20", "ENERGY", {"69", "11.704956"}), "335.149 20 ENERGY 69 11.704956\n");
    EXPECT_EQ(data_line(1.0, "20", "PONG", {}), "1.000 20 PONG \n") << "Paparazzi leaves the blank";
}

TEST(LogXml, IsReadAsItWasWritten) {
    const telemetry::AircraftConfiguration written{
        "7", "Opt<e>\"ra\" & Co", 15.0, {{3, "Takeoff"}, {4, "Survey"}}, telemetry::CurrentOrigin::sensor};
    const auto text =
        to_log_xml("made by a test", "x.data", written,
                   {{"ENERGY", {{"power", "float", "W", "", {}}, {"energy", "uint16", "mAh", "", {}}}, ".log"},
                    {"PONG", {}, ".log"}});
    EXPECT_NE(text.find("<!--made by a test-->"), std::string::npos);
    const auto configuration = telemetry::parse_log_configuration(text, "x.log");
    ASSERT_EQ(configuration.messages.size(), 2U);
    const auto& fields = configuration.messages.at("ENERGY").fields;
    ASSERT_EQ(fields.size(), 2U);
    EXPECT_EQ(fields[1].name, "energy");
    EXPECT_EQ(fields[1].type, "uint16");
    EXPECT_EQ(fields[1].unit, "mAh");
    const auto& aircraft = configuration.aircraft.at("7");
    EXPECT_EQ(aircraft.block_names, written.block_names);
    EXPECT_EQ(aircraft.current_origin, telemetry::CurrentOrigin::sensor);
    EXPECT_EQ(aircraft.ground_altitude_m, 15.0);
}

TEST(TelemetryReports, FillTheFieldsThatTheyDeclare) {
    for (const auto& report : periodic_messages()) {
        EXPECT_EQ(report.fields({}).size(), report.definition.fields.size()) << report.definition.name;
        EXPECT_GT(report.period_s, 0.0) << report.definition.name;
    }
}

TEST(TelemetryReports, HoldWhatFlightsAreReadFrom) {
    std::set<std::string> names;
    for (const auto& report : periodic_messages()) {
        EXPECT_TRUE(names.insert(report.definition.name).second) << report.definition.name;
    }
    for (const auto* name : {"ENERGY", "ESTIMATOR", "NAVIGATION", "GPS", "PPRZ_MODE", "WIND_INFO"}) {
        EXPECT_TRUE(names.contains(name)) << name;
    }
}

TEST(TelemetryReports, PowerIsVoltageTimesCurrent) {
    const auto reports = periodic_messages();
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
