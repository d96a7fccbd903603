// Figures as files. That they are rendered is figures_test.sh's.

#include "report/figure_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/test_paths.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

Section section_with(const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.spec = {{"mark", "line"}};
    return {"s", "S", "", {figure}};
}

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

TEST(WriteFigures, WritesSpecificationsWithTheLightThemeWithoutNode) {
    const NoPrograms none;
    WebFiles web;
    web.theme = R"({"light": {"background": "white"}, "dark": {}})";
    const auto folder = test::scratch_dir() / "figures";
    const auto files = write_figures({section_with("one"), section_with("two")}, web, folder);
    EXPECT_EQ(files.figures, 2U);
    EXPECT_FALSE(files.has_svg);
    EXPECT_FALSE(files.has_pdf);
    const auto spec = VegaJson::parse(read_file(folder / "two.vl.json"));
    EXPECT_EQ(spec["mark"], "line");
    EXPECT_EQ(spec["config"]["background"], "white");
}

TEST(WriteFigures, FailsWhereTheFolderIsAFile) {
    WebFiles web;
    web.theme = R"({"light": {}, "dark": {}})";
    const auto file = test::scratch_dir() / "file";
    write_file_atomically(file, "");
    EXPECT_THROW(write_figures({section_with("one")}, web, file), OutputError);
}

}  // namespace
}  // namespace flightwatt::report
