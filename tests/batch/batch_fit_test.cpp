#include "batch/batch_fit.h"

#include "base/atomic_file.h"
#include "batch/batch_files.h"
#include "batch/manifest.h"
#include "helpers/generated_flights.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::HasSubstr;

BatchFit some_fit() {
    std::vector<mechanical::FlightSamples> samples;
    for (auto& flight : test::generated(3, 5)) samples.push_back(std::move(flight.samples));
    mechanical::ModelFitOptions options;
    options.name = "three";
    options.phases.order = 2;
    options.weighting = mechanical::Weighting::uniform;
    auto fit = fit_flights(samples, options);
    fit.excluded = {"other"};
    fit.keep = {"uncertain"};
    fit.model.validation = mechanical::ModelValidation{"fourier", {{"fourier", 3, 2.5}}};
    return fit;
}

TEST(BatchFit, IsReadBackAsItWasWritten) {
    const auto out = test::scratch_dir();
    const auto fit = some_fit();
    write_batch_fit(fit, out);
    const auto read = read_batch_fit(out).value();
    EXPECT_EQ(to_toml(read.model), to_toml(fit.model));
    EXPECT_TRUE(read.model.phases[flight::Phase::cruise].errors);
    EXPECT_EQ(read.options.phases.order, 2);
    EXPECT_EQ(read.options.weighting, mechanical::Weighting::uniform);
    EXPECT_EQ(read.excluded, fit.excluded);
    EXPECT_EQ(read.keep, fit.keep);
    for (const auto phase : flight::all_phases) {
        EXPECT_EQ(read.bands[phase].time_s.size(), 101u);
        EXPECT_EQ(read.bands[phase].low_95_w, fit.bands[phase].low_95_w);
        EXPECT_EQ(read.bands[phase].flights_high_w, fit.bands[phase].flights_high_w);
    }
    // model.toml is the model alone.
    const auto plain = mechanical::read_mechanical_model(out / model_name);
    EXPECT_FALSE(plain.phases[flight::Phase::cruise].errors);
    EXPECT_TRUE(plain.validation && plain.validation->default_model == "fourier");
}

TEST(BatchFit, IsUnchangedWithItsKeyAndAllOfItsFiles) {
    const auto out = test::scratch_dir();
    EXPECT_FALSE(unchanged_batch_fit(out, "its key"));
    auto fit = some_fit();
    fit.key = "its key";
    write_batch_fit(fit, out);
    EXPECT_FALSE(unchanged_batch_fit(out, "another"));
    const auto read = unchanged_batch_fit(out, fit.key).value();
    std::filesystem::create_directories(out / "again");
    write_batch_fit(read, out / "again");
    for (const auto* name : {model_name, model_errors_name, fit_name}) {
        const auto text = read_file(out / name);
        EXPECT_EQ(read_file(out / "again" / name), text);
        auto changed = text;
        changed[changed.find_last_of("0123456789")] ^= 1;  // another digit
        for (const auto& damaged : {changed, text.substr(0, text.size() / 2), std::string()}) {
            write_file_atomically(out / name, damaged);
            EXPECT_FALSE(unchanged_batch_fit(out, fit.key)) << name;
        }
        std::filesystem::remove(out / name);
        EXPECT_FALSE(unchanged_batch_fit(out, fit.key)) << name;
        write_file_atomically(out / name, text);
        EXPECT_TRUE(unchanged_batch_fit(out, fit.key)) << name;
    }
}

TEST(BatchFit, HasAnotherKeyWithOtherOptionsNamesOrFlights) {
    const auto fit = some_fit();
    BatchFlights flights(2);
    flights[0].record.flight = "a";
    flights[0].selection.flights = {{"a", {{true, true, false}}}};
    const auto key = fit_key(flights, fit);
    EXPECT_EQ(fit_key(flights, fit), key);
    const auto differs = [&](const std::function<void(BatchFit&, BatchFlights&)>& change) {
        auto other_fit = fit;
        auto others = flights;
        change(other_fit, others);
        return fit_key(others, other_fit) != key;
    };
    EXPECT_TRUE(differs([](auto& of, auto&) { of.options.phases.order = 3; }));
    EXPECT_TRUE(differs([](auto& of, auto&) { of.options.weighting = mechanical::Weighting::agreement; }));
    EXPECT_TRUE(differs([](auto& of, auto&) { of.options.name = "four"; }));
    EXPECT_TRUE(differs([](auto& of, auto&) { of.keep.clear(); }));
    EXPECT_TRUE(differs([](auto& of, auto&) { of.copies = {{"b", "a"}}; }));
    EXPECT_TRUE(differs([](auto&, auto& of) { of[0].record.fingerprint = "changed"; }));
    EXPECT_TRUE(differs([](auto&, auto& of) { of[0].record.results = "changed"; }));
    EXPECT_TRUE(differs([](auto&, auto& of) { of[0].selection.flights[0].phases.values[1] = false; }));
    EXPECT_TRUE(differs([](auto&, auto& of) { of[1].selection.flights = {{"b", {}}}; }));
    EXPECT_FALSE(differs([](auto&, auto& of) { of[1].record.fingerprint = "not used"; }));
}

TEST(BatchFit, IsNoneWithoutAModelAndRefusesWhatIsDamaged) {
    const auto out = test::scratch_dir();
    EXPECT_FALSE(read_batch_fit(out));
    write_batch_fit(some_fit(), out);
    const auto refusal = [&] { return test::rejected([&] { read_batch_fit(out); }); };
    auto text = read_file(out / fit_name);
    const std::string format = "\"format\": 1";
    ASSERT_NE(text.find(format), std::string::npos);
    write_file_atomically(out / fit_name, text.replace(text.find(format), format.size(), "\"format\": 2"));
    EXPECT_THAT(refusal(), HasSubstr("its format is newer"));
    write_file_atomically(out / fit_name, "{}");
    EXPECT_THAT(refusal(), HasSubstr("run flightwatt batch again"));
    std::filesystem::remove(out / fit_name);
    EXPECT_THAT(refusal(), HasSubstr("fit.json: does not exist"));
}

}  // namespace
}  // namespace flightwatt::batch
