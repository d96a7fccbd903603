#include "telemetry/data_file.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::StartsWith;

TEST(DataFile, ReadsEveryCompression) {
    const auto folder = test::scratch_dir();
    std::string text;
    for (int i = 0; i < 500; ++i) text += std::to_string(i) + " 20 PONG \n";
    const auto plain = folder / "x.data";
    std::ofstream(plain, std::ios::binary) << text;
    EXPECT_EQ(DataFile(plain).text(), text);
    for (const std::string tool : {"gzip", "bzip2", "xz", "zstd"}) {
        const auto packed = tool + ".data";
        const auto result = test::run_shell(tool + " -c x.data > " + packed, folder);
        ASSERT_EQ(result.code, 0) << result.err << "scripts/install_dependencies installs it";
        EXPECT_EQ(DataFile(folder / packed).text(), text) << tool;
    }
}

class RefusedFile : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    std::string reading(const std::string& name) const {
        return test::rejected([&] { DataFile(folder / name).text(); }, folder);
    }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder / name, std::ios::binary) << bytes;
    }
};

TEST_F(RefusedFile, IsNone) {
    std::filesystem::create_directory(folder / "folder.data");
    EXPECT_EQ(reading("missing.data"), "missing.data: does not exist");
    EXPECT_EQ(reading("folder.data"), "folder.data: is a folder, expected a Paparazzi .data file");
    std::filesystem::create_symlink("/dev/null", folder / "device.data");
    EXPECT_EQ(reading("device.data"), "device.data: is not a regular file");
}

TEST_F(RefusedFile, WasNeverWritten) {
    write("log.data", "1 20 PONG \n");
    std::filesystem::resize_file(folder / "log.data", 1'100'000);
    const auto read = [&](std::size_t max_bytes) {
        return test::rejected([&] { DataFile(folder / "log.data", max_bytes).text(); }, folder);
    };
    EXPECT_EQ(read(1'200'000), "") << "room that was set aside";
    EXPECT_THAT(read(1'000'000), StartsWith("log.data: 1.1 MB of its 1.1 MB were never written and are zeros"));
}

TEST_F(RefusedFile, HoldsNothing) {
    write("empty.data", "");
    EXPECT_EQ(reading("empty.data"), "empty.data: is empty, expected telemetry lines: TIME SENDER NAME FIELD ...");
    ASSERT_EQ(test::run_shell("gzip -c empty.data > packed.data", folder).code, 0);
    EXPECT_EQ(reading("packed.data"), "packed.data: is empty once decompressed");
}

TEST_F(RefusedFile, IsPackedInAWayThatCannotBeRead) {
    write("packed.data", "PK\x03\x04zip");
    EXPECT_EQ(reading("packed.data"), "packed.data: is a ZIP archive; unpack it, or compress with gzip, xz or zstd");
    write("broken.data", std::string("\x1F\x8B\x08\0\0broken", 11));
    EXPECT_THAT(reading("broken.data"), StartsWith("broken.data: cannot be decompressed: "));
}

/// Each compression tells a file that ends too soon from one that is whole.
TEST_F(RefusedFile, IsCutOff) {
    std::string text;
    for (int i = 0; i < 5000; ++i) text += std::to_string(i * i) + " 20 PONG \n";
    write("x.data", text);
    for (const std::string tool : {"gzip", "bzip2", "xz", "zstd"}) {
        ASSERT_EQ(test::run_shell(tool + " -c x.data | head -c 5000 > cut.data", folder).code, 0) << tool;
        EXPECT_THAT(reading("cut.data"), StartsWith("cut.data: cannot be decompressed: ")) << tool;
    }
}

/// A small file may unpack to any size: a few kB of zstd held 4 GB.
TEST_F(RefusedFile, UnpacksToMoreThanTheLimit) {
    constexpr std::size_t max_bytes = 1'000'000;
    for (const std::string tool : {"gzip", "bzip2", "xz", "zstd"}) {
        ASSERT_EQ(test::run_shell("head -c 1000001 /dev/zero | " + tool + " -c > bomb.data", folder).code, 0) << tool;
        const auto message = test::rejected([&] { DataFile(folder / "bomb.data", max_bytes); }, folder);
        EXPECT_EQ(message,
                  "bomb.data: unpacks to more than 1 MB; if it is a log all the same, --max-log-mb raises the limit");
        EXPECT_EQ(DataFile(folder / "bomb.data", max_bytes + 1).text().size(), max_bytes + 1) << tool;
    }
}

TEST_F(RefusedFile, IsOutOfReach) {
    std::filesystem::create_symlink("loop.data", folder / "loop.data");
    EXPECT_EQ(reading("loop.data"), "loop.data: cannot be read: Too many levels of symbolic links");
    const std::string long_name(300, 'n');
    EXPECT_EQ(reading(long_name), long_name + ": cannot be read: File name too long");
}

