// Every file that a program can be given, replaced by what is no such file: the exit code of an input that was
// rejected, the system's own reason, and no more memory than a gigabyte.

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

/// Sanitizers need address space without end.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr const char* memory_limit = "";
#else
constexpr const char* memory_limit = "ulimit -v 1000000; ";
#endif

std::string repeated(const std::string& text, std::size_t times) {
    std::string all;
    for (std::size_t i = 0; i < times; ++i) all += text;
    return all;
}

class HostileInput : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();
    std::string source = test::source_dir().string();

    /// A model of two flights, which `predict` needs.
    static const std::string& spread_model() {
        static const auto text = [] {
            const auto made_in = test::scratch_dir();
            const auto logs = test::source_dir() / "logs" / "opterra_synthetic_0";
            const auto command =
                fmt::format("flightwatt fit {0}1.data {0}2.data --order 1 -o model.toml", logs.string());
            EXPECT_EQ(test::run_shell(command, made_in).code, 0);
            return read_file(made_in / "model.toml");
        }();
        return text;
    }

    void SetUp() override {
        test::write_text(folder / "spread.toml", spread_model());
        for (const auto& log : {"logs/opterra_synthetic_01.data", "logs/opterra_synthetic_01.log"}) {
            const auto from = test::source_dir() / log;
            std::filesystem::copy_file(from, folder / from.filename());
        }
        test::write_text(folder / "recordings.cfg", "[combinations]\nFILE=1\n");
        const auto mission = [&](const char* name, const std::string& model, const std::string& battery,
                                 const std::string& profile) {
            test::write_text(folder / name, fmt::format("name = \"m\"\nmechanical = \"{}\"\nbattery = \"{}\"\n"
                                                        "[components.detection]\nprofile = \"{}\"\n",
                                                        model, battery, profile));
        };
        const auto model = source + "/fits/mechanical/opterra-table1.toml";
        const auto battery = source + "/fits/battery/paper.toml";
        mission("of_model.toml", "FILE", battery, source + "/fits/compute/tx2-detection.csv");
        mission("of_battery.toml", model, "FILE", source + "/fits/compute/tx2-detection.csv");
        mission("of_profile.toml", model, battery, "FILE");
    }

    /// Commands with FILE where the file goes; one in a mission is put there by sed.
    std::vector<std::string> commands() const {
        const std::string log = "opterra_synthetic_01.data";
        const auto sed = [](const char* file, const std::string& command) {
            return fmt::format("sed 's|FILE|FILE_NAME|' {} > changed_{} && {}changed_{}", file, file, command, file);
        };
        return {"flightwatt parse FILE",
                "flightwatt segment FILE",
                "flightwatt fit FILE",
                "flightwatt validate FILE",
                "flightwatt battery FILE",
                "flightwatt batch FILE -o out",
                "flightwatt predict FILE --model spread.toml --at 100 --remaining 10",
                "flightwatt predict " + log + " --model FILE --at 100 --remaining 10",
                "flightwatt fit " + log + " --published FILE",
                "flightwatt synthesize FILE -o synthetic",
                "flightwatt simulate FILE",
                "flightwatt compare FILE",
                "flightwatt plan FILE",
                "flightwatt report FILE -o report.html",
                "flightwatt simulate " + source + "/missions/paper/phased.toml --disturb FILE",
                "flightwatt profile FILE -o profiles",
                "flightwatt profile --check-interpolation FILE",
                sed("of_model.toml", "flightwatt simulate "),
                sed("of_battery.toml", "flightwatt simulate "),
                sed("of_profile.toml", "flightwatt simulate "),
                sed("recordings.cfg", "flightwatt profile --parameters fps --check-interpolation ")};
    }

    std::vector<test::ProgramResult> results_with(const std::string& file) const {
        std::vector<test::ProgramResult> results;
        for (auto command : commands()) {
            const auto replace = [&](const std::string& word) {
                for (auto at = command.find(word); at != std::string::npos; at = command.find(word, at + file.size())) {
                    command.replace(at, word.size(), file);
                }
            };
            if (command.find("FILE_NAME") != std::string::npos) {
                replace("FILE_NAME");
            } else {
                replace("FILE");
            }
            results.push_back(test::run_shell(memory_limit + command, folder));
            const auto& result = results.back();
            EXPECT_THAT(result.code, AnyOf(2, 3)) << command << "\n" << result.err;
            EXPECT_THAT(result.err, Not(HasSubstr("internal error"))) << command;
            EXPECT_THAT(result.err, Not(HasSubstr("not enough memory"))) << command;
            EXPECT_LT(result.err.size(), 6000U) << command;
        }
        return results;
    }
};

