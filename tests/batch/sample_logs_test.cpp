// The project's claim, from end to end: the sample logs give the paper's Table I back, however they are
// kept.

#include "helpers/sample_logs.h"

#include "base/units.h"
#include "flight/load_flight.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

namespace io = boost::iostreams;

mechanical::MechanicalModel fit_of(const BatchFlights& flights, const std::filesystem::path& out) {
    std::vector<mechanical::FlightSamples> samples;
    for (auto& measured : test::samples_of(flights, out)) samples.push_back(std::move(measured.samples));
    return fit_model(samples).model;
}

void expect_weights_that_sum_to_one(const mechanical::MechanicalModel& model) {
    for (const auto phase : flight::all_phases) {
        double sum = 0.0;
        for (const auto& flight : model.flights) {
            if (!flight.phases[phase]) continue;
            EXPECT_GE(flight.phases[phase]->weight, 0.0);
            EXPECT_LE(flight.phases[phase]->weight, 1.0);
            sum += flight.phases[phase]->weight;
        }
        EXPECT_NEAR(sum, 1.0, 1e-12) << to_string(phase);
    }
}

TEST(SampleLogs, GiveTableOneBack) {
    const auto published =
        mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
    const auto out = test::scratch_dir() / "out";
    const auto flights = test::batch(test::source_dir() / "logs", out);
    ASSERT_EQ(flights.size(), 6U);
    const auto model = fit_of(flights, out);
    const flight::PerPhase<double> largest_rms_w{{0.10, 0.10, 0.30}};
    for (const auto phase : flight::all_phases) {
        const auto& is = model.phases[phase];
        const auto& should = published.phases[phase];
        EXPECT_LE(rms_difference_w(is, should), largest_rms_w[phase]) << to_string(phase);
        EXPECT_NEAR(is.fourier.a0_w / should.fourier.a0_w, 1.0, 0.01) << to_string(phase);
        EXPECT_NEAR(is.duration_s / should.duration_s, 1.0, 0.05) << to_string(phase);
        EXPECT_EQ(is.flights, 6U);
    }
    expect_weights_that_sum_to_one(model);
}

TEST(RealLogs, GiveTheSameModelRememberedAsAnew) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::scratch_dir();
    const auto flights = test::shared_dir() / "flights";
    const auto again = to_toml(fit_of(test::batch(flights, folder), folder));
    EXPECT_THAT(again, testing::HasSubstr("flights = 3"));
    EXPECT_EQ(to_toml(fit_of(test::batch(flights, folder), folder)), again);
}

TEST(SampleLogs, GiveTheSameModelWithAnyNumberOfJobs) {
    const auto folder = test::scratch_dir();
    const auto logs = test::source_dir() / "logs";
    const auto model = to_toml(fit_of(test::batch(logs, folder / "1", 1), folder / "1"));
    EXPECT_EQ(to_toml(fit_of(test::batch(logs, folder / "5", 5), folder / "5")), model);
    EXPECT_EQ(to_toml(fit_of(test::batch(logs, folder / "1", 5), folder / "1")), model);  // remembered
}

template <typename Compressor>
void write_compressed(const Compressor& compressor, const std::filesystem::path& from,
                      const std::filesystem::path& to) {
    const auto text = read_file(from);
    std::string compressed;
    io::filtering_ostream stream;
    stream.push(compressor);
    stream.push(io::back_inserter(compressed));
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.reset();
    ASSERT_LT(compressed.size(), text.size() / 2);
    write_file_atomically(to, compressed);
}

TEST(SampleLogs, AreTheSameCompressed) {
    const auto folder = test::scratch_dir();
    std::filesystem::copy_file(test::sample(3, ".log"), folder / "opterra_synthetic_03.log");
    const auto data = folder / "opterra_synthetic_03.data";
    write_compressed(io::gzip_compressor(), test::sample(3), data.string() + ".gz");
    write_compressed(io::bzip2_compressor(), test::sample(3), data.string() + ".bz2");
    write_compressed(io::lzma_compressor(), test::sample(3), data.string() + ".xz");
    write_compressed(io::zstd_compressor(), test::sample(3), data.string() + ".zst");
    const auto plain = flight::read_flight(test::sample(3));
    for (const auto* ending : {".gz", ".bz2", ".xz", ".zst"}) {
        const auto series = flight::read_flight(data.string() + ending);
        EXPECT_EQ(series.flight, "opterra_synthetic_03");
        EXPECT_EQ(warnings_of(series), warnings_of(plain));
        EXPECT_EQ(to_csv(series), to_csv(plain)) << ending;
        EXPECT_EQ(flight::phases_csv(select_tracks(series), flight::segment(select_tracks(series))),
                  phases_csv(select_tracks(plain), segment(select_tracks(plain))))
            << ending;
    }
}

