#include "base/atomic_file.h"

#include "base/error.h"
#include "base/input_file.h"
#include "helpers/test_paths.h"

#include <algorithm>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt {
namespace {

TEST(AtomicFile, ReplacesTheContentAndLeavesNothingElse) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "a.txt", "old");
    write_file_atomically(folder / "a.txt", "new");
    EXPECT_EQ(read_file(folder / "a.txt"), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(AtomicFile, WritesATextInPieces) {
    const auto folder = test::scratch_dir();
    const auto file = folder / "a.txt";
    const TextWriter count = [](const TextSink& sink) {
        for (const auto* piece : {"one", "", " two"}) sink(piece);
    };
    write_file_atomically(file, count);
    EXPECT_EQ(read_file(file), "one two");
    EXPECT_THROW(write_file_atomically("/dev/full", count), OutputError);
    // One that is broken off leaves the old text, and nothing of the new.
    const TextWriter broken = [](const TextSink& sink) {
        sink("three");
        throw InputError({"b"}, "is cut");
    };
    EXPECT_THROW(write_file_atomically(file, broken), InputError);
    EXPECT_EQ(read_file(file), "one two");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(AtomicFile, RefusesWhatCannotBeWrittenAndKeepsWhatWasThere) {
    const auto folder = test::scratch_dir();
    EXPECT_THROW(write_file_atomically(folder / "missing" / "a.txt", "x"), OutputError);
    EXPECT_THROW(write_file_atomically(folder, "x"), OutputError);
    EXPECT_TRUE(std::filesystem::is_directory(folder));
    EXPECT_THROW(write_file_atomically("/dev/full", "x"), OutputError);
    EXPECT_THROW(write_file_atomically(folder / std::string(300, 'x'), "x"), OutputError);
    std::filesystem::create_symlink("loop", folder / "loop");
    EXPECT_THROW(write_file_atomically(folder / "loop", "x"), OutputError);
    EXPECT_THROW(make_directories(folder / "a.txt" / "b" / std::string(300, 'x')), OutputError);
}

std::filesystem::perms permissions(const std::filesystem::path& file) {
    return std::filesystem::status(file).permissions();
}

TEST(AtomicFile, WritesWhatALinkPointsTo) {
    const auto folder = test::scratch_dir();
    std::filesystem::create_directories(folder / "results");
    write_file_atomically(folder / "results" / "a.txt", "old");
    std::filesystem::create_symlink("results/a.txt", folder / "link");
    std::filesystem::create_symlink(folder / "link", folder / "link to link");
    std::filesystem::create_symlink("results/new.txt", folder / "to nothing");
    write_file_atomically(folder / "link to link", "new");
    write_file_atomically(folder / "to nothing", "first");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link to link"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "to nothing"));
    EXPECT_EQ(read_file(folder / "results" / "a.txt"), "new");
    EXPECT_EQ(read_file(folder / "results" / "new.txt"), "first");
}

TEST(AtomicFile, WritesOpenFilesThatAreNamedAsDevStdoutIs) {
    const auto folder = test::scratch_dir();
    const int file = ::open((folder / "redirected").c_str(), O_RDWR | O_CREAT, 0600);
    std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(file), folder / "stdout");
    write_file_atomically(folder / "stdout", "x");
    char written = ' ';
    EXPECT_EQ(::pread(file, &written, 1, 0), 1);  // not another file of that name
    EXPECT_EQ(written, 'x');
    ::close(file);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "stdout"));
}

TEST(AtomicFile, FollowsTheUmaskAndKeepsThePermissionsOfWhatItReplaces) {
    const auto folder = test::scratch_dir();
    const auto before = ::umask(027);
    write_file_atomically(folder / "new", "x");
    ::umask(077);
    write_file_atomically(folder / "secret", "x");
    using std::filesystem::perms;
    std::filesystem::permissions(folder / "new", perms{0664});
    write_file_atomically(folder / "new", "y");
    ::umask(before);
    EXPECT_EQ(permissions(folder / "secret"), perms{0600});
    EXPECT_EQ(permissions(folder / "new"), perms{0664});
    write_file_atomically(folder / "secret", "y");
    EXPECT_EQ(permissions(folder / "secret"), perms{0600});
}

TEST(AtomicFile, TakesNamesAsLongAsTheyCanBe) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / std::string(255, 'x'), "x");
    EXPECT_EQ(read_file(folder / std::string(255, 'x')), "x");
}

TEST(AtomicFile, WritesSeveralFilesOrNone) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "a.txt", "old");
    std::filesystem::create_directory(folder / "c.txt");
    EXPECT_THROW(write_files_atomically({{folder / "a.txt", "new"}, {folder / "b.txt", "b"}, {folder / "c.txt", "c"}}),
                 OutputError);
    EXPECT_EQ(read_file(folder / "a.txt"), "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2);
    write_files_atomically({{folder / "a.txt", "new"}, {folder / "b.txt", "b"}});
    EXPECT_EQ(read_file(folder / "a.txt") + read_file(folder / "b.txt"), "newb");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 3);
}

TEST(AtomicFile, LeavesUnfinishedFilesWhereItIsTold) {
    const auto folder = test::scratch_dir();
    std::filesystem::create_directories(folder / "unfinished");
    write_file_atomically(folder / "a", "x", folder / "unfinished");
    write_file_atomically(folder / "b", "x", folder / "not there");
    EXPECT_EQ(read_file(folder / "a") + read_file(folder / "b"), "xx");
    EXPECT_TRUE(std::filesystem::is_empty(folder / "unfinished"));
}

TEST(AtomicFile, IsLinkedOrCopied) {
    const auto folder = test::scratch_dir();
    const auto unfinished = folder / "unfinished";
    std::filesystem::create_directories(unfinished);
    write_file_atomically(folder / "source", "x");
    write_file_atomically(folder / "result", "before");
    for (int again = 0; again < 2; ++again) {
        link_or_copy_file(folder / "source", folder / "result", unfinished);
        EXPECT_TRUE(std::filesystem::equivalent(folder / "source", folder / "result"));
        EXPECT_TRUE(std::filesystem::is_empty(unfinished));
    }
    write_file_atomically(folder / "result", "y");  // replaces the name alone
    EXPECT_EQ(read_file(folder / "source"), "x");
    link_or_copy_file(folder / "source", folder / "other", folder / "no folder to make links in");
    EXPECT_FALSE(std::filesystem::equivalent(folder / "source", folder / "other"));
    EXPECT_EQ(read_file(folder / "other"), "x");
}

}  // namespace
}  // namespace flightwatt