class HostileInputStudy : public HostileInput {};

TEST_F(HostileInput, IsALinkLoop) {
    std::filesystem::create_symlink("loop", folder / "loop");
    for (const auto& result : results_with((folder / "loop").string()))
        EXPECT_THAT(result.err, HasSubstr("Too many levels of symbolic links"));
}

TEST_F(HostileInput, HasANameThatIsTooLong) {
    for (const auto& result : results_with(folder.string() + "/" + std::string(300, 'n')))
        EXPECT_THAT(result.err, HasSubstr("File name too long"));
}

TEST_F(HostileInput, IsAFolder) {
    std::filesystem::create_directory(folder / "empty_folder");
    results_with((folder / "empty_folder").string());
}

TEST_F(HostileInputStudy, HasNoEnd) { results_with("/dev/zero"); }

TEST_F(HostileInput, IsDeep) {
    const auto file = folder / "deep";
    for (const auto& text :
         {"a" + repeated(".a", 60000) + " = 1\n", repeated("[", 1000000), repeated("{\"a\":", 300000)}) {
        test::write_text(file, text);
        results_with(file.string());
    }
}

TEST_F(HostileInputStudy, IsOneWideLine) {
    test::write_text(folder / "wide.csv", repeated("power_w,", 2000000) + "\n");
    results_with((folder / "wide.csv").string());
}

TEST_F(HostileInput, IsABomb) {
    ASSERT_EQ(test::run_shell("head -c 2G /dev/zero | zstd -1 -c > bomb.data.zst", folder).code, 0);
    results_with((folder / "bomb.data.zst").string());
    const auto parsed = test::run_shell("flightwatt parse bomb.data.zst --max-log-mb 3", folder);
    EXPECT_THAT(parsed.err, HasSubstr("bomb.data.zst: error: unpacks to more than 3 MB"));
}

/// Each is segmented to see whether it flew.
TEST_F(HostileInput, IsALogOfManyAircraft) {
    std::string text;
    for (int i = 0; i < 40; ++i) {
        const auto sender = 100 + i % 20 + (i >= 20 ? 20 : 0);
        text += fmt::format("{0} {1} ENERGY 69 11.7 3.1 36.6 0.03 0.31\n{0} {1} ESTIMATOR 1 0\n", 0.1 * i, sender);
    }
    test::write_text(folder / "many.data", text);
    const auto result = test::run_shell("flightwatt segment many.data", folder);
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.err,
                HasSubstr("many.data: error: 40 senders may be aircraft: 100, 101, 102, 103, 104, 105, 106, "
                          "107, 108, 109, 110, 111 ... and 28 more; select one with --aircraft ID"));
}

/// Each phase is looked up among all samples.
TEST_F(HostileInput, IsALogOfManySorties) {
    std::string text;
    for (int i = 0; i < 120000; ++i) {
        const int of_flight = i % 100 - 50;  // below 0 it rests; it climbs and descends by 20 m a sample
        const int altitude_m = std::clamp(20 * std::min(of_flight, 49 - of_flight), 0, 100);
        text += fmt::format("{0:.1f} 1 ESTIMATOR {1} 0\n{0:.1f} 1 ENERGY {2} 12 1 12 1 1\n", 6.4 * i, altitude_m,
                            of_flight >= 0 ? 50 : 0);
    }
    test::write_text(folder / "many.data", text);
    const auto result = test::run_shell("flightwatt segment many.data", folder);
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.err, HasSubstr("many.data: error: 1200 sorties in 120000 samples of power; is it the log of one "
                                      "flight? Split it, or select a sortie with --sortie N"));
    EXPECT_EQ(test::run_shell("flightwatt segment many.data --sortie 3 -o phases.csv", folder).code, 0);
}

