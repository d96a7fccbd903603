#include "exchange/log_slices.h"

#include "base/atomic_file.h"
#include "flight/phase_statistics.h"
#include "helpers/binary_frames.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::exchange {
namespace {

using testing::HasSubstr;

/// Writes each sortie of a log as its own log into `folder`, and reads it again.
std::vector<flight::LoadedFlight> cut_sorties(const std::filesystem::path& log, const std::filesystem::path& folder) {
    const flight::FlightFile file(log);
    const auto whole = flight::load_flight(file, {});
    const auto text = text_of_log(file);
    std::vector<flight::LoadedFlight> cut;
    for (const auto& piece : sortie_slices(whole.series, whole.phases)) {
        const auto name = folder / (log.stem().string() + "_" + piece.name);
        write_file_atomically(name.string() + ".log", file.log_text().value());
        write_file_atomically(name.string() + ".data", lines_in_slice(text, piece));
        cut.push_back(flight::load_flight(name.string() + ".data"));
    }
    return cut;
}

/// Edges to `edge_s`, the energy of each phase to `part` of it; and what the flight is called stays.
void expect_same_sorties(const std::filesystem::path& log, double edge_s, double part) {
    SCOPED_TRACE(log.filename().string());
    const auto whole = flight::load_flight(log);
    const auto cut = cut_sorties(log, test::scratch_dir());
    ASSERT_EQ(cut.size(), whole.phases.sorties.size());
    for (std::size_t i = 0; i < cut.size(); ++i) {
        const auto& expected = whole.phases.sorties[i];
        ASSERT_EQ(cut[i].phases.sorties.size(), 1u);
        const auto& sortie = cut[i].phases.sorties[0];
        EXPECT_EQ(cut[i].series.aircraft_name, whole.series.aircraft_name);
        ASSERT_EQ(sortie.phases.size(), expected.phases.size());
        for (std::size_t p = 0; p < expected.phases.size(); ++p) {
            const auto& a = expected.phases[p];
            const auto& b = sortie.phases[p];
            EXPECT_EQ(b.phase, a.phase);
            EXPECT_EQ(b.complete, a.complete);
            EXPECT_NEAR(b.start.time_s, a.start.time_s, edge_s);
            EXPECT_NEAR(b.end.time_s, a.end.time_s, edge_s);
            const auto energy_wh = integrated_energy_wh(whole.series, a.start.time_s, a.end.time_s);
            EXPECT_NEAR(integrated_energy_wh(cut[i].series, b.start.time_s, b.end.time_s), energy_wh, part * energy_wh);
        }
    }
}

constexpr double edge_s = 0.05;
constexpr double part = 0.002;

TEST(LogSlices, GivesTheSortiesOfTheSampleLogs) {
    for (int i = 1; i <= 6; ++i) {
        const auto name = "opterra_synthetic_0" + std::to_string(i) + ".data";
        expect_same_sorties(test::source_dir() / "logs" / name, edge_s, part);
    }
}

TEST(LogSlices, GivesEachSortieOfALogOfTwoAndThoseThatTheLogCutsItself) {
    const auto hazards = test::source_dir() / "tests" / "data" / "hazards";
    for (const auto* name : {"two-sorties", "begins-in-the-air", "ends-in-the-air", "landing-in-steps"}) {
        expect_same_sorties(hazards / ("hazard_01_" + std::string(name) + ".data"), edge_s, part);
    }
}

TEST(LogSlices, GivesTheSortiesOfRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        expect_same_sorties(test::shared_dir() / "flights" / (std::string(name) + ".data"), edge_s, part);
    }
}

TEST(LogSlices, LeavesTheGroundHalfWayToTheNextSortie) {
    const auto whole = flight::load_flight(test::source_dir() / "tests/data/hazards/hazard_01_two-sorties.data");
    const auto& sorties = whole.phases.sorties;
    const auto pieces = sortie_slices(whole.series, whole.phases);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[0].name, "sortie1");
    EXPECT_EQ(pieces[1].name, "sortie2");
    EXPECT_NEAR(pieces[0].time.end_s, sorties[0].end_s() + ground_margin_s, 1.0);
    EXPECT_LE(pieces[0].time.end_s, pieces[1].time.start_s);
    EXPECT_GE(pieces[1].time.start_s, sorties[1].start_s() - ground_margin_s);
    EXPECT_LE(pieces[1].time.start_s, sorties[1].start_s() - 0.5 * ground_margin_s);
}

TEST(LogSlices, NamesEachPhaseAndTakesItFromEdgeToEdge) {
    const auto whole = flight::load_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    const auto& phases = whole.phases.sorties.at(0).phases;
    const auto pieces = phase_slices(whole.phases);
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_EQ(pieces[1].name, "sortie1_cruise");
    EXPECT_EQ(pieces[1].time.start_s, phases[1].start.time_s);
    EXPECT_EQ(pieces[1].time.end_s, phases[1].end.time_s);
}

TEST(LogSlices, TakesLinesAsTheyStand) {
    const std::string text = "1.0 7 A  1\n2.0 7 B 2 \r\nbroken line\n3.0 7 C 3\n4.0 7 D 4";
    EXPECT_EQ(lines_in_slice(text, {"x", 2.0, 3.0}), "2.0 7 B 2 \r\nbroken line\n3.0 7 C 3\n");
    EXPECT_EQ(lines_in_slice(text, {"x", 3.5, 9.0}), "4.0 7 D 4");
    EXPECT_EQ(lines_in_slice(text, {"x", 1.0, 4.0}), text);
    EXPECT_EQ(lines_in_slice(text, {"x", 5.0, 9.0}), "");
    EXPECT_EQ(lines_in_slice("", {"x", 0.0, 9.0}), "");
}

TEST(LogSlices, KeepsTheLineThatSaysSynthetic) {
    const std::string first = "0.1 7 INFO_MSG \"SYNTHETIC: made\"\n";
    EXPECT_EQ(lines_in_slice(first + "5.0 7 A 1\n6.0 7 A 2\n", {"x", 6.0, 7.0}), first + "6.0 7 A 2\n");
}

TEST(LogSlices, TakesABinaryLogAsTheTextThatConvertMakes) {
    const auto folder = test::scratch_dir();
    const auto sample = test::source_dir() / "logs/opterra_synthetic_01.data";
    const auto definitions = test::source_dir() / "logs/opterra_synthetic_01.log";
    write_file_atomically(
        folder / "card.LOG",
        test::card_log(read_file(sample), telemetry::read_message_dictionary(definitions), test::LinkVersion::v2));
    write_file_atomically(folder / "card.log", read_file(definitions));
    const auto text = text_of_log(flight::FlightFile(folder / "card.LOG"));
    EXPECT_THAT(text, HasSubstr(" ENERGY "));
    const auto cruise = phase_slices(flight::load_flight(folder / "card.LOG").phases).at(1);
    const auto lines = lines_in_slice(text, cruise);
    EXPECT_THAT(text, HasSubstr(lines));
    EXPECT_GT(lines.size(), 1000u);
    EXPECT_NEAR(std::stod(lines), cruise.time.start_s, 1.0);
}

TEST(LogSlices, RefusesASeries) {
    const auto file = test::scratch_dir() / "s.csv";
    write_file_atomically(file, "time_s,power_w\n0,1\n1,2\n");
    try {
        text_of_log(flight::FlightFile(file));
        FAIL() << "a series has no lines of telemetry";
    } catch (const InputError& error) {
        EXPECT_THAT(error.hint(), HasSubstr("give the log that it was made from"));
    }
}

}  // namespace
}  // namespace flightwatt::exchange
