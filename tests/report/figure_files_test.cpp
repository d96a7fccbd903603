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

TEST(WriteFigures, SetTypeAtEightPointsForAColumn) {
    const NoPrograms none;
    WebFiles web;
    web.theme =
        R"({"light": {"title": {"fontSize": 13}, "axis": {"labelFontSize": 11, "labelLimit": 90}}, "dark": {}})";
    const auto folder = test::scratch_dir() / "figures";
    write_figures({section_with("one")}, web, folder, parse_figure_width_pt("3.5in"));
    const auto config = VegaJson::parse(read_file(folder / "one.vl.json"))["config"];
    EXPECT_NEAR(config["title"]["fontSize"].get<double>(), 32.0 / 3.0, 1e-9);
    EXPECT_NEAR(config["axis"]["labelFontSize"].get<double>(), 32.0 / 3.0, 1e-9);
    EXPECT_EQ(config["axis"]["labelLimit"], 90);
}

TEST(FigureWidth, IsReadWithItsUnit) {
    EXPECT_DOUBLE_EQ(parse_figure_width_pt("3.5in"), 252.0);
    EXPECT_DOUBLE_EQ(parse_figure_width_pt("252pt"), 252.0);
    EXPECT_NEAR(parse_figure_width_pt("88.9mm"), 252.0, 1e-9);
    EXPECT_NEAR(parse_figure_width_pt("8.89cm"), 252.0, 1e-9);
    for (const auto* wrong : {"", "3.5", "in", "3.5 in", "-3in", "1in", "30in", "3.5inch", "3..5in"})
        EXPECT_THROW(parse_figure_width_pt(wrong), UsageError) << wrong;
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
