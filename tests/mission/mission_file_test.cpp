#include "mission/mission_file.h"

#include "helpers/rejected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

const std::string good = R"(name = "test"
mechanical = "none"
duration_s = { takeoff = 28, cruise = 600, landing = 60 }
battery = { voltage_v = 10, resistance_ohm = 0.1, capacity_ah = 3 }
initial_soc_percent = 90

[components.detection]
profile = "detection.csv"
[components.encryption]
profile = "encryption.csv"
parameters = ["key_bits"]

[[schedule]]
phase = "cruise"
middle = 120
run = { detection = { fps = 30 }, encryption = { key_bits = 48 } }

[[schedule]]
otherwise = true
run = { detection = { fps = 10 } }
)";

/// A folder with what the mission above needs.
std::filesystem::path mission_folder() {
    auto folder = scratch_dir();
    write_text(folder / "detection.csv", "fps,power_w\n10,20\n30,40\n");
    write_text(folder / "encryption.csv", "200,100\n32,1\n64,3\n");
    std::filesystem::copy(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml", folder / "opterra.toml");
    return folder;
}

/// The mission above with `old` replaced.
std::string with(std::string_view old, std::string_view replacement) {
    auto text = good;
    const auto place = text.find(old);
    EXPECT_NE(place, std::string::npos) << old;
    return text.replace(place, old.size(), replacement);
}

Mission scheduled(const std::string& text, const std::filesystem::path& path) {
    return std::get<Mission>(parse_mission(text, path));
}

TEST(MissionFile, ReadsAMission) {
    const auto mission = scheduled(good, mission_folder() / "m.toml");
    EXPECT_EQ(mission.setup.name, "test");
    EXPECT_FALSE(mission.setup.mechanical);
    EXPECT_EQ(mission.setup.duration_s[flight::Phase::cruise], 600.0);
    EXPECT_EQ(mission.setup.battery.resistance_ohm, 0.1);
    EXPECT_EQ(mission.setup.initial_soc_percent, 90.0);
    ASSERT_EQ(mission.schedule.size(), 5U);
    EXPECT_EQ(mission.schedule[2].start_s, 240.0);
    EXPECT_EQ(mission.schedule[2].end_s, 360.0);
    EXPECT_EQ(power_w(mission.setup.compute, mission.schedule[2].run), 42.0);
    EXPECT_EQ(power_w(mission.setup.compute, mission.schedule[0].run), 20.0);
}

TEST(MissionFile, HasDefaults) {
    const auto text =
        "mechanical = \"opterra.toml\"\nbattery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }\n";
    const auto mission = scheduled(text, mission_folder() / "flight.toml");
    EXPECT_EQ(mission.setup.name, "flight");
    EXPECT_EQ(mission.setup.duration_s.values, (std::array{28.0, 600.0, 60.0}));
    EXPECT_EQ(mission.setup.phase_clock, mechanical::PhaseTimeScaling::scaled);
    EXPECT_EQ(mission.setup.initial_soc_percent, 100.0);
    ASSERT_EQ(mission.schedule.size(), 3U);
    EXPECT_TRUE(mission.schedule[1].run.empty());
}

TEST(MissionFile, ReadsWhatTheBatteryIsHeldTo) {
    const auto folder = mission_folder();
    const auto mission =
        scheduled(with("initial_soc", "capacity_ah = 2.5\ncutoff_voltage_v = 9\nreserve_soc_percent = 20\ninitial_soc"),
                  folder / "m.toml");
    EXPECT_EQ(mission.setup.battery.capacity_ah, 2.5);
    EXPECT_EQ(mission.setup.cutoff_voltage_v, 9.0);
    EXPECT_EQ(mission.setup.reserve_soc_percent, 20.0);
    const auto plain = scheduled(good, folder / "m.toml");
    EXPECT_EQ(plain.setup.battery.capacity_ah, 3.0);
    EXPECT_EQ(plain.setup.cutoff_voltage_v, 0.0);
    EXPECT_EQ(plain.setup.reserve_soc_percent, 0.0);
}

TEST(MissionFile, ReadsATheveninBattery) {
    const auto folder = mission_folder();
    write_text(folder / "pack.toml",
               "model = \"thevenin\"\ncapacity_ah = 2\nresistance_ohm = 0.1\nrc_resistance_ohm = 0.05\n"
               "rc_time_constant_s = 30\n[open_circuit]\nsoc_percent = [0, 100]\nvoltage_v = [9.9, 12.5]\n"
               "[intervals]\ncapacity_ah = [1.8, 2.2]\n");
    const std::string text = "mechanical = \"opterra.toml\"\nbattery = \"pack.toml\"\n";
    const auto own = scheduled(text, folder / "m.toml").setup.battery;
    ASSERT_TRUE(own.thevenin);
    EXPECT_EQ(own.thevenin->rc_time_constant_s, 30.0);
    EXPECT_TRUE(own.intervals.capacity_ah);
    const auto other = scheduled(text + "capacity_ah = 3\n", folder / "m.toml").setup.battery;
    EXPECT_EQ(other.capacity_ah, 3.0);
    EXPECT_FALSE(other.intervals.capacity_ah);  // it was of the other capacity
}

TEST(MissionFile, TakesDurationsFromTheMissionFirst) {
    const auto text =
        "mechanical = \"opterra.toml\"\nduration_s = { cruise = 900 }\nphase_clock = \"absolute\"\n"
        "battery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }\n";
    const auto mission = scheduled(text, mission_folder() / "m.toml");
    EXPECT_EQ(mission.setup.duration_s.values, (std::array{28.0, 900.0, 60.0}));
    EXPECT_EQ(mission.setup.phase_clock, mechanical::PhaseTimeScaling::absolute);
}

TEST(MissionFile, ReadsModelsRelativeToTheMissionFile) {
    const auto folder = mission_folder();
    std::filesystem::create_directory(folder / "missions");
    write_text(folder / "pack.toml", "voltage_v = 7.5\nresistance_ohm = 0\ncapacity_ah = 1\n");
    write_text(folder / "missions" / "m.toml", "mechanical = \"../opterra.toml\"\nbattery = \"../pack.toml\"\n");
    EXPECT_EQ(setup_of(read_mission(folder / "missions" / "m.toml")).battery.voltage_v, 7.5);
}

TEST(MissionFile, ReadsEveryWayOfSayingWhen) {
    const auto folder = mission_folder();
    const auto segment_of = [&](std::string_view when) {
        const auto schedule = scheduled(with("middle = 120", when), folder / "m.toml").schedule;
        for (const auto& part : schedule) {
            if (part.run.size() == 2) return std::pair(part.start_s, part.end_s);
        }
        return std::pair(-1.0, -1.0);
    };
    EXPECT_EQ(segment_of("from = 100\nto = 200.5"), std::pair(100.0, 200.5));
    EXPECT_EQ(segment_of("from = \"40 %\"\nto = \"60%\""), std::pair(240.0, 360.0));
    EXPECT_EQ(segment_of("from = 599"), std::pair(599.0, 600.0));
    EXPECT_EQ(segment_of("to = \"12.5 %\""), std::pair(0.0, 75.0));
    EXPECT_EQ(segment_of("middle = \"10 %\""), std::pair(270.0, 330.0));
    EXPECT_EQ(segment_of(""), std::pair(0.0, 600.0));
}

struct BadMission {
    const char* old;
    const char* replacement;
    const char* rejection;
};

class BadMissions : public testing::TestWithParam<BadMission> {};

TEST_P(BadMissions, AreRefusedWithFileLineAndReason) {
    const auto folder = mission_folder();
    const auto text = with(GetParam().old, GetParam().replacement);
    EXPECT_EQ(rejected([&] { parse_mission(text, folder / "m.toml"); }, folder), GetParam().rejection);
}

const BadMission bad_missions[] = {
    // Keys and files.
    {"mechanical = \"none\"\n", "", "m.toml:1:1: has no key 'mechanical'"},
    {"mechanical", "mechancial", "m.toml:2:1: unknown key 'mechancial'; did you mean 'mechanical'?"},
    {"initial_soc_percent", "initial_sok_percent",
     "m.toml:5:1: unknown key 'initial_sok_percent'; did you mean 'initial_soc_percent'?"},
    {"\"none\"", "\"opterra2.toml\"",
     "m.toml:2:1: mechanical: there is no file opterra2.toml; paths are relative to the mission file"},
    {"battery = {", "battery = \"pack.toml\" #",
     "m.toml:4:1: battery: there is no file pack.toml; paths are relative to the mission file"},
    {"voltage_v = 10", "voltage_v = -10", "m.toml:4:13: voltage_v = -10, expected more than 0 and at most 1000000"},
    {"\"detection.csv\"", "\"detektion.csv\"",
     "m.toml:8:1: profile: there is no file detektion.csv; paths are relative to the mission file"},
    {"parameters = [\"key_bits\"]\n", "",
     "m.toml:9:1: encryption.csv has 1 parameters without names, and 0 names are given; name them in order "
     "with "
     "`parameters`"},
    {"parameters", "parameter", "m.toml:11:1: unknown key 'parameter'; did you mean 'parameters'?"},
    {"[\"key_bits\"]", "[]", "m.toml:11:1: parameters = [] names nothing; leave it out"},
    // Numbers.
    {"= 90", "= 0",
     "m.toml:5:1: initial_soc_percent = 0, expected 1 to 100; a full pack is 100; a charge of 0.98 is 98 %"},
    {"= 90", "= 100.5",
     "m.toml:5:1: initial_soc_percent = 100.5, expected 1 to 100; a full pack is 100; a charge of 0.98 is 98 %"},
    {"= 90", "= \"90\"",
     "m.toml:5:23: 'initial_soc_percent' is a TOML string, expected a finite number; "
     "write it as initial_soc_percent = 12.5"},
    {"initial_soc", "capacity_ah = 0\ninitial_soc",
     "m.toml:5:1: capacity_ah = 0, expected 0.001 to 200; the unit is Ah: 5000 mAh is 5 Ah"},
    {"initial_soc", "reserve_soc_percent = 101\ninitial_soc",
     "m.toml:5:1: reserve_soc_percent = 101, expected 0 to 100"},
    {"initial_soc", "cutoff_voltage_v = -1\ninitial_soc", "m.toml:5:1: cutoff_voltage_v = -1, expected 0 to 1000000"},
    {"initial_soc", "format = 2\ninitial_soc",
     "m.toml:5:1: format = 2 is newer than this program, which reads formats up to 1; use a newer FlightWatt, "
     "or write the file with this one"},
    {"initial_soc", "cutoff_voltage = 9\ninitial_soc",
     "m.toml:5:1: unknown key 'cutoff_voltage'; did you mean 'cutoff_voltage_v'?"},
    {"initial_soc", "payload_g = 9\ninitial_soc",
     "m.toml:5:1: unknown key 'payload_g'; did you mean 'payload_kg'? its values are in kg, not in g: convert them"},
    {"cruise = 600", "cruise = -1", "m.toml:3:30: cruise = -1, expected 0.001 to 10000000; or 0: not flown"},
    {"cruise = 600, ", "", "m.toml:3:14: has no key 'cruise'"},
    {"cruise = 600, ", "cruis = 600, ", "m.toml:3:30: has no key 'cruise'; 'cruis' is here; was that meant?"},
    {"duration_s = { takeoff = 28, cruise = 600, landing = 60 }\n", "",
     "m.toml:2:1: without a mechanical model the phases have no durations; add duration_s = { takeoff = ..., "
     "cruise = "
     "..., landing = ... }"},
    {"initial_soc", "phase_clock = \"stretch\"\ninitial_soc",
     "m.toml:5:1: phase_clock has no meaning with mechanical = \"none\"; leave it out"},
    // What runs.
    {"fps = 30", "fps = 31",
     "m.toml:16:23: fps = 31 is outside of the profiled range 10 .. 30 of detection.csv; choose a value "
     "within it, or "
     "profile the component there"},
    {"fps = 30", "fpm = 30", "m.toml:16:23: detection has no parameter 'fpm'; did you mean 'fps'?"},
    {"fps = 30", "quality = 30", "m.toml:16:23: detection has no parameter 'quality'; its parameters are fps"},
    {"fps = 30", "", "m.toml:16:21: has no key 'fps'"},
    {"fps = 30", "fps = 30, size = 608", "m.toml:16:33: detection has no parameter 'size'; its parameters are fps"},
    {"fps = 30", "fps = \"30\"",
     "m.toml:16:29: 'fps' is a TOML string, expected a finite number; write it as fps = 12.5"},
    {"detection = { fps = 30 }", "detektion = { fps = 30 }",
     "m.toml:16:9: there is no component 'detektion'; did you mean 'detection'?"},
    {"detection = { fps = 30 }", "tracking = { fps = 30 }",
     "m.toml:16:9: there is no component 'tracking'; the components are detection, encryption"},
    {"detection = { fps = 30 }", "detection = 30",
     "m.toml:16:21: 'detection' is a TOML integer, expected a table; write it as detection = { ... }"},
    {"run = { detection = { fps = 10 } }\n", "", "m.toml:18:1: has no key 'run'"},
    // When.
    {"\"cruise\"", "\"cruize\"", "m.toml:14:1: there is no phase 'cruize'; the phases are takeoff, cruise and landing"},
    {"phase = \"cruise\"\nmiddle = 120\n", "",
     "m.toml:13:1: this entry has no time; give it a phase, or `otherwise = true` for whatever the "
     "others leave"},
    {"otherwise = true", "otherwise = false", "m.toml:19:1: `otherwise = false` has no effect; leave it out"},
    {"otherwise = true", "otherwise = true\nfrom = 10",
     "m.toml:20:1: `from` is given with `otherwise`; `otherwise` is what is left; leave one of them out"},
    {"middle = 120", "middel = 120", "m.toml:15:1: unknown key 'middel'; did you mean 'middle'?"},
    {"middle = 120", "middle = 120\nto = 5",
     "m.toml:15:1: `middle` is given with `from` or `to`; state the time in one way"},
    {"middle = 120", "middle = 601",
     "m.toml:15:1: the segment cruise from -0.5 s to 600.5 s is not within the phase; it takes 600 s in this "
     "mission"},
    {"middle = 120", "middle = 0",
     "m.toml:15:1: the segment cruise from 300 s to 300 s is empty; it must start before it ends"},
    {"middle = 120", "from = 400\nto = 300",
     "m.toml:15:1: the segment cruise from 400 s to 300 s is empty; it must start before it ends"},
    {"middle = 120", "to = \"101 %\"",
     "m.toml:15:1: the segment cruise from 0 s to 606 s is not within the phase; it takes 600 s in this "
     "mission"},
    {"middle = 120", "from = \"40\"",
     "m.toml:15:1: from = \"40\" is no time in a phase; write seconds (from = 240) or percent of the phase "
     "(from = \"40 "
     "%\")"},
    {"middle = 120", "from = \"4o %\"",
     "m.toml:15:1: from = \"4o %\" is no time in a phase; write seconds (from = 240) or percent of the phase "
     "(from = "
     "\"40 %\")"},
    {"cruise = 600", "cruise = 0", "m.toml:14:1: cruise takes no time in this mission"},
    // Gaps and overlaps.
    {"otherwise = true", "phase = \"takeoff\"",
     "m.toml:13:1: nothing is scheduled for cruise from 0 s to 240 s; add an entry with `otherwise = true`; "
     "`run = {}` "
     "runs nothing"},
    {"otherwise = true", "phase = \"cruise\"",
     "m.toml:18:1: cruise from 240 s to 360 s is scheduled twice, here and in line 13; give the entry of the "
     "whole phase "
     "`otherwise = true`, and it takes what the others leave"},
    {"otherwise = true", "phase = \"cruise\"\nfrom = 300\nto = 400",
     "m.toml:18:1: cruise from 300 s to 360 s is scheduled twice, here and in line 13; end one where the "
     "other "
     "begins"},
    {"takeoff = 28, cruise = 600, landing = 60 }", "takeoff = 0, cruise = 120, landing = 0 }",
     "m.toml:18:1: this `otherwise` covers nothing: the other entries leave no time; take it out"},
};

INSTANTIATE_TEST_SUITE_P(MissionFile, BadMissions, testing::ValuesIn(bad_missions));

TEST(MissionFile, SaysWhyAFileCannotBeLookedFor) {
    const auto folder = mission_folder();
    const std::string name(300, 'x');
    const auto text = rejected(
        [&] {
            parse_mission("mechanical = \"none\"\nduration_s = { takeoff = 0, cruise = 1, landing = 0 }\nbattery = \"" +
                              name + "\"\n",
                          folder / "m.toml");
        },
        folder);
    EXPECT_EQ(text, "m.toml:3:1: battery: " + name + " cannot be read: File name too long");
}

TEST(MissionFile, RemembersWhatItStates) {
    const auto folder = mission_folder();
    const auto setup = [&](const std::string& more) {
        const auto mission = parse_mission(
            "mechanical = \"opterra.toml\"\nbattery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }\n" + more,
            folder / "m.toml");
        return setup_of(mission);
    };
    const auto bare = setup("");
    EXPECT_FALSE(bare.capacity_is_stated || bare.may_charge);
    for (const bool stated : bare.duration_is_stated.values) EXPECT_FALSE(stated);
    const auto stated = setup("duration_s = { cruise = 600 }\ncapacity_ah = 2\nmay_charge = true\n");
    EXPECT_TRUE(stated.capacity_is_stated && stated.may_charge && stated.duration_is_stated[flight::Phase::cruise]);
    EXPECT_FALSE(stated.duration_is_stated[flight::Phase::landing]);
    const auto asked = parse_mission(
        "mechanical = \"opterra.toml\"\nbattery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }\n",
        folder / "m.toml", {false, 500.0});
    EXPECT_TRUE(setup_of(asked).duration_is_stated[flight::Phase::cruise]) << "the question states it";
}

TEST(MissionFile, WarnsWhereNothingDrawsThePowerOfTheIdleComputer) {
    const auto folder = mission_folder();
    write_text(folder / "above.csv", "fps,power_w,total_power_w\n10,20,22\n30,40,42\n");
    write_text(folder / "idle.csv", "power_w\n2\n");
    const auto notes = [&](const std::string& idle, const std::string& run) {
        return scheduled(R"(mechanical = "none"
battery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }
duration_s = { takeoff = 0, cruise = 100, landing = 0 }
[components]
detection = { profile = "above.csv" }
)" + idle + R"([[schedule]]
phase = "cruise"
middle = 60
run = { detection = { fps = 10 } }
[[schedule]]
otherwise = true
run = { )" + run + " }\n",
                         folder / "m.toml")
            .setup.notes;
    };
    const std::string declared = "idle = { profile = \"idle.csv\" }\n";
    for (const auto& idle : {std::string(), declared}) {
        const auto found = notes(idle, "");
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(
            found[0],
            "the profile of detection is above the idle computer, and for 60 s of the schedule nothing draws the 2 W "
            "of that: add the idle.csv of its folder as a component, and run it");
    }
    EXPECT_EQ(notes(declared, "idle = {}").size(), 1U) << "it runs while the software does not";
}

