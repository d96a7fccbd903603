// The logs that the build makes of each difficulty (tests/CMakeLists.txt) against the phases that were flown
// (NAME.truth.csv).

#include "base/csv.h"
#include "flight/load_flight.h"
#include "flight/segment.h"
#include "helpers/test_paths.h"
#include "synthetic/synthetic_flight.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::synthetic {
namespace {

struct FoundPhase {
    std::size_t sortie;
    flight::PhaseSpan span;
};

std::vector<FoundPhase> found_phases(const flight::FlightPhases& phases) {
    std::vector<FoundPhase> found;
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        for (const auto& span : phases.sorties[s].phases) found.push_back({s + 1, span});
    }
    return found;
}

void expect_as_flown(const std::filesystem::path& data, const CsvTable& truth) {
    const auto phases = segment(select_tracks(flight::read_flight(data)));
    const auto found = found_phases(phases);
    ASSERT_EQ(found.size(), truth.rows.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto& row = truth.rows[i];
        const auto& [sortie, span] = found[i];
        const auto text = [&](const char* column) { return row.cells[column_index(truth, column)].text; };
        const auto number = [&](const char* column) { return cell_number(truth, row, column_index(truth, column)); };
        EXPECT_EQ(static_cast<double>(sortie), number("sortie"));
        EXPECT_EQ(to_string(span.phase), text("phase"));
        EXPECT_NEAR(span.start.time_s, number("start_s"), 3.0) << text("phase");
        EXPECT_NEAR(span.end.time_s, number("end_s"), 3.0) << text("phase");
        EXPECT_EQ(span.complete, text("complete") == "true") << text("phase");
    }
    // Every flight's motor is tried beforehand, so a log that begins on the ground shows a run-up a sortie.
    const bool from_the_ground = truth.rows.front().cells[column_index(truth, "phase")].text == "takeoff";
    EXPECT_EQ(phases.ground_events.size(), from_the_ground ? phases.sorties.size() : 0U);
}

TEST(HazardLogs, AreSegmentedAsTheyWereFlown) {
    std::set<std::string> expected;
    for (const auto& hazard : anomaly_names()) expected.insert("hazard_01_" + hazard);
    std::set<std::string> seen;
    for (const auto& entry : std::filesystem::directory_iterator(test::hazards_dir())) {
        if (entry.path().extension() != ".data") continue;
        SCOPED_TRACE(entry.path().filename().string());
        auto truth = entry.path();
        expect_as_flown(entry.path(), read_csv(truth.replace_extension(".truth.csv")));
        seen.insert(entry.path().stem().string());
    }
    EXPECT_EQ(seen, expected) << "a log a hazard";
}

}  // namespace
}  // namespace flightwatt::synthetic