std::string lines_of_bytes(std::size_t bytes) {
    std::string text;
    while (text.size() < bytes) text += "1.5 20 PONG\n";
    return text;
}

/// Without the care of MappedFile these end the whole test program by SIGBUS.
class CutLog : public RefusedFile {};

TEST_F(CutLog, ReadsAsZerosAndIsRefused) {
    write("x.data", lines_of_bytes(100000));
    const DataFile file(folder / "x.data");
    EXPECT_NO_THROW(file.require_unchanged());
    std::filesystem::resize_file(folder / "x.data", 5000);
    EXPECT_EQ(file.text()[3], ' ');
    EXPECT_EQ(file.text()[5001], '\0');
    EXPECT_EQ(file.text()[90000], '\0');
    const auto check = [&] { return test::rejected([&] { file.require_unchanged(); }, folder); };
    EXPECT_THAT(check(), StartsWith("x.data: was cut from 10"));
    std::filesystem::resize_file(folder / "x.data", 200000);
    EXPECT_EQ(file.text()[90000], '\0');
    EXPECT_EQ(check(),
              "x.data: could not be read to its end: it was cut meanwhile, or the disk failed; "
              "run again when it is whole")
        << "it has grown again since";
}

TEST_F(CutLog, MayGrow) {
    write("x.data", lines_of_bytes(1000));
    const DataFile file(folder / "x.data");
    const auto size = file.text().size();
    std::ofstream(folder / "x.data", std::ios::app) << lines_of_bytes(100000);
    EXPECT_EQ(file.text().size(), size);
    EXPECT_NO_THROW(file.require_unchanged());
}

TEST_F(CutLog, DoesNotDisturbOthersInOtherThreads) {
    constexpr int threads = 8;
    constexpr std::size_t bytes = 400000;
    std::vector<int> damaged(threads);
    {
        std::vector<std::jthread> readers;
        for (int i = 0; i < threads; ++i) {
            readers.emplace_back([&, i] {
                const auto name = std::to_string(i) + ".data";
                for (int round = 0; round < 20; ++round) {
                    write(name, lines_of_bytes(bytes));
                    const DataFile file(folder / name);
                    const bool cut = i % 2 == 0;
                    if (cut) std::filesystem::resize_file(folder / name, 8192);
                    const auto zeros = std::ranges::count(file.text(), '\0');
                    const bool refused = !test::rejected([&] { file.require_unchanged(); }).empty();
                    if ((zeros > 0) != cut || refused != cut) ++damaged[static_cast<std::size_t>(i)];
                }
            });
        }
    }
    EXPECT_EQ(damaged, std::vector<int>(threads));
}

/// What else this signal means still ends a program.
TEST_F(CutLog, LeavesTheSignalToOthers) {
    write("x.data", lines_of_bytes(100000));
    const auto raise_after_reading = [&] {
        const DataFile file(folder / "x.data");
        std::filesystem::resize_file(folder / "x.data", 100);
        if (file.text()[90000] == '\0') std::raise(SIGBUS);
        std::_Exit(0);
    };
    EXPECT_DEATH(raise_after_reading(), "");
}

/// Text that compresses a little, and blanks that become blocks of one repeated byte, by frames of several kinds.
class ZstdFrames : public RefusedFile {
  protected:
    std::string packed_by(const std::string& command) const {
        std::string text(300000, ' ');
        for (int i = 0; i < 30000; ++i) text += std::to_string(i * i % 9973) + "\n";
        write("x", text);
        EXPECT_EQ(test::run_shell(command + " > packed", folder).code, 0);
        return read_file(folder / "packed");
    }
    std::string reading_of(const std::string& bytes) const {
        write("bytes.data", bytes);
        return reading("bytes.data");
    }
};

TEST_F(ZstdFrames, AreWholeAtTheirEndsAlone) {
    for (const auto* command : {"zstd -c x", "zstd --no-check -c x", "cat x | zstd -19 -c", "head -c 10 x | zstd -c"}) {
        const auto packed = packed_by(command);
        EXPECT_EQ(reading_of(packed), "") << command;
        for (std::size_t size = 4; size < packed.size(); size += 1 + packed.size() / 500) {
            EXPECT_EQ(reading_of(packed.substr(0, size)),
                      "bytes.data: cannot be decompressed: a zstd frame is cut off; is the file whole?")
                << command << ", " << size;
        }
    }
}

TEST_F(ZstdFrames, MayFollowOneAnother) {
    const std::string skippable("\x50\x2A\x4D\x18\x03\0\0\0abc", 11);
    const auto packed = packed_by("zstd -c x") + skippable + packed_by("head -c 10 x | zstd -c");
    EXPECT_EQ(reading_of(packed), "");
    EXPECT_NE(reading_of(packed.substr(0, packed.size() - 1)), "");
    EXPECT_NE(reading_of(packed + "x"), "");
}

}  // namespace
}  // namespace flightwatt::telemetry
