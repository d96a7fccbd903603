#include "telemetry/text/zstd_frames.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

/// Text that compresses a little, and blanks that become blocks of one repeated byte.
std::string packed_by(const std::string& command) {
    const auto folder = test::scratch_dir();
    std::string text(300000, ' ');
    for (int i = 0; i < 30000; ++i) text += std::to_string(i * i % 9973) + "\n";
    test::write_text(folder / "x", text);
    EXPECT_EQ(test::run_shell(command + " > packed", folder).code, 0);
    return read_file(folder / "packed");
}

TEST(ZstdFrames, AreWholeAtTheirEndsAlone) {
    for (const auto* command :
         {"zstd -c x", "zstd --no-check -c x", "cat x | zstd -19 -c", "head -c 10 x | zstd -c"}) {
        const auto packed = packed_by(command);
        EXPECT_TRUE(holds_whole_zstd_frames(packed)) << command;
        for (std::size_t size = 1; size < packed.size(); size += 1 + packed.size() / 500) {
            EXPECT_FALSE(holds_whole_zstd_frames(packed.substr(0, size))) << command << ", " << size;
        }
    }
}

TEST(ZstdFrames, MayFollowOneAnother) {
    const std::string skippable("\x50\x2A\x4D\x18\x03\0\0\0abc", 11);
    const auto packed = packed_by("zstd -c x") + skippable + packed_by("head -c 10 x | zstd -c");
    EXPECT_TRUE(holds_whole_zstd_frames(packed));
    EXPECT_FALSE(holds_whole_zstd_frames(packed.substr(0, packed.size() - 1)));
    EXPECT_FALSE(holds_whole_zstd_frames(packed + "x"));
}

TEST(ZstdFrames, AreNoOtherBytes) {
    EXPECT_FALSE(holds_whole_zstd_frames("plain text"));
    EXPECT_FALSE(holds_whole_zstd_frames("\x28\xB5\x2F\xFD"));
}

}  // namespace
}  // namespace flightwatt::telemetry