TEST(MissionFile, WarnsWhereTheIdleComputerCountsTwice) {
    const auto folder = mission_folder();
    const std::string columns = "power_w,total_power_w,above_idle_power_w\n";
    write_text(folder / "whole.csv", "fps," + columns + "10,22,22,20\n30,42,42,40\n");
    write_text(folder / "other.csv", columns + "5,5,3\n");
    write_text(folder / "above.csv", columns + "3,5,3\n");
    write_text(folder / "idle.csv", "power_w,above_idle_power_w\n2,0\n");
    const auto mission = [&](const std::string& other, const std::string& schedule) {
        return parse_mission(R"(mechanical = "none"
battery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }
duration_s = { takeoff = 0, cruise = 100, landing = 0 }
[components]
detection = { profile = "whole.csv" }
other = { profile = ")" + other + "\" }\n" +
                                 schedule,
                             folder / "m.toml");
    };
    const std::string together = R"([[schedule]]
phase = "cruise"
middle = 60
run = { detection = { fps = 10 }, other = {} }
[[schedule]]
otherwise = true
run = { other = {} }
)";
    const auto notes = [&](const char* other) { return setup_of(mission(other, together)).notes; };
    for (const auto* other : {"other.csv", "idle.csv"}) {
        ASSERT_EQ(notes(other).size(), 1U) << other;
        EXPECT_EQ(notes(other)[0],
                  "the profiles of detection and other include the idle computer: for 60 s of the schedule its 2 W "
                  "count twice, and the mission lands with less charge than it would; profile with above_idle = true, "
                  "and add idle.csv as a component");
    }
    EXPECT_THAT(notes("above.csv"), testing::Not(testing::Contains(testing::HasSubstr("count twice"))));
    const auto planned = parse_mission(R"(mechanical = "none"
battery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }
duration_s = { takeoff = 0, cruise = 100, landing = 0 }
[components]
detection = { profile = "whole.csv" }
other = { profile = "other.csv" }
[plan]
)",
                                       folder / "m.toml", {true});
    ASSERT_EQ(setup_of(planned).notes.size(), 1U);
    EXPECT_THAT(setup_of(planned).notes[0], testing::HasSubstr("where they run at the same time, its 2 W count twice"));
}

