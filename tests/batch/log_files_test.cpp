#include "batch/log_files.h"

#include "helpers/rejected.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using test::rejected;
using test::write_text;
using testing::ElementsAre;

std::vector<std::string> names(const std::vector<LogFile>& logs) {
    std::vector<std::string> result;
    for (const auto& log : logs) result.push_back(log.flight);
    return result;
}

std::filesystem::path touch(const std::filesystem::path& path) {
    std::filesystem::create_directories(path.parent_path());
    return write_text(path, "x");
}

TEST(FindLogs, SearchesFoldersToTheBottom) {
    const auto folder = test::scratch_dir();
    touch(folder / "b.data");
    touch(folder / "2020" / "july" / "a.data.xz");
    touch(folder / "2020" / "c.data.zst");
    touch(folder / "2020" / "c.log");
    touch(folder / "notes.data.txt");
    touch(folder / "data");
    std::filesystem::create_directories(folder / "folder.data");
    const auto logs = find_logs({folder.string()});
    EXPECT_THAT(names(logs), ElementsAre("c", "a", "b"));  // by path
    EXPECT_EQ(logs[1].path, folder / "2020" / "july" / "a.data.xz");
}

TEST(FindLogs, TakesFilesOfAnyName) {
    const auto folder = test::scratch_dir();
    const auto file = touch(folder / "flight.csv");
    EXPECT_THAT(names(find_logs({file.string()})), ElementsAre("flight"));
}

TEST(FindLogs, TakesTablesOfOneULogAsOneLog) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"a_1_battery_status_1", "a_1_vehicle_status_0", "a_1_cpuload_0", "b_vehicle_air_data_0",
                             "c_vehicle_air_data_0", "d_cpuload_0"})
        write_text(folder / (std::string(name) + ".csv"), "timestamp,x\n1,2\n");
    touch(folder / "c.ulg");
    EXPECT_THAT(names(find_logs({folder.string()})), ElementsAre("a_1", "b", "c"));
    const auto any =
        find_logs({(folder / "a_1_cpuload_0.csv").string(), (folder / "a_1_vehicle_status_0.csv").string()});
    ASSERT_EQ(any.size(), 1U);
    EXPECT_EQ(any[0].path, folder / "a_1_battery_status_1.csv");
}

TEST(FindLogs, TakesLogsOfOtherAutopilotsAndFlightsAsCsv) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"a.bin", "b.BIN", "c.ulg", "c.ulg.gz", "d.log", "d.txt", "made.data"})
        touch(folder / name);
    write_text(folder / "e.log", "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n");
    write_text(folder / "own.csv", "time_s,power_w,altitude_m\n1,2,3\n");
    write_text(folder / "made.series.csv", "time_s,power_w,altitude_m\n1,2,3\n");
    write_text(folder / "soc.csv", "time_s,power_w,soc\n1,2,3\n");
    write_text(folder / "result.series.csv", "time_s,power_w,altitude_m\n1,2,3\n");
    touch(folder / "result.record.json");
    EXPECT_THAT(names(find_logs({folder.string()})), ElementsAre("a", "b", "c", "c_2", "e", "made", "own"));
    write_text(folder / "soc.csv", "t,p\n1,2\n");
    const auto map =
        write_text(folder / "map.toml", "time = { column = \"t\" }\n[[track]]\nname = \"power_w\"\ncolumn = \"p\"\n");
    EXPECT_EQ(names(find_logs({folder.string()}, {}, map)).back(), "soc");
}

TEST(FindLogs, TakesALogOnceHoweverItIsWritten) {
    const auto folder = test::scratch_dir();
    const auto log = touch(folder / "logs" / "a.data");
    std::filesystem::create_directory_symlink(folder / "logs", folder / "link");
    const auto logs =
        find_logs({log.string(), (folder / "logs").string(), log.string(), (folder / "logs" / ".." / "logs").string(),
                   (folder / "link").string(), std::filesystem::relative(log).string()});
    EXPECT_THAT(names(logs), ElementsAre("a"));
}

TEST(FindLogs, DoesNotTakeLinksForFolders) {
    const auto folder = test::scratch_dir();
    touch(folder / "here" / "x.data");
    touch(folder / "far" / "x.data");
    touch(folder / "far" / "below" / "y.data");
    std::filesystem::create_directory_symlink(folder / "far" / "below", folder / "here" / "link");
    const auto logs = find_logs({(folder / "here" / "link" / ".." / "x.data").string()});
    ASSERT_EQ(logs.size(), 1U);
    EXPECT_EQ(logs[0].place, folder / "far" / "x.data");
    EXPECT_TRUE(std::filesystem::equivalent(logs[0].path, folder / "far" / "x.data"));
    EXPECT_EQ(find_logs({(folder / "here" / ".." / "far" / "x.data").string()})[0].path, folder / "far" / "x.data");
}

TEST(FindLogs, GivesEachLogANameOfItsOwn) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"1/x.data", "2/x.data", "3/x.data", "4/x_2.data", "5/.data", "6/.data"}) {
        touch(folder / name);
    }
    EXPECT_THAT(names(find_logs({folder.string()})), ElementsAre("x", "x_2", "x_3", "x_2_2", "unnamed", "unnamed_2"));
}

