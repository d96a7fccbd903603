#include "telemetry/log_configuration.h"

#include "base/error.h"
#include "helpers/test_paths.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::HasSubstr;

constexpr auto older = R"xml(<configuration><conf>
<aircraft name="Other" ac_id="5"><flight_plan GROUND_ALT="1"><block NAME="x"/></flight_plan></aircraft>
<aircraft name="Zagi" ac_id="17">
<flight_plan GROUND_ALT="30" ALT="130"><exception COND="z > 3 && y < 2"/>
<block NAME="Takeoff" pre_call="f(a > b)"/><block name="Standby"/></flight_plan>
<airframe><firmware NAME="test_progs"/><firmware NAME="fixedwing"><target name="ap"/></firmware><define NAME="XBEE_INIT" VALUE="\"ATPL2\\rATRN1\""/><define NAME="MILLIAMP_AT_FULL_THROTTLE" VALUE="9000"/></airframe>
</aircraft></conf>
<protocol><class NAME="datalink"><message NAME="BAT"><field NAME="wrong" TYPE="uint8"/></message></class>
<class NAME="telemetry"><message NAME="BAT" ID="12"><field NAME="voltage" TYPE="uint8" UNIT="1e-1V"/>text
<field name="amps" type="int16" unit="A"/></message></class></protocol></configuration>)xml";

TEST(LogConfiguration, ReadsBothCasesFromAFileThatIsNotWellFormed) {
    const auto configuration = parse_log_configuration(older, "x.log");
    ASSERT_TRUE(configuration.messages.contains("BAT"));
    const auto& bat = configuration.messages.at("BAT");
    ASSERT_EQ(bat.fields.size(), 2u) << "the telemetry class counts, not the datalink's message of that name";
    EXPECT_EQ(bat.fields[0].name, "voltage");
    EXPECT_EQ(bat.fields[1].name, "amps");
    EXPECT_DOUBLE_EQ(find_conversion("BAT", bat.fields[0]).factor, 0.1);
    EXPECT_DOUBLE_EQ(find_conversion("BAT", bat.fields[1]).factor, 0.01) << "declared A, really 0.01 A";

    const auto& zagi = configuration.aircraft.at("17");
    EXPECT_EQ(zagi.name, "Zagi");
    EXPECT_EQ(zagi.ground_altitude_m, 30.0);
    EXPECT_EQ(zagi.block_names.at(0), "Takeoff");
    EXPECT_EQ(zagi.block_names.at(1), "Standby");
    EXPECT_EQ(zagi.current_origin, CurrentOrigin::throttle);
    EXPECT_EQ(zagi.firmware, "fixedwing");
    EXPECT_EQ(configuration.aircraft.at("5").firmware, "");
    EXPECT_EQ(configuration.aircraft.at("5").current_origin, CurrentOrigin::unknown);
}

TEST(LogConfiguration, KnowsWhenTheLogBegan) {
    const std::string protocol = "<protocol><msg_class name='telemetry'><message name='A'/></msg_class></protocol>";
    const auto begun = [&](const std::string& opening) {
        return parse_log_configuration(opening + protocol + "</configuration>", "x.log").time_of_day_s;
    };
    EXPECT_EQ(begun("<configuration time_of_day=\"1594356783.16\" data_file=\"x.data\">"), 1594356783.16);
    EXPECT_EQ(begun("<configuration>"), std::nullopt);
    EXPECT_EQ(begun("<configuration time_of_day=\"noon\">"), std::nullopt);
    EXPECT_EQ(begun("<configuration time_of_day=\"0.\">"), std::nullopt) << "a clock that was not set";
}

void expect_error(const std::string& text, std::size_t line, const std::string& message) {
    try {
        parse_log_configuration(text, "x.log");
        FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().line, line);
        EXPECT_THAT(error.what(), HasSubstr(message));
    }
}

TEST(LogConfiguration, RefusesAFileWithoutUsableDefinitions) {
    expect_error("", 0, "no <protocol>");
    expect_error("<configuration><conf/></configuration>", 0, "no <protocol>");
    expect_error("<configuration>\n<protocol>\n<class>\n</protocol>", 4, "is not XML");
    expect_error("\n<protocol></protocol>", 2, "defines no message");
}

/// Tags that never end cost no more than others: 40,000 of them took over 60 s.
TEST(LogConfiguration, PassesOverTagsThatAreNotClosed) {
    const std::string protocol = "<protocol><msg_class name='telemetry'><message name='A'/></msg_class></protocol>";
    const std::string aircraft = "<aircraft ac_id=\"7\" name=\"x\">";
    for (const std::string broken : {"<block no=\"1\" ", "<block no=\"1 ", "<block a=\"\\\" ", "<define name='\" "}) {
        std::string text = protocol + aircraft;
        for (int i = 0; i < 40000; ++i) text += broken;
        const auto read = parse_log_configuration(text + "\"'><block no=\"3\" name=\"Land\"/></aircraft>", "x.log");
        EXPECT_EQ(read.aircraft.at("7").block_names.at(3), "Land") << broken;
    }
}

TEST(LogConfiguration, ReadsTheRealLogsThatStrictParsersRefuse) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::shared_dir() / "flights";
    const auto old = read_log_configuration(folder / "09_05_13__14_38_13.log");
    EXPECT_EQ(old.aircraft.at("61").name, "HITLUSB");
    EXPECT_EQ(old.messages.at("BAT").fields.size(), 7u);
    const auto newer = read_log_configuration(folder / "20_07_03__12_17_45.log");
    EXPECT_EQ(newer.aircraft.size(), 27u);
    const auto& faulty = newer.aircraft.at("20");
    EXPECT_EQ(faulty.name, "Faulty");
    EXPECT_EQ(faulty.ground_altitude_m, 185.0);
    EXPECT_EQ(faulty.block_names.at(10), "Land Right AF-TD");
    EXPECT_EQ(faulty.current_origin, CurrentOrigin::sensor);
}

TEST(FlightName, LosesFolderAndEndings) {
    EXPECT_EQ(flight_name("a/b/20_07_03__12_17_45.data.gz"), "20_07_03__12_17_45");
    EXPECT_EQ(flight_name("x_SD.data"), "x_SD");
    EXPECT_EQ(flight_name("out/x.series.csv"), "x");
}

TEST(FindLogFile, StandsBesideTheData) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"a.log", "b.log"}) std::ofstream(folder / name) << "x";
    EXPECT_EQ(find_log_file(folder / "a.data.xz"), folder / "a.log");
    EXPECT_EQ(find_log_file(folder / "b_SD.data"), folder / "b.log");
    EXPECT_FALSE(find_log_file(folder / "c.data").has_value());
    EXPECT_FALSE(find_log_file(folder / std::string(250, 'n')).has_value());
    std::filesystem::create_symlink("loop.log", folder / "loop.log");
    EXPECT_EQ(find_log_file(folder / "loop.data"), folder / "loop.log") << "read, it states why it cannot be";
}

}  // namespace
}  // namespace flightwatt::telemetry
