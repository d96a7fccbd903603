#include "base/input_file.h"

#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt {
namespace {

class ReadFile : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    std::string reading(const std::filesystem::path& path, std::size_t max_bytes = max_file_bytes) const {
        return test::rejected([&] { read_file(path, max_bytes, "look again"); }, folder);
    }
};

TEST_F(ReadFile, TakesFilesAndPipes) {
    const std::string text = "one\ntwo\n" + std::string(200000, 'x');
    test::write_text(folder / "file", text);
    EXPECT_EQ(read_file(folder / "file"), text);
    EXPECT_EQ(read_file(test::write_text(folder / "empty", "")), "");
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    std::jthread writer([&] {
        EXPECT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
        ::close(ends[1]);
    });
    EXPECT_EQ(read_file("/dev/fd/" + std::to_string(ends[0])), text) << "as the shell's <(COMMAND)";
    ::close(ends[0]);
    EXPECT_NE(read_file("/proc/self/status"), "") << "a file that states it has no size";
}

TEST_F(ReadFile, SaysWhyItCannot) {
    std::filesystem::create_symlink("loop", folder / "loop");
    EXPECT_EQ(reading(folder / "missing"), "missing: cannot be read: No such file or directory; its folder has loop");
    EXPECT_EQ(reading(folder / "loop"), "loop: cannot be read: Too many levels of symbolic links");
    EXPECT_EQ(reading(folder), folder.string() + ": is a folder, expected a file; name a file in it");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(reading(folder / "pipe"), "pipe: is a pipe, expected a file") << "without waiting for a writer";
    EXPECT_EQ(reading("/dev/zero"), "/dev/zero: is a device, expected a file");
    const std::string long_name(300, 'n');
    EXPECT_EQ(reading(folder / long_name), long_name + ": cannot be read: File name too long");
    test::write_text(folder / "file", "x");
    EXPECT_EQ(reading(folder / "file" / "below"), "file/below: cannot be read: Not a directory");
}

TEST_F(ReadFile, SaysThatAFolderIsNotAllowed) {
    const auto user = ::geteuid();
    constexpr ::uid_t nobody_id = 65534;
    if (user == 0 && ::seteuid(nobody_id) != 0) GTEST_SKIP() << "root may read everything";
    ASSERT_EQ(::seteuid(user), 0);
    std::filesystem::create_directory(folder / "closed");
    test::write_text(folder / "closed" / "file", "x");
    std::filesystem::permissions(folder / "closed", std::filesystem::perms::none);
    if (user == 0) {
        ASSERT_EQ(::seteuid(nobody_id), 0);
    }
    EXPECT_EQ(reading(folder / "closed" / "file"), "closed/file: cannot be read: Permission denied");
    EXPECT_EQ(open_error(folder / "closed" / "file"), std::errc::permission_denied);
    ASSERT_EQ(::seteuid(user), 0);
    std::filesystem::permissions(folder / "closed", std::filesystem::perms::owner_all);
}

TEST_F(ReadFile, HasALimit) {
    test::write_text(folder / "file", std::string(100000, 'x'));
    EXPECT_EQ(reading(folder / "file", 100000), "");
    EXPECT_EQ(reading(folder / "file", 99999), "file: holds more than 0.1 MB; look again");
}

TEST(InputFile, TellsThatItWasCut) {
    const auto folder = test::scratch_dir();
    const InputFile file(test::write_text(folder / "file", "0123456789"));
    EXPECT_EQ(file.size(), 10U);
    const auto check = [&] { return test::rejected([&] { file.require_not_truncated(); }, folder); };
    EXPECT_EQ(check(), "");
    std::filesystem::resize_file(folder / "file", 20);
    EXPECT_EQ(check(), "") << "a log that grows is read as it was";
    std::filesystem::resize_file(folder / "file", 4);
    EXPECT_EQ(check(), "file: was cut from 10 to 4 bytes while it was read; run again when it is whole");
}

TEST(ReadingError, IsTheSystems) {
    const auto folder = test::scratch_dir();
    EXPECT_FALSE(open_error(test::write_text(folder / "file", "")));
    EXPECT_EQ(open_error(folder / "missing"), std::errc::no_such_file_or_directory);
    std::filesystem::create_symlink("loop", folder / "loop");
    EXPECT_EQ(open_error(folder / "loop"), std::errc::too_many_symbolic_link_levels);
}

constexpr auto variable = "FLIGHTWATT_TEST_FILES";

TEST(ProgramFiles, AreWhereTheVariableSays) {
    const auto folder = test::scratch_dir();
    ::setenv(variable, folder.c_str(), 1);
    EXPECT_EQ(data_folder("web", variable, "the files"), folder);
    ::unsetenv(variable);
}

TEST(ProgramFiles, StandInShareBesideTheFolderOfTheProgram) {
    // This test is in tests/ of the build, whose share/ is that of the programs in bin/.
    EXPECT_EQ(executable_folder().filename(), "tests");
    const auto folder = data_folder("docs", variable, "the pages");
    EXPECT_TRUE(std::filesystem::equivalent(folder, test::source_dir() / "docs"));
}