TEST(SampleLogs, OfSeveralAircraftAskWhich) {
    const auto folder = test::scratch_dir();
    auto text = read_file(test::copy_sample(1, folder));
    const auto second = read_file(test::sample(2));
    for (std::size_t at = 0; at < second.size();) {
        const auto end = second.find('\n', at);
        auto line = second.substr(at, end - at);
        at = end == std::string::npos ? second.size() : end + 1;
        if (const auto id = line.find(" 7 "); id != std::string::npos) line.replace(id, 3, " 8 ");
        text += line + "\n";
    }
    const auto both = test::write_text(folder / "opterra_synthetic_01.data", text);
    EXPECT_EQ(test::rejected([&] { flight::read_flight(both); }, folder),
              "opterra_synthetic_01.data: several aircraft flew: 7, 8; select one with --aircraft ID");
    const auto seventh = flight::read_flight(both, "7");
    const auto alone = flight::read_flight(test::sample(1));
    EXPECT_EQ(phases_csv(select_tracks(seventh), segment(select_tracks(seventh))),
              phases_csv(select_tracks(alone), segment(select_tracks(alone))));
    EXPECT_EQ(flight::power_track(flight::read_flight(both, "8")).value,
              flight::power_track(flight::read_flight(test::sample(2))).value);
}

/// Where lift-off and touchdown are, read off plots (shared/formats.md, tolerance 5 s), and cruise power.
struct KnownFlight {
    const char* name;
    double lift_off_s;
    double touchdown_s;
    double cruise_w;
};

TEST(RealFlights, GoThroughTheWholeBatch) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto out = test::scratch_dir() / "out";
    const auto flights = test::batch(test::shared_dir() / "flights", out);
    const std::vector<KnownFlight> known{{"20_07_03__12_17_45", 147, 1586, 29.9},
                                         {"20_07_05__10_26_44", 210, 1937, 18.9},
                                         {"20_07_10__06_53_03", 321, 1100, 22.0}};
    std::size_t found = 0;
    for (const auto& flight : flights) {
        // The other two measured no current, and one of them does not move.
        const bool measured = flight.record.flight.starts_with("20_07_");
        EXPECT_EQ(flight.record.accepted, measured || flight.record.flight.starts_with("17_07_"));
        EXPECT_EQ(flight.record.accepted && flight.record.no_power_reason.empty(), measured) << flight.record.flight;
        for (const auto& [name, lift_off_s, touchdown_s, cruise_w] : known) {
            if (flight.record.flight != name) continue;
            ++found;
            ASSERT_EQ(flight.record.phases.size(), 3U);
            EXPECT_NEAR(flight.record.phases[0].start_s, lift_off_s, 5.0) << name;
            EXPECT_NEAR(flight.record.phases[2].end_s, touchdown_s, 5.0) << name;
            EXPECT_NEAR(flight.record.phases[1].statistics.mean_power_w, cruise_w, 0.3) << name;
        }
    }
    EXPECT_EQ(found, known.size());
}

TEST(RealFlights, WithoutPowerAreListedAndNotFitted) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto flights = test::batch(test::shared_dir() / "archives" / "no-power", test::scratch_dir() / "out");
    EXPECT_EQ(flights.size(), 4U);
    for (const auto& flight : flights) {
        EXPECT_TRUE(flight.record.accepted) << flight.record.error;
        EXPECT_FALSE(flight.record.phases.empty());
        EXPECT_TRUE(flight.selection.flights.empty());
        ASSERT_EQ(flight.selection.exclusions.size(), 1U);
        EXPECT_EQ(flight.selection.exclusions[0].reason, flight.record.no_power_reason);
    }
}

TEST(RealFlights, AreNotWhatRoversDo) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto flights = test::batch(test::shared_dir() / "archives" / "rovers", test::scratch_dir() / "out");
    EXPECT_EQ(flights.size(), 4U);
    for (const auto& flight : flights) EXPECT_FALSE(flight.record.accepted) << flight.record.flight;
}

double weight_of(const mechanical::MechanicalModel& model, const std::string& flight, flight::Phase phase) {
    for (const auto& part : model.flights) {
        if (part.flight == flight) return part.phases[phase].value().weight;
    }
    throw std::runtime_error("the model has no flight " + flight);
}

TEST(RealFlights, ConvergeToAModel) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto out = test::scratch_dir() / "out";
    const auto flights = test::batch(test::shared_dir() / "flights", out);
    const auto model = fit_of(flights, out);
    ASSERT_EQ(model.flights.size(), 3U);
    expect_weights_that_sum_to_one(model);
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        EXPECT_EQ(fitted.flights, 3U) << to_string(phase);
        // The weighted average of the flights' measured energy is what the model's curve needs.
        double measured_w = 0.0;
        for (const auto& flight : flights) {
            if (!flight.record.no_power_reason.empty()) continue;
            for (const auto& recorded : flight.record.phases) {
                if (recorded.phase != phase) continue;
                measured_w += weight_of(model, flight.record.flight, phase) *
                              units::joule_from_wh(recorded.statistics.energy_wh) / (recorded.end_s - recorded.start_s);
            }
        }
        const double fitted_w = energy_j(fitted.fourier, fitted.duration_s) / fitted.duration_s;
        // A landing that is held above 0 W is not least squares.
        EXPECT_NEAR(fitted_w, measured_w, 0.05 * measured_w + (fitted.not_negative ? 0.5 : 0.2)) << to_string(phase);
    }
    // It is written as a model that can be read again.
    const auto file = test::scratch_dir() / "model.toml";
    write_file_atomically(file, to_toml(model));
    EXPECT_EQ(to_toml(mechanical::read_mechanical_model(file)), to_toml(model));
}

}  // namespace
}  // namespace flightwatt::batch
