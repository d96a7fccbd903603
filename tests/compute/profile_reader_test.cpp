#include "compute/profile_reader.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

const Location asked{"mission.toml", 7, 1};

ProfileNaming parameters(std::vector<std::string> names) { return {std::move(names), {}, asked}; }
ProfileNaming columns(std::vector<std::string> names) { return {{}, std::move(names), asked}; }

TEST(ProfileReader, ReadsOurOwnCsv) {
    const auto profile = read_power_profile(write_text(
        scratch_dir() / "p.csv", "# where it is from\nfps,key_bits,power_w\n1,32,5\n2,32,6\n1,64,7\n2,64,9\n"));
    EXPECT_EQ(profile.parameters, (std::vector<std::string>{"fps", "key_bits"}));
    EXPECT_EQ(power_w(profile, {1.5, 48.0}), 6.75);
}

TEST(ProfileReader, RefusesPowerOverTime) {
    const auto file = write_text(test::scratch_dir() / "load.csv", "time_s,power_w\n0,5\n0.1,5.2\n");
    EXPECT_EQ(rejected([&] { read_power_profile(file); }, file.parent_path()),
              "load.csv:1:1: is a recording of power over time (layer 1), expected a profile of "
              "configurations; use layer 2, which `flightwatt profile` writes as DIR/COMPONENT.csv");
}

TEST(ProfileReader, ReadsPowprofilerLayerTwo) {
    const auto file =
        write_text(scratch_dir() / "p.csv", "201,200,100,130\n32,1,5,999\n32,2,6,999\n64,1,7,9\n64,2,9,9");
    const auto profile = read_power_profile(file, parameters({"fps", "key_bits"}));
    EXPECT_EQ(power_w(profile, {2.0, 32.0}), 6.0);
    EXPECT_EQ(rejected([&] { read_power_profile(file, parameters({"fps"})); }, file.parent_path()),
              "mission.toml:7:1: p.csv has 2 parameters without names, and 1 names are given; name them in "
              "order with "
              "`parameters`");
    EXPECT_NE(rejected([&] { read_power_profile(file); }), "");
    EXPECT_NE(rejected([&] { read_power_profile(file, parameters({"fps", "fps"})); }), "");
    EXPECT_EQ(rejected(
                  [&] {
                      read_power_profile(file, columns({"a", "b", "power_w", "_"}));
                  },
                  file.parent_path()),
              "mission.toml:7:1: p.csv has a header; `columns` name those of a file without one; leave them out");
}

TEST(ProfileReader, ReadsFilesWithoutHeader) {
    const auto file = write_text(scratch_dir() / "p.csv", "1,32,5,77\n2,32,6,77\n\n1,64,7,77\n2,64,9,77");
    const auto profile = read_power_profile(file, columns({"fps", "key_bits", "power_w", "_"}));
    EXPECT_EQ(power_w(profile, {1.0, 64.0}), 7.0);
    EXPECT_EQ(rejected([&] { read_power_profile(file); }, file.parent_path()),
              "p.csv:1: begins with numbers and not with a header; name the columns with `columns`, for example "
              "[\"fps\", \"power_w\"]");
    EXPECT_EQ(rejected(
                  [&] {
                      read_power_profile(file, columns({"fps", "power_w"}));
                  },
                  file.parent_path()),
              "mission.toml:7:1: 2 columns are named, p.csv has 4; name each column, one power_w, ignored "
              "ones _");
    EXPECT_EQ(rejected([&] {
                  read_power_profile(file, columns({"fps", "bits", "_", "_"}));
              }),
              "mission.toml:7:1: 0 columns are named power_w, expected one");
    EXPECT_EQ(rejected([&] {
                  read_power_profile(file, columns({"fps", "", "power_w", "_"}));
              }),
              "mission.toml:7:1: '' is not a parameter's name; use a name without blanks");
}

