#include "compute/profile_specification.h"

#include "helpers/rejected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using Words = std::vector<std::string>;
using Values = std::vector<double>;
using test::rejected;
using test::write_text;
using testing::HasSubstr;

ProfileSpecification parse(const std::string& text) { return parse_profile_specification(text, "dir/p.toml"); }

TEST(ProfileSpecification, MultipliesRangesOut) {
    const auto spec = parse(R"(
duration_s = 5
warm_up_s = 1
repeats = 3
seed = 9
idle_s = 4
above_idle = true
[sampler]
kind = "ina3221"
interval_s = 0.05
rails = ["VDD_IN"]
[components.detection]
command = ["yolo", "--rate={fps}", "{size}", "{print $1}"]
duration_s = 8
qos = { fps = { from = 0.1, to = 0.3, step = 0.1 }, size = [640, 320] }
[components.plain]
command = ["plain"]
alone = false
[components.encryption]
command = ["enc", "{bits}"]
qos = { bits = { values = [32] } }
[[together]]
components = ["plain", "encryption"]
)");
    EXPECT_EQ(spec.repeats, 3U);
    EXPECT_EQ(spec.seed, 9U);
    EXPECT_EQ(spec.idle_s, 4.0);
    EXPECT_TRUE(spec.above_idle);
    EXPECT_EQ(spec.sampler.rails, Words{"VDD_IN"});
    ASSERT_EQ(spec.components.size(), 3U);
    const auto& detection = spec.components[0];
    EXPECT_EQ(detection.parameters, (Words{"fps", "size"}));
    EXPECT_EQ(detection.timing.duration_s, 8.0);
    EXPECT_EQ(detection.timing.warm_up_s, 1.0);
    ASSERT_EQ(detection.configurations.size(), 6U);
    EXPECT_EQ(detection.configurations[5].qos, (Values{0.3, 640}));
    EXPECT_EQ(detection.configurations[5].commands, (std::vector<Words>{{"yolo", "--rate=0.3", "640", "{print $1}"}}));
    EXPECT_EQ(spec.components[1].name, "encryption");
    EXPECT_EQ(spec.components[2].name, "plain+encryption");
    EXPECT_EQ(spec.components[2].configurations[0].commands, (std::vector<Words>{{"plain"}, {"enc", "32"}}));
}

TEST(ProfileSpecification, NamesTheRecordings) {
    const auto spec = parse("[sampler]\nfile = '{component}/{fps}.csv'\n[components.d]\nqos = { fps = [1, 2.5] }\n");
    EXPECT_EQ(spec.sampler.kind, SamplerKind::recorded);
    EXPECT_EQ(spec.idle_s, 0.0);
    EXPECT_EQ(spec.components[0].configurations[1].recording, "dir/d/2.5.csv");
}

TEST(ProfileSpecification, EachErrorHasItsPlace) {
    const auto of = [](const std::string& text) { return rejected([&] { parse(text); }, "dir"); };
    const std::string end = "[components.a]\ncommand = ['a']\n";
    EXPECT_EQ(of("durations_s = 1\n" + end), "p.toml:1:1: unknown key 'durations_s'; did you mean 'duration_s'?");
    EXPECT_EQ(of("duration_s = 0\n" + end), "p.toml:1:1: duration_s = 0, expected more than 0");
    EXPECT_EQ(of("repeats = 0\n" + end), "p.toml:1:1: repeats = 0, expected a whole number, 1 or more");
    EXPECT_EQ(of("repeats = 1.5\n" + end), "p.toml:1:1: repeats = 1.5, expected a whole number");
    EXPECT_EQ(of("duration_s = 9\ntimeout_s = 8\n" + end),
              "p.toml:2:1: timeout_s = 8 is over before warm-up and duration, 9 s");
    EXPECT_EQ(of("[sampler]\nkind = 'rpal'\n" + end), "p.toml:2:1: there is no sampler 'rpal'; did you mean 'rapl'?");
    EXPECT_EQ(of("[sampler]\nkind = 'rapl'\ncommand = ['x']\n" + end),
              "p.toml:3:1: command belongs to the sampler 'command', not to 'rapl'");
    EXPECT_EQ(of("[components]\n"), "p.toml:1:1: there is nothing to profile");
    EXPECT_EQ(of("[components.a]\ncommand = []\n"),
              "p.toml:2:1: an empty command, expected a program and its arguments");
    EXPECT_EQ(of("[components.'a/b']\ncommand = ['a']\n"),
              "p.toml:1:13: 'a/b' cannot be the name of a file and a column; use letters, digits and _-+.");
    EXPECT_EQ(of("[components.idle]\ncommand = ['a']\n"),
              "p.toml:1:13: a component is called 'idle', as a file of the results is");
    const auto qos = [&](const std::string& text) {
        return of("[components.a]\ncommand = ['a', '{x}']\nqos = { " + text + " }\n");
    };
    EXPECT_EQ(qos("x = []"), "p.toml:3:9: x has no values");
    EXPECT_EQ(qos("x = [1, 1]"), "p.toml:3:9: x has a value twice");
    EXPECT_EQ(qos("x = { from = 1, to = 2, step = 0 }"), "p.toml:3:33: step = 0, expected more than 0");
    EXPECT_EQ(qos("x = { from = 1, to = 0, step = 1 }"), "p.toml:3:25: to = 0, expected 1 or more");
    EXPECT_EQ(qos("x = { from = 1, to = 2 }"), "p.toml:3:13: has no key 'step'");
    EXPECT_EQ(qos("x = [1], y = [1]"),
              "p.toml:2:1: the command of a does not use its parameter y; write {y} where its value belongs");
    EXPECT_EQ(of(end + "[[together]]\ncomponents = ['a', 'b']\n"), "p.toml:4:1: there is no component 'b'");
    EXPECT_EQ(of(end + "[[together]]\ncomponents = ['a']\n"),
              "p.toml:4:1: fewer than two components cannot run together");
    EXPECT_THAT(of("[sampler]\nfile = 'x.csv'\n[components.a]\nqos = { x = [1, 2] }\n"),
                HasSubstr("p.toml:2:1: several configurations have the recording x.csv; name the file by"));
}

TEST(ProfileSpecification, IsNoFileOfPowprofiler) {
    const auto folder = test::scratch_dir();
    EXPECT_EQ(rejected([&] { read_profile_specification(write_text(folder / "c.cfg", "[combinations]\nx.csv=1\n")); },
                       folder),
              "c.cfg: is a file of powprofiler, expected TOML; a mission reads its recordings: profile = FILE.cfg; "
              "programs to run are [components.NAME]");
}

}  // namespace
}  // namespace flightwatt::compute
