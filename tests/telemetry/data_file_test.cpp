#include "telemetry/data_file.h"

#include "helpers/rejected.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <fstream>
#include <string>

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

TEST_F(RefusedFile, HoldsNothing) {
    write("empty.data", "");
    EXPECT_EQ(reading("empty.data"),
              "empty.data: is empty, expected telemetry lines: TIME SENDER NAME FIELD ...");
    ASSERT_EQ(test::run_shell("gzip -c empty.data > packed.data", folder).code, 0);
    EXPECT_EQ(reading("packed.data"), "packed.data: is empty once decompressed");
}

TEST_F(RefusedFile, IsPackedInAWayThatCannotBeRead) {
    write("packed.data", "PK\x03\x04zip");
    EXPECT_EQ(reading("packed.data"),
              "packed.data: is a ZIP archive; unpack it, or compress with gzip, xz or zstd");
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

}  // namespace
}  // namespace flightwatt::telemetry
