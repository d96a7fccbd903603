// The version of the program, and the commit that it was built of.

#include "base/atomic_file.h"
#include "cli/stage.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

TEST(VersionText, IsTheVersionAloneWhereNoCommitIsKnown) { EXPECT_EQ(version_text(), FLIGHTWATT_VERSION); }

/// The source that the build makes of the commit of a tree.
std::string commit_source(const std::filesystem::path& tree) {
    const auto run = test::run_shell("cmake -D SOURCE=" + test::shell_quoted(tree) + " -D OUTPUT=commit.cpp -P " +
                                         test::shell_quoted(test::source_dir() / "cmake/commit.cmake"),
                                     tree);
    EXPECT_EQ(run.code, 0) << run.err;
    return read_file(tree / "commit.cpp");
}

TEST(CommitSource, HasTheCommitOfARepositoryOfItsOwnAlone) {
    const auto folder = test::scratch_dir();
    const auto git = [&](const std::string& arguments) {
        const auto run = test::run_shell("git -c user.name=a -c user.email=a@example.org " + arguments, folder);
        EXPECT_EQ(run.code, 0) << arguments << ": " << run.err;
        return run.out.substr(0, run.out.find('\n'));
    };
    git("init --quiet outer");
    std::filesystem::create_directory(folder / "outer/unpacked");
    const auto unknown = HasSubstr("commit() { return \"\"; }");
    EXPECT_THAT(commit_source(folder / "outer"), unknown) << "nothing is committed yet";
    git("-C outer commit --quiet --allow-empty --message first");
    const auto known = HasSubstr("commit() { return \"" + git("-C outer rev-parse --short HEAD") + "\"; }");
    EXPECT_THAT(commit_source(folder / "outer"), known);
    EXPECT_THAT(commit_source(folder / "outer/unpacked"), unknown) << "it only is in a repository";
    git("-C outer worktree add --quiet ../worktree");  // .git is a file there
    EXPECT_THAT(commit_source(folder / "worktree"), known);
}

}  // namespace
}  // namespace flightwatt::cli
