// Every program takes a binary log for a .data, with its .log or with --messages, and comes to what it comes to on the
// text that flightwatt convert makes of it.

#include "base/atomic_file.h"
#include "helpers/binary_frames.h"
#include "helpers/running_program.h"
#include "helpers/sample_logs.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

class BinaryLogs : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();
    std::string definitions = read_file(test::sample(1, ".log"));

    void SetUp() override {
        for (const auto* place : {"card", "text", "bare"}) std::filesystem::create_directories(folder / place);
        const auto messages = telemetry::parse_message_dictionary(definitions, "a.log");
        for (const int number : {1, 2}) {
            const auto name = number == 1 ? std::string("a") : std::string("b");
            const auto version = number == 1 ? test::LinkVersion::v1 : test::LinkVersion::v2;
            const auto log = test::card_log(read_file(test::sample(number)), messages, version);
            write_file_atomically(folder / "card" / (name + ".LOG"), log);
            write_file_atomically(folder / "card" / (name + ".log"), read_file(test::sample(number, ".log")));
            write_file_atomically(folder / "bare" / (name + ".tlm"), log);
        }
        write_file_atomically(folder / "m.xml", definitions.substr(definitions.find("<protocol")));
    }

    test::ProgramResult run(const std::string& command) { return test::run_shell("flightwatt " + command, folder); }

    /// What it prints, where a log's own name represents both.
    std::string printed(const std::string& command) {
        const auto result = run(command);
        EXPECT_EQ(result.code, 0) << command << "\n" << result.err;
        return std::regex_replace(result.out, std::regex("(card|text|bare)/([ab])\\.(LOG|data|tlm)"), "$2");
    }
};

TEST_F(BinaryLogs, AreReadAsTheirTextByEveryProgram) {
    for (const auto* name : {"a", "b"}) {
        const auto converted = run(std::string("convert card/") + name + ".LOG -o text/" + name + ".data");
        ASSERT_EQ(converted.code, 0) << converted.err;
        EXPECT_EQ(read_file(folder / "text" / (std::string(name) + ".log")),
                  read_file(folder / "card" / (std::string(name) + ".log")));
    }
    for (const std::string command :
         {"parse A", "segment A --json", "segment B", "fit A B --name x", "validate A B", "battery A B --name x"}) {
        const auto of = [&](const std::string& place, const std::string& ending) {
            auto text = std::regex_replace(command, std::regex("\\bA\\b"), place + "/a" + ending);
            return printed(std::regex_replace(text, std::regex("\\bB\\b"), place + "/b" + ending));
        };
        EXPECT_EQ(of("card", ".LOG"), of("text", ".data")) << command;
    }
    const auto unpacked = printed("parse card/a.LOG");
    ASSERT_EQ(test::run_shell("gzip card/a.LOG", folder).code, 0);
    EXPECT_TRUE(unpacked == printed("parse card/a.LOG.gz"));
}

TEST_F(BinaryLogs, NeverReplaceTheDefinitionsOfAnotherFlight) {
    write_file_atomically(folder / "text" / "a.log", "of another flight");
    const auto refused = run("convert card/a.LOG -o text/a.data");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("text/a.log is there already, with other definitions than card/a.log"));
    EXPECT_EQ(read_file(folder / "text" / "a.log"), "of another flight");
    EXPECT_FALSE(std::filesystem::exists(folder / "text" / "a.data"));
    std::filesystem::remove(folder / "text" / "a.log");
    EXPECT_EQ(run("convert card/a.LOG -o text/a.data").code, 0);
    EXPECT_EQ(run("convert card/a.LOG -o text/a.data").code, 0);  // the same again
}