TEST(MissionFile, RefusesAMissionThatDoesNotFitItsParts) {
    const auto folder = mission_folder();
    const auto of = [&](const std::string& text) {
        return rejected([&] { parse_mission(text, folder / "m.toml"); }, folder);
    };
    const std::string flight =
        "mechanical = \"opterra.toml\"\nbattery = { voltage_v = 4, resistance_ohm = 0, capacity_ah = 1 }\n";
    EXPECT_EQ(of(flight + "[components.detection]\nprofile = \"detection.csv\"\n"),
              "m.toml:3:2: there are components and no [[schedule]] that runs them; add [[schedule]] with "
              "otherwise = "
              "true and run = { ... }, or make a schedule with `flightwatt plan`");
    EXPECT_EQ(of(flight + "[[schedule]]\notherwise = true\nrun = { detection = { fps = 1 } }\n"),
              "m.toml:5:9: there is no component 'detection'; the mission has no [components.NAME]");
    EXPECT_EQ(of(flight + "phase_clock = \"stretched\"\n"),
              "m.toml:3:1: there is no phase_clock 'stretched'; it is \"stretch\" or \"absolute\"");
    EXPECT_EQ(of(flight + "duration_s = { takeoff = 0, cruise = 0, landing = 0 }\n"),
              "m.toml:3:1: all phases take 0 s, expected a mission");
    EXPECT_EQ(of(flight + "duration_s = { cruising = 10 }\n"),
              "m.toml:3:16: unknown key 'cruising'; known keys of [duration_s]: cruise, landing, takeoff");
    EXPECT_EQ(of("mechanical = none\n").substr(0, 29), "m.toml:1:15: is not TOML: Err");
    // What is wrong in a model is placed in the model's file.
    write_text(folder / "opterra.toml", "name = \"x\"\n");
    EXPECT_EQ(of(flight), "opterra.toml:1:1: has no key 'takeoff'");
    EXPECT_EQ(rejected([&] { read_mission(folder / "none.toml"); }, folder).find("none.toml: cannot be read: No such"),
              0U);
}

}  // namespace
}  // namespace flightwatt::mission
