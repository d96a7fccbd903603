#include "telemetry/data_file.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <fstream>
#include <string>
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
    EXPECT_EQ(read_data_file(plain), text);
    for (const std::string tool : {"gzip", "bzip2", "xz", "zstd"}) {
        const auto packed = tool + ".data";
        const auto result = test::run_shell(tool + " -c x.data > " + packed, folder);
        ASSERT_EQ(result.code, 0) << result.err << "scripts/install_dependencies tests installs it";
        EXPECT_EQ(read_data_file(folder / packed), text) << tool;
    }
}

class RefusedFile : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    std::string reading(const std::string& name) const {
        return test::rejected([&] { read_data_file(folder / name); }, folder);
    }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder / name, std::ios::binary) << bytes;
    }
};

TEST_F(RefusedFile, IsNone) {
    std::filesystem::create_directory(folder / "folder.data");
    EXPECT_EQ(reading("missing.data"),
              "missing.data: cannot be read: No such file or directory; its folder has folder.data");
    EXPECT_EQ(reading("folder.data"), "folder.data: is a folder, expected a file; name a file in it");
    std::filesystem::create_symlink("/dev/null", folder / "device.data");
    EXPECT_EQ(reading("device.data"), "device.data: is not a regular file");
}

TEST_F(RefusedFile, HasZerosWithoutEnd) {
    write("log.data", "1 20 PONG \n");
    std::filesystem::resize_file(folder / "log.data", 1'100'000);
    const auto read = [&](std::size_t max_bytes) {
        return test::rejected([&] { read_data_file(folder / "log.data", max_bytes); }, folder);
    };
    EXPECT_EQ(read(1'200'000), "") << "preallocated space";
    EXPECT_EQ(read(1'000'000), "log.data: has more than 1 MB of zeros; expected a telemetry log");
}

TEST_F(RefusedFile, HoldsNothing) {
    write("empty.data", "");
    EXPECT_EQ(reading("empty.data"), "empty.data: is empty, expected a log; nothing was logged, or it was not copied");
    ASSERT_EQ(test::run_shell("gzip -c empty.data > packed.data", folder).code, 0);
    EXPECT_EQ(reading("packed.data"), "packed.data: is empty once decompressed");
}

TEST_F(RefusedFile, IsPackedInAWayThatCannotBeRead) {
    write("packed.data", "PK\x03\x04zip");
    EXPECT_EQ(reading("packed.data"), "packed.data: is a ZIP archive; unpack it, or compress with gzip, xz or zstd");
    write("broken.data", std::string("\x1F\x8B\x08\0\0broken", 11));
    EXPECT_THAT(reading("broken.data"), StartsWith("broken.data: cannot be decompressed: "));
}

/// Each compression distinguishes a file that ends too soon from a whole one.
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
        const auto message = test::rejected([&] { read_data_file(folder / "bomb.data", max_bytes); }, folder);
        EXPECT_EQ(message, "bomb.data: unpacks to more than 1 MB; if it is a log, --max-log-mb raises the limit");
        EXPECT_EQ(read_data_file(folder / "bomb.data", max_bytes + 1).size(), max_bytes + 1) << tool;
    }
}

TEST_F(RefusedFile, IsOutOfReach) {
    std::filesystem::create_symlink("loop.data", folder / "loop.data");
    EXPECT_EQ(reading("loop.data"), "loop.data: cannot be read: Too many levels of symbolic links");
    const std::string long_name(300, 'n');
    EXPECT_EQ(reading(long_name), long_name + ": cannot be read: File name too long");
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
                      "bytes.data: cannot be decompressed: a zstd frame is cut off; is the file complete?")
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