TEST(ProfileReader, TakesTheMeanOfALayerOneAsConstantPower) {
    const auto file = write_text(scratch_dir() / "p.csv", "100,101,102\n4,1,1\n5,1,1\n9,1,1\n");
    EXPECT_EQ(power_w(read_power_profile(file), {}), 6.0);
    EXPECT_EQ(rejected([&] { read_power_profile(file, parameters({"fps"})); }, file.parent_path()),
              "mission.toml:7:1: p.csv has 0 parameters without names, and 1 names are given; leave "
              "`parameters` out");
}

TEST(ProfileReader, TakesMeansOfCombinations) {
    const auto folder = scratch_dir();
    write_text(folder / "1,5.csv", "100,101,102\n4,1,1\n6,1,1\n");
    write_text(folder / "2.csv", "100,101,102\n8,1,1\n");
    const auto file = write_text(folder / "c.cfg", "[combinations]\n1,5.csv=1.5\n2.csv=2\nname=m2l.csv\n");
    const auto profile = read_power_profile(file, parameters({"fps"}));
    EXPECT_EQ(power_w(profile, {1.75}), 6.5);
    std::filesystem::remove(folder / "2.csv");
    EXPECT_EQ(rejected([&] { read_power_profile(file, parameters({"fps"})); }, folder),
              "c.cfg:3: the recording 2.csv does not exist");
    EXPECT_EQ(rejected(
                  [&] {
                      read_power_profile(file, columns({"fps", "power_w"}));
                  },
                  folder),
              "mission.toml:7:1: c.cfg has no columns; name its values with `parameters`");
}

TEST(ProfileReader, KeepsTheEvidenceBehindPower) {
    const auto folder = scratch_dir();
    const auto text =
        "# c\nfps,power_w,standard_error_w,duration_s,energy_j,samples,repeats,source\n"
        "1,2,0.1,10,20,100,1,measured\n2,4,0.3,10,40,100,1,measured\n";
    const auto profile = read_power_profile(write_text(folder / "p.csv", text));
    EXPECT_EQ(profile.parameters, std::vector<std::string>{"fps"});
    EXPECT_EQ(profile.power_w, (std::vector<double>{2.0, 4.0}));
    EXPECT_EQ(profile.standard_error_w, (std::vector<double>{0.1, 0.3}));
    EXPECT_EQ(rejected([&] { read_power_profile(write_text(folder / "q.csv", "fps,power_w,key\n1,2,3\n")); }, folder),
              "q.csv:1:13: the column 'key' follows power_w; parameters come before it, after it only the "
              "columns that `flightwatt profile` writes");
}

TEST(ProfileReader, RefusesWhatIsNoProfile) {
    const auto folder = scratch_dir();
    const auto of = [&](const std::string& text, const ProfileNaming& naming = {}) {
        return rejected([&] { read_power_profile(write_text(folder / "p.csv", text), naming); }, folder);
    };
    EXPECT_EQ(of("fps,power_kw\n1,2\n"),
              "p.csv:1:5: the last column is 'power_kw', expected 'power_w'; a profile's columns are its "
              "parameters and "
              "then power_w");
    EXPECT_EQ(of("# c\nfps,fps,power_w\n1,2,3\n"), "p.csv:2: two columns are named 'fps'");
    EXPECT_EQ(of("fps,power_w\n"), "p.csv: has no nodes, expected at least one profiled configuration");
    EXPECT_EQ(of("fps,power_w\n1,2\n2,1x\n"), "p.csv:3:3: power_w is not a finite number: '1x'");
    EXPECT_EQ(of("fps,power_w\n1,2\n2\n"), "p.csv:3: 1 cells, expected 2 as in the first line");
    EXPECT_EQ(of("fps,power_w\n1,2\n1,3\n"),
              "p.csv:3: fps = 1 has a second node, the first is in line 2; keep one row for each configuration");
    EXPECT_EQ(of("fps,power_w\n1,2\n", parameters({"rate"})),
              "mission.toml:7:1: p.csv has names of its parameters; leave `parameters` out");
    EXPECT_EQ(of("fps,power_w\n1,2\n", {{"a"}, {"b"}, asked}),
              "mission.toml:7:1: both `parameters` and `columns` are given, expected one of them");
    EXPECT_EQ(of(""), "p.csv: is empty, expected a CSV table");
}