TEST_F(BinaryLogs, WithoutALogTakeTheirDefinitionsFromMessages) {
    for (const std::string command : {"parse bare/a.tlm", "convert bare/b.tlm"}) {
        const auto refused = run(command);
        EXPECT_EQ(refused.code, 3);
        EXPECT_THAT(refused.err, HasSubstr("is a binary log, and no .log defines its messages"));
        EXPECT_THAT(refused.err, HasSubstr("--messages FILE"));
    }
    ASSERT_EQ(run("fit card/a.LOG card/b.LOG -o spread.toml").code, 0);
    for (const std::string command :
         {"parse bare/a.tlm", "segment bare/a.tlm", "fit bare/a.tlm bare/b.tlm --mix-aircraft",
          "validate bare/a.tlm bare/b.tlm --mix-aircraft", "battery bare/a.tlm --name x",
          "predict bare/a.tlm --model spread.toml --at 300 --remaining 100", "batch bare -o made --mix-aircraft"}) {
        const auto result = run(command + " --messages m.xml");
        EXPECT_EQ(result.code, 0) << command << "\n" << result.err;
    }
    const auto path = run("path --path-from bare/a.tlm --messages m.xml");
    EXPECT_EQ(path.code, 3);  // as of its text: the samples have none
    EXPECT_THAT(path.err, HasSubstr("has no airspeed_m_per_s"));
    const auto text = run("convert bare/b.tlm --messages m.xml");
    EXPECT_EQ(text.code, 0);
    EXPECT_THAT(text.out, HasSubstr(" ENERGY "));
}

TEST_F(BinaryLogs, OfABatchDependOnTheirDefinitions) {
    const std::string batch = "batch bare/a.tlm -o made --json --messages m.xml";
    ASSERT_EQ(run(batch).code, 0);
    const auto record = folder / "made" / "flights" / "a.record.json";
    const auto first = read_file(record);
    ASSERT_EQ(run(batch).code, 0);
    EXPECT_EQ(read_file(record), first);
    auto other = read_file(folder / "m.xml");
    const auto unit = other.find("UNIT=\"W\"");
    ASSERT_NE(unit, std::string::npos);
    other.replace(unit, 8, "UNIT=\"mW\"");
    write_file_atomically(folder / "m.xml", other);
    run(batch);
    EXPECT_NE(read_file(record), first) << "other definitions, another result";
}

TEST_F(BinaryLogs, AreFoundInFoldersAmongTheirDefinitions) {
    write_file_atomically(folder / "bare" / "a.LOG", definitions);  // XML, of a.tlm
    std::filesystem::remove(folder / "bare" / "b.tlm");
    const auto result = run("batch bare -o made --json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "made" / "flights" / "a.series.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder / "made" / "flights" / "a_2.record.json"));
}

TEST_F(BinaryLogs, AreConvertedBesideTheirOwnLog) {
    const auto result = run("convert card/a.LOG -o card/a.data --json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("\"framing\": \"SD card\""));
    EXPECT_THAT(result.out, HasSubstr("\"link\": \"pprzlink v1\""));
    EXPECT_EQ(run("convert card/a.data -o x.data").code, 3) << "text already";
    EXPECT_EQ(run("convert card/a.LOG -o card/a.LOG").code, 2);
    ASSERT_EQ(test::run_shell("gzip -k card/b.LOG", folder).code, 0);
    EXPECT_EQ(run("convert card/b.LOG.gz --max-log-mb 1 -o x.data").code, 0);
}

TEST_F(BinaryLogs, SayWhatTheyLack) {
    auto log = read_file(folder / "card" / "a.LOG");
    log.replace(log.size() / 2, 100, std::string(100, 'x'));
    write_file_atomically(folder / "card" / "a.LOG", log.substr(0, log.size() - 7) + std::string(4096, '\0'));
    const auto result = run("parse card/a.LOG -o s.csv");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("damaged, no frame with a valid checksum: "));
    const auto series = run("parse s.csv");
    EXPECT_THAT(series.err, HasSubstr("damaged, no frame with a valid checksum: ")) << "a series file loses nothing";
    const auto converted = run("convert card/a.LOG -o x.data");
    EXPECT_THAT(converted.err, HasSubstr("without a valid frame"));
    EXPECT_THAT(converted.err, HasSubstr("set aside"));
}

}  // namespace
}  // namespace flightwatt::cli
