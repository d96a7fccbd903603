#include "live/followed_files.h"

#include "base/error.h"
#include "helpers/test_paths.h"
#include "live/sources.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using std::chrono::milliseconds;

void append(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::app | std::ios::binary) << text;
}

std::vector<IncomingMessage> received(MessageSource& source) {
    std::vector<IncomingMessage> messages;
    source.receive(milliseconds(50), messages);
    return messages;
}

TEST(FollowedFiles, AFileIsReadFromItsBeginningAndAsItGrows) {
    const auto path = test::scratch_dir() / "a.data";
    append(path, "1.0 20 PONG\n2.0 20 PO");
    const auto source = follow_data_file(path);
    auto messages = received(*source);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_EQ(messages[0].time_s, 1.0);
    EXPECT_FALSE(messages[0].is_after_restart);
    EXPECT_TRUE(received(*source).empty());
    append(path, "NG\nrubbish\n3.0 20 PONG\n");
    messages = received(*source);
    ASSERT_EQ(messages.size(), 2U);
    EXPECT_EQ(messages[0].text, "20 PONG");
    EXPECT_FALSE(source->at_end());
    EXPECT_EQ(source->report().messages, 3U);
    EXPECT_EQ(source->report().unusable.size(), 1U);
}

TEST(FollowedFiles, AFileThatIsCutOrReplacedBeginsAnew) {
    const auto folder = test::scratch_dir();
    const auto path = folder / "a.data";
    append(path, "1000.0 20 PONG\n1001.0 20 PONG\n");
    const auto source = follow_data_file(path);
    EXPECT_EQ(received(*source).size(), 2U);
    std::filesystem::resize_file(path, 0);
    append(path, "1.0 20 PONG\n");
    auto messages = received(*source);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_TRUE(messages[0].is_after_restart);
    append(folder / "b.data", "0.5 20 ALIVE 1\n");
    std::filesystem::rename(folder / "b.data", path);
    messages = received(*source);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_TRUE(messages[0].is_after_restart);
    EXPECT_EQ(messages[0].text, "20 ALIVE 1");
    EXPECT_EQ(source->report().restarts, 2U);
}

TEST(FollowedFiles, AnotherFileIsReadHoweverShortTheWait) {
    const auto folder = test::scratch_dir();
    append(folder / "a.data", "1.0 20 PONG\n");
    const auto source = follow_data_file(folder / "a.data");
    EXPECT_EQ(received(*source).size(), 1U);
    append(folder / "b.data", "0.5 20 PONG\n");
    std::filesystem::rename(folder / "b.data", folder / "a.data");
    std::vector<IncomingMessage> messages;
    source->receive(milliseconds(0), messages);
    EXPECT_EQ(messages.size(), 1U);
}

TEST(FollowedFiles, AFileThatIsGoneForAWhileIsWaitedFor) {
    const auto path = test::scratch_dir() / "a.data";
    append(path, "1.0 20 PONG\n");
    const auto source = follow_data_file(path);
    EXPECT_EQ(received(*source).size(), 1U);
    std::filesystem::remove(path);
    EXPECT_TRUE(received(*source).empty());
    append(path, "2.0 20 PONG\n");
    EXPECT_EQ(received(*source).size(), 1U);
}

TEST(FollowedFiles, RefusesWhatIsNoFile) {
    EXPECT_THROW(follow_data_file(test::scratch_dir() / "none.data"), InputError);
    EXPECT_THROW(follow_data_file(test::scratch_dir()), InputError);
    EXPECT_THROW(follow_data_file("/dev/null"), InputError);
}

}  // namespace
}  // namespace flightwatt::live