TEST(ProgramFiles, AreMissedWithTheirNameAndTheWayOut) {
    EXPECT_THAT(test::rejected([] { data_folder("absent", variable, "the pages"); }),
                testing::AllOf(testing::HasSubstr("share/flightwatt/absent"),
                               testing::HasSubstr("the pages are not there"), testing::HasSubstr(variable)));
}

TEST(FileKinds, OneTakenForAnotherIsNamed) {
    const auto refused = [](const std::string& text, FileKind expected) {
        return test::rejected([&] { require_kind(text, expected, "f"); });
    };
    const std::string model = "name = \"m\"\n[takeoff]\n";
    const std::string pack = "capacity_ah = 5\nresistance_ohm = 0.1\n";
    const std::string mission = "mechanical = \"m.toml\"\nbattery = \"p.toml\"\n[[schedule]]\n";
    EXPECT_EQ(refused(model, FileKind::battery),
              "f: is a mechanical model, not a battery; identify one with `flightwatt battery`");
    EXPECT_EQ(
        refused(mission, FileKind::log),
        "f: is a mission, not a log; expected a .data log, .LOG or .tlm of Paparazzi, a .bin, .ulg or .tlog, or a CSV of a flight");
    EXPECT_EQ(refused(pack, FileKind::mission),
              "f: is a battery, not a mission; write one with `flightwatt new-mission`");
    EXPECT_EQ(refused(" \n", FileKind::mission),
              "f: is empty, expected a mission; write one with `flightwatt new-mission`");
    EXPECT_EQ(refused(pack, FileKind::battery), "");
    EXPECT_EQ(refused("unknown = 1", FileKind::battery), "") << "its reader states what is missing";
    EXPECT_EQ(refused("time_s,power_w\n1,2\n", FileKind::log), "") << "a series";
    const std::string plans =
        "; expected a .plan, .waypoints, .kml or .geojson, a flight plan of Paparazzi (.xml), or a CSV of waypoints";
    EXPECT_EQ(refused("ULog\x01\x12\x35", FileKind::plan), "f: is a log, not a plan" + plans);
    EXPECT_EQ(refused(mission, FileKind::plan), "f: is a mission, not a plan" + plans);
    EXPECT_EQ(refused("\x01\x02", FileKind::plan), "f: is binary, not a plan" + plans);
    EXPECT_EQ(refused("", FileKind::plan), "f: is empty, expected a plan" + plans);
    EXPECT_EQ(refused("east_m,north_m\n1,2\n", FileKind::plan), "");
    EXPECT_EQ(refused("{ \"fileType\": \"Plan\" }", FileKind::log),
              "f: is a plan of QGroundControl, not a log; `flightwatt check` answers whether it fits, `flightwatt "
              "new-mission --plan` makes a mission of it");
}

TEST(FileKinds, AreKnownByTheirContent) {
    const auto refusal_of = [](const std::string& text) {
        return test::rejected([&] { require_kind(text, FileKind::mission, "f"); });
    };
    const std::vector<std::pair<std::string, std::string>> kinds{
        {"#ROSBAG V2.0\n", "a bag of ROS"},
        {"%PDF-1.7\n", "a PDF document"},
        {"ULog\x01\x12\x35", "a log"},
        {"FMT, 128, 89, FMT, BBnNZ", "a log"},
        {"garbage\n335.149 20 ENERGY 69 11.7 3.1\n", "a log"},
        {"<!-- x -->\n<configuration>\n", "the definitions of a log (.log)"},
        {"<!DOCTYPE flight_plan>\n<flight_plan alt=\"260\">", "a flight plan of Paparazzi"},
        {"<!DOCTYPE html>\n<html>", "a web page"},
        {"{ \"fileType\": \"Plan\" }", "a plan of QGroundControl"},
        {"QGC WPL 110\n0 1 0 16", "a list of waypoints of ArduPilot"},
        {"{ \"type\": \"FeatureCollection\" }", "a JSON file"},
        {"# comment\n[[disturbance]]\n", "a list of disturbances"},
        {"[sampler]\nkind = \"rapl\"", "a specification of flightwatt profile"},
        {"# made by\ntime_s,soc_percent\n", "a table (CSV)"}};
    for (const auto& [text, name] : kinds)
        EXPECT_THAT(refusal_of(text), testing::HasSubstr("is " + name + ", not a mission; ")) << text;
    for (const std::string text : {"hello", "\x89\x01\xFE", "a = 1\nb = [1, 2]\n", "\x01\x02"})
        EXPECT_EQ(refusal_of(text), "") << text;
    EXPECT_EQ(kind_of_text("# " + std::string(100000, ',')), FileKind::unknown) << "without end of the stack";
}

}  // namespace
}  // namespace flightwatt
