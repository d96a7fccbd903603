#include "report/figure_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

/// Neither node nor rsvg-convert is found while it lives.
class NoPrograms {
  public:
    NoPrograms() : before_(std::getenv("PATH")) { ::setenv("PATH", test::scratch_dir().c_str(), 1); }
    ~NoPrograms() { ::setenv("PATH", before_.c_str(), 1); }
    NoPrograms(const NoPrograms&) = delete;
    NoPrograms& operator=(const NoPrograms&) = delete;

  private:
    std::string before_;
};

TEST(WriteFigures, WritesNoneWithoutNode) {
    const NoPrograms none;
    const auto folder = test::scratch_dir() / "figures";
    EXPECT_TRUE(write_figures(Json::object(), test::source_dir() / "web", folder).names.empty());
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(WriteFigures, FailsWhereTheFolderIsAFile) {
    const auto file = test::scratch_dir() / "file";
    write_file_atomically(file, "");
    EXPECT_THROW(write_figures(Json::object(), test::source_dir() / "web", file), OutputError);
}

TEST(FigureTools, NeedTheLibraries) {
    EXPECT_THAT(
        test::rejected([&] { figure_tools(test::scratch_dir()); }),
        testing::AllOf(testing::HasSubstr("vega.min.js"), testing::HasSubstr("run scripts/install_dependencies")));
}

TEST(FigureWidth, IsReadWithItsUnit) {
    EXPECT_DOUBLE_EQ(parse_figure_length_pt("figure-width", "3.5in"), 252.0);
    EXPECT_DOUBLE_EQ(parse_figure_length_pt("figure-width", "252pt"), 252.0);
    EXPECT_NEAR(parse_figure_length_pt("figure-width", "88.9mm"), 252.0, 1e-9);
    EXPECT_NEAR(parse_figure_length_pt("figure-width", "8.89cm"), 252.0, 1e-9);
    for (const auto* wrong : {"", "3.5", "in", "3.5 in", "-3in", "1in", "30in", "3.5inch", "3..5in"})
        EXPECT_THROW(parse_figure_length_pt("figure-width", wrong), UsageError) << wrong;
}

}  // namespace
}  // namespace flightwatt::report