TEST(ProfileReader, ReadsTheRealTwoComponentGrid) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto profile = read_power_profile(test::shared_dir() / "powprofiler" / "tx2_two_component_power.csv",
                                            columns({"first", "second", "power_w"}));
    EXPECT_EQ(profile.power_w.size(), 25U);
    EXPECT_EQ(power_w(profile, {8.0, 10.0}), 9.78429);
    EXPECT_DOUBLE_EQ(power_w(profile, {3.0, 2.0}), (4.75376 + 6.54918) / 2.0);
}

TEST(ProfileReader, ReadsTheRealTrackingProfileInAllItsForms) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto shared = test::shared_dir() / "powprofiler";
    const auto layer2 = read_power_profile(shared / "tracking_m2l_tracking.csv", parameters({"yolo_fps", "nfold_fps"}));
    const auto plot =
        read_power_profile(shared / "tracking__m2l_tracking.csv", columns({"yolo_fps", "nfold_fps", "power_w", "_"}));
    // The configuration names its recordings without the prefix that they have been kept with.
    const auto folder = scratch_dir();
    for (const auto& entry : std::filesystem::directory_iterator(shared)) {
        const auto name = entry.path().filename().string();
        if (name.starts_with("tracking_")) std::filesystem::copy(entry.path(), folder / name.substr(9));
    }
    const auto combined = read_power_profile(folder / "config4.cfg", parameters({"yolo_fps", "nfold_fps"}));
    EXPECT_EQ(layer2.axes, (std::vector<std::vector<double>>{{0.1, 0.25, 1.0, 4.0}, {0.5, 10.0}}));
    EXPECT_EQ(plot.axes, layer2.axes);
    EXPECT_EQ(plot.power_w, layer2.power_w);
    EXPECT_EQ(combined.axes, layer2.axes);
    for (std::size_t i = 0; i < layer2.power_w.size(); ++i) {
        EXPECT_NEAR(combined.power_w[i], layer2.power_w[i], 5e-6);  // the file rounds to six digits
    }
    EXPECT_EQ(power_w(layer2, {4.0, 0.5}), 6.30497);
}

TEST(ExcludedIdle, IsTheTotalLessThePower) {
    const auto excluded_w = [folder = test::scratch_dir()](const char* text, const ProfileNaming& naming = {}) {
        return read_power_profile(write_text(folder / "p.csv", text), naming).excluded_idle_w;
    };
    EXPECT_DOUBLE_EQ(excluded_w("# above idle\nfps,power_w,total_power_w\n1,2.5,8\n2,3.5,9\n"), 5.5);
    EXPECT_EQ(excluded_w("fps,power_w,total_power_w\n1,8,8\n"), 0.0);
    EXPECT_EQ(excluded_w("fps,power_w\n1,8\n"), 0.0);
    EXPECT_EQ(excluded_w("200,100\n1,8\n", parameters({"fps"})), 0.0);
}

TEST(IncludedIdle, IsThePowerLessThatAboveIdle) {
    const auto included_w = [folder = test::scratch_dir()](const char* text) {
        return read_power_profile(write_text(folder / "p.csv", text)).included_idle_w;
    };
    EXPECT_DOUBLE_EQ(included_w("fps,power_w,total_power_w,above_idle_power_w\n1,8,8,5\n2,9,9,6\n"), 3.0);
    EXPECT_EQ(included_w("fps,power_w,total_power_w,above_idle_power_w\n1,5,8,5\n"), 0.0);
    EXPECT_EQ(included_w("fps,power_w,total_power_w\n1,8,8\n"), 0.0) << "it is not known";
}

}  // namespace
}  // namespace flightwatt::compute
