// Numbers in the sentences of documents are those of the source: an output shows what a program prints, a sentence
// has nothing that would change with it.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::test {
namespace {

/// A sentence, and where the source defines its number.
struct Statement {
    const char* document;
    const char* sentence;
    const char* source;
    const char* definition;
};

const std::vector<Statement> statements{
    {"guide.md", "of more than 40, in groups", "mechanical/validation.h", "max_validation_folds = 40;"},
    {"guide.md", "from five flights on", "batch/trend.h", "min_trend_flights = 5;"},
    {"guide.md", "three days:", "batch/trend.h", "min_trend_days = 3;"},
    {"guide.md", "`retire`: resistance (series and RC pair) doubled", "answer/pack_ledger.h",
     "retire_rise_percent = 100.0;"},
    {"guide.md", "or capacity below 80 %", "answer/pack_ledger.h", "retire_capacity_percent = 80.0;"},
    {"guide.md", "`watch`: resistance 30 % more", "answer/pack_ledger.h", "watch_rise_percent = 30.0;"},
    {"guide.md", "or capacity below 90 %", "answer/pack_ledger.h", "watch_capacity_percent = 90.0;"},
    {"guide.md", "within 8 K", "answer/pack_ledger.h", "like_temperature_k = 8.0;"},
    {"guide.md", "(35 points)", "answer/pack_ledger.h", "like_charge_percent = 35.0;"},
    {"guide.md", "its first 4 characters or more", "flight/flight_file.h", "min_id_beginning = 4;"},
    {"guide.md", "cruise power (by a factor of 3,", "batch/aircraft.cpp", "max_power_ratio = 3.0;"},
    {"guide.md", "`NAME@2`, up to 64", "telemetry/recordings.h", "max_recordings = 64;"},
    {"guide.md", "unpacked log above 100 MB", "telemetry/data_file.h", "default_max_log_bytes = 100'000'000;"},
    {"guide.md", "table above 1 GB", "flight/series_file.h", "max_series_bytes = 1'000'000'000;"},
    {"guide.md", "`.log` above 16 MB", "telemetry/log_configuration.h", "max_log_configuration_bytes = 16'000'000;"},
    {"guide.md", "other files above 128 MB", "base/input_file.h", "max_file_bytes = 128'000'000;"},
    {"guide.md", "TOML above 8 MB", "base/toml_reader.cpp", "max_toml_bytes = 8'000'000;"},
    {"guide.md", "deeper than 50 levels", "base/toml_reader.cpp", "deepest_nesting = 50;"},
    {"guide.md", "more than 300 senders", "telemetry/columns/message_plan.cpp", "max_senders = 300;"},
    {"guide.md", "or 32 without `--aircraft`", "flight/flight_file.cpp", "max_candidates = 32;"},
    {"guide.md", "power above 100 million", "flight/load_flight.cpp", "max_work = 100'000'000;"},
    {"exports.md", "keep half of the reserve", "answer/failsafe.h", "critical_reserve_part = 0.5;"},
    {"exports.md", "standard deviation of 25 % of the power", "answer/failsafe.h", "assumed_level_sd_percent = 25.0;"},
    {"exports.md", "`BAT_CRIT_THR` to 0.25", "exchange/failsafe_parameters.cpp", "{\"BAT_CRIT_THR\", 0.05, 0.25}"},
    {"exports.md", "`BAT_EMERGEN_THR` to 0.1;", "exchange/failsafe_parameters.cpp", "{\"BAT_EMERGEN_THR\", 0.03, 0.1}"},
    {"live.md", "below the reserve is 5 % or more", "live/state/moment.cpp", "caution_probability = 0.05;"},
    {"live.md", "or more; 20 % or more", "live/state/moment.cpp", "alarm_probability = 0.20;"},
    {"live.md", "0.3 V below the battery's model", "live/state/voltage_check.h", "failing_cell_v = 0.3;"},
    {"live.md", "as a median over one minute", "live/state/voltage_check.h", "watched_s = 60.0;"},
    {"live.md", "a time more than 10 s off", "live/state/telemetry_store.h", "max_off_s = 10.0;"},
    {"live.md", "once four more lines confirm it", "live/state/telemetry_store.h", "min_confirmations = 5;"},
    {"live.md", "backwards by less than a minute", "live/state/telemetry_store.h", "max_step_s = 60.0;"},
};

/// The text of a document in one line, so that a sentence is found wherever its lines break.
std::string line_of(const std::filesystem::path& file) {
    return std::regex_replace(read_file(file), std::regex("\\s+"), " ");
}

TEST(Numbers, OfSentencesAreThoseOfTheSource) {
    for (const auto& statement : statements) {
        EXPECT_NE(line_of(source_dir() / "docs" / statement.document).find(statement.sentence), std::string::npos)
            << "docs/" << statement.document << " lacks: " << statement.sentence;
        EXPECT_NE(read_file(source_dir() / "src" / statement.source).find(statement.definition), std::string::npos)
            << "src/" << statement.source << " lacks '" << statement.definition << "': change docs/"
            << statement.document << ": " << statement.sentence;
    }
}

/// Name and default of each option that has one, of all stages.
std::set<std::pair<std::string, double>> option_defaults() {
    std::set<std::pair<std::string, double>> defaults;
    for (const auto* stage : {"segment", "export", "watch"}) {
        const auto shown = run_shell("flightwatt-" + std::string(stage) + " --json-usage", binary_dir()).out;
        const auto usage = nlohmann::json::parse(shown);
        for (const auto& option : usage.at("options")) {
            const auto value = option.at("default").get<std::string>();
            if (value.find_first_not_of("0123456789.") != std::string::npos || value.empty()) continue;
            defaults.emplace(option.at("name").get<std::string>(), std::stod(value));
        }
    }
    return defaults;
}

TEST(Numbers, BehindAnOptionAreItsDefault) {
    const auto defaults = option_defaults();
    const std::regex stated(R"re(`--([a-z-]+)[^`]*`(?: seconds)? \(([0-9.]+)( [^)]*)?\))re");
    std::size_t found = 0;
    for (const auto* name : {"guide.md", "exports.md", "live.md"}) {
        const auto text = line_of(source_dir() / "docs" / name);
        for (std::sregex_iterator it(text.begin(), text.end(), stated), end; it != end; ++it, ++found)
            EXPECT_TRUE(defaults.contains({(*it)[1].str(), std::stod((*it)[2].str())})) << name << ": " << (*it)[0];
    }
    EXPECT_GE(found, 8U);
}

}  // namespace
}  // namespace flightwatt::test