TEST(FindLogs, ShortensNamesThatFilesCannotHave) {
    const auto names_of_long = [](const std::string& name) {
        std::set<std::string> taken;
        UniqueNames names;
        taken.insert(names.assign(name + ".data"));
        taken.insert(names.assign(name + ".data"));
        return std::vector<std::string>(taken.begin(), taken.end());
    };
    const auto shortened = names_of_long(std::string(245, 'x'));
    ASSERT_EQ(shortened.size(), 2U);
    EXPECT_EQ(shortened[0].size(), 200U + 1U + 16U);
    EXPECT_EQ(shortened[1], shortened[0] + "_2");
    EXPECT_NE(names_of_long(std::string(244, 'x') + "y")[0], shortened[0]);
    EXPECT_EQ(names_of_long(std::string(236, 'x'))[0], std::string(236, 'x'));
    std::string umlauts = "x";
    for (int i = 0; i < 122; ++i) umlauts += "\xC3\xBC";
    EXPECT_EQ(names_of_long(umlauts)[0].substr(0, 200), umlauts.substr(0, 199) + "~");
}

TEST(FindLogs, KeepsLinksToNowhereToBeReported) {
    const auto folder = test::scratch_dir();
    touch(folder / "good.data");
    std::filesystem::create_symlink("nowhere", folder / "absent.data");
    std::filesystem::create_symlink("loop.data", folder / "loop.data");
    EXPECT_THAT(names(find_logs({folder.string()})), ElementsAre("absent", "good", "loop"));
}

TEST(FindLogs, RefusesWhatIsNotThere) {
    const auto folder = test::scratch_dir();
    touch(folder / "a.log");
    EXPECT_EQ(rejected(
                  [&] {
                      find_logs({folder.string(), folder.string()});
                  },
                  folder.parent_path()),
              ": no log in FindLogs.RefusesWhatIsNotThere, FindLogs.RefusesWhatIsNotThere; expected "
              "*.data, *.LOG, *.tlm, *.bin, *.ulg or *.tlog, also .gz, .bz2, .xz or .zst, or flights as *.csv");
    EXPECT_EQ(
        rejected([&] { find_logs({(folder / "b.data").string()}); }, folder),
        "b.data: does not exist; expected a .data log, a .LOG or .tlm of an SD card, a .bin, .ulg or .tlog, or a folder of them");
    EXPECT_EQ(
        rejected([&] { find_logs({(folder / std::string(300, 'x')).string()}); }, folder),
        std::string(300, 'x') +
            ": File name too long; expected a .data log, a .LOG or .tlm of an SD card, a .bin, .ulg or .tlog, or a folder of them");
    EXPECT_EQ(
        rejected([&] { find_logs({""}); }),
        "'': does not exist; expected a .data log, a .LOG or .tlm of an SD card, a .bin, .ulg or .tlog, or a folder of them");
}

TEST(FindLogs, TakesTheReasonWhyAFolderBelowIsNotFitted) {
    const auto folder = test::scratch_dir();
    touch(folder / "a.data");
    touch(folder / "odd" / "b.data");
    touch(folder / "odd" / "deeper" / "c.data");
    write_text(folder / "odd" / "not-fitted.txt", "trials of a propeller\r\nin June\n");
    const auto reasons = [](const std::vector<std::string>& inputs) {
        std::vector<std::string> found;
        for (const auto& log : find_logs(inputs)) found.push_back(log.why_not_fitted);
        return found;
    };
    const std::string reason = "trials of a propeller";
    EXPECT_THAT(reasons({folder.string()}), ElementsAre("", reason, reason));
    EXPECT_THAT(reasons({folder.string() + "/"}), ElementsAre("", reason, reason));
    EXPECT_THAT(reasons({(folder / "odd").string()}), ElementsAre("", "")) << "asked for by name";
    EXPECT_THAT(reasons({folder.string(), (folder / "odd" / "b.data").string()}), ElementsAre("", "", reason));
    write_text(folder / "odd" / "not-fitted.txt", "\n");
    EXPECT_THAT(rejected([&] { find_logs({folder.string()}); }), testing::HasSubstr("not-fitted.txt:1"));
}

TEST(ListedPaths, AreLinesAsTheyStand) {
    EXPECT_THAT(parse_path_list("", "list"), ElementsAre());
    EXPECT_THAT(parse_path_list("a.data\n\n b c.data\n#d.data", "list"), ElementsAre("a.data", " b c.data", "#d.data"));
    EXPECT_EQ(rejected([] { parse_path_list(std::string_view("a.data\nb\0c", 10), "list"); }),
              "list:2: contains a NUL; expected the path of a log in each line, as find -print writes them");
}

TEST(FindLogs, TakesWhatIsListedAsItIs) {
    const auto folder = test::scratch_dir();
    const auto there = touch(folder / "there.data").string();
    const auto absent = (folder / "absent.data").string();
    EXPECT_THAT(names(find_logs({}, {there, absent})), ElementsAre("absent", "there"));
    EXPECT_THAT(names(find_logs({there}, {there})), ElementsAre("there"));
    EXPECT_THAT(names(find_logs({}, {folder.string()})), ElementsAre("there"));
}

TEST(FreeNames, AreTheNextOnesAlsoOfMany) {
    UniqueNames names;
    names.reserve("x_3");
    EXPECT_EQ(names.assign("x.data"), "x");
    EXPECT_EQ(names.assign("1/x.data"), "x_2");
    EXPECT_EQ(names.assign("2/x.data"), "x_4");
    EXPECT_EQ(names.assign("x@2.data"), "x@2_") << "x@2 is a recording of x";
    for (int i = 5; i < 20'000; ++i) names.assign("3/x.data");
    EXPECT_EQ(names.assign("4/x.data"), "x_20000");
}

}  // namespace
}  // namespace flightwatt::batch
