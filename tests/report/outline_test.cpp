#include "report/outline.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

std::vector<Outline> outlines_of(const std::string& text) {
    const auto file = test::scratch_dir() / "outline.geojson";
    write_file_atomically(file, text);
    return read_outlines(file);
}

TEST(ReadOutlines, TakesEveryLineAndRing) {
    const auto outlines = outlines_of(R"({"type": "FeatureCollection", "bbox": [1, 2, 3, 4], "features": [
        {"type": "Feature", "properties": {"name": "field"}, "geometry": {"type": "Polygon", "coordinates":
            [[[10, 55], [10.1, 55], [10.1, 55.1], [10, 55]], [[10.01, 55.01, 7], [10.02, 55.01, 7], [10.02, 55.02, 7]]]}},
        {"type": "Feature", "geometry": {"type": "Point", "coordinates": [9, 54]}},
        {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[9, 54], [9.5, 54.5]]}}]})");
    ASSERT_EQ(outlines.size(), 3U);
    EXPECT_EQ(outlines[0].size(), 4U);
    EXPECT_EQ(outlines[2], (Outline{{9.0, 54.0}, {9.5, 54.5}}));
}

TEST(ReadOutlines, RejectsWhatHoldsNone) {
    EXPECT_THAT(test::rejected([] { outlines_of("{"); }), testing::HasSubstr("is not JSON"));
    EXPECT_THAT(test::rejected([] { outlines_of(R"({"type": "Point", "coordinates": [1, 2]})"); }),
                testing::HasSubstr("has no line and no polygon"));
}

}  // namespace
}  // namespace flightwatt::report