/// The time of the cut is random: a log that is cut at any moment is rejected or read, and the batch goes to its end.
TEST_F(HostileInputStudy, IsCutWhileABatchReadsIt) {
    const auto log = read_file(folder / "opterra_synthetic_01.data");
    std::filesystem::create_directory(folder / "in");
    test::write_text(folder / "in" / "sound.data", log);
    for (int round = 0; round < 6; ++round) {
        test::write_text(folder / "in" / "cut.data", repeated(log, 60));
        const auto batch = test::start_program("flightwatt-batch", {"in", "-o", "out", "--jobs", "2"}, folder);
        std::this_thread::sleep_for(std::chrono::milliseconds(8 * round));
        std::filesystem::resize_file(folder / "in" / "cut.data", 5000);
        EXPECT_THAT(test::exit_code_of(batch), AnyOf(0, 3));
        EXPECT_TRUE(std::filesystem::exists(folder / "out" / "flights" / "sound.series.csv"));
        EXPECT_TRUE(std::filesystem::exists(folder / "out" / "model.toml"));
    }
}

/// Numbers that no option means.
TEST_F(HostileInput, IsANumberThatIsNone) {
    const auto help = [&](const std::string& program) { return test::run_shell(program + " --help-all", folder).out; };
    for (const auto& option : {"rest-time", "hold-time", "idle-throttle", "cruise-fraction", "ground-fraction",
                               "flight-height", "max-log-mb", "sortie"}) {
        ASSERT_THAT(help("flightwatt-segment"), HasSubstr(std::string("--") + option + " "));
        for (const auto& number : {"nan", "inf", "-inf", "-1", "1e300"}) {
            const auto result = test::run_shell(
                fmt::format("flightwatt segment opterra_synthetic_01.data --{}={}", option, number), folder);
            EXPECT_EQ(result.code, 2) << option << " " << number;
            EXPECT_THAT(result.err, HasSubstr("expected")) << option << " " << number;
        }
    }
    const auto mission = source + "/missions/paper/phased.toml ";
    const std::string log = "opterra_synthetic_01.data ";
    const auto model = source + "/fits/mechanical/opterra-table1.toml ";
    const std::vector<std::string> commands{
        "simulate " + mission + "--step=",
        "simulate " + mission + "--samples=",
        "plan " + mission + "--probability=",
        "fit " + log + "--order=",
        "battery " + log + "--capacity=",
        "battery " + log + "--cells=",
        "predict " + log + "--model " + model + "--remaining 10 --at=",
        "predict " + log + "--model " + model + "--remaining 10 --at-log-time=",
        "predict " + log + "--model " + model + "--at 100 --remaining=",
        "predict " + log + "--model " + model + "--at 100 --remaining 10 --airspeed=",
        "predict " + log + "--model " + model + "--at 100 --remaining 10 --battery b.toml --initial-soc=",
        "validate " + log + "--at=",
        "synthesize " + model + "-o s --flights=",
        "synthesize " + model + "-o s --spread=",
        "synthesize " + model + "-o s --current-noise=",
        "synthesize " + model + "-o s --cruise=",
        "batch " + log + "-o out --jobs=",
        "report " + mission + "-o r.html --capacity=",
    };
    for (const auto& command : commands) {
        for (const auto& number : {"nan", "inf", "-inf", "-1"}) {
            const auto result = test::run_shell("flightwatt " + command + number, folder);
            EXPECT_EQ(result.code, 2) << command << number << "\n" << result.err;
        }
    }
}

}  // namespace
}  // namespace flightwatt::cli
