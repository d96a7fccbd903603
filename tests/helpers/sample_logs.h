#pragma once

#include "base/atomic_file.h"
#include "batch/batch_run.h"
#include "batch/manifest.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace flightwatt::test {

inline std::filesystem::path sample(int number, const std::string& ending = ".data") {
    return source_dir() / "logs" / ("opterra_synthetic_0" + std::to_string(number) + ending);
}

/// Copies a sample log and its .log into `folder`, under another name if one is given.
inline std::filesystem::path copy_sample(int number, const std::filesystem::path& folder, std::string name = "") {
    if (name.empty()) name = sample(number).stem().string();
    std::filesystem::create_directories(folder);
    const auto overwrite = std::filesystem::copy_options::overwrite_existing;
    std::filesystem::copy_file(sample(number, ".log"), folder / (name + ".log"), overwrite);
    std::filesystem::copy_file(sample(number), folder / (name + ".data"), overwrite);
    return folder / (name + ".data");
}

/// Every file below a folder, by its path in there.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files[std::filesystem::relative(entry.path(), folder).string()] = read_file(entry.path());
        }
    }
    return files;
}

/// A batch over `input` into `out`, with the catalogue that flightwatt batch writes.
inline batch::BatchFlights batch(const std::filesystem::path& input, const std::filesystem::path& out,
                                 unsigned jobs = 2, bool prune = false) {
    batch::BatchOptions options;
    options.out = out;
    options.jobs = jobs;
    const auto plan = batch::plan_batch(batch::find_logs({input.string()}), out, prune);
    refuse_foreign_files(plan, out);
    prepare_folder(plan, out);
    auto flights = run_batch(plan.logs, options, [](std::size_t, std::size_t, const batch::BatchFlight&) {});
    write_file_atomically(out / "flights.csv", batch::catalogue_csv(flights));
    return flights;
}

/// What a fit takes of the batch in `out`.
inline std::vector<mechanical::MeasuredFlight> samples_of(const batch::BatchFlights& flights,
                                                          const std::filesystem::path& out) {
    batch::BatchOptions options;
    options.out = out;
    return read_samples(flights, options);
}

/// A text that is written in pieces.
inline std::string text_of(const TextWriter& write) {
    std::string text;
    write([&](std::string_view piece) { text += piece; });
    return text;
}

/// The flights that were done again.
inline std::vector<std::string> done_anew(const batch::BatchFlights& flights) {
    std::vector<std::string> names;
    for (const auto& flight : flights) {
        if (!flight.was_up_to_date) names.push_back(flight.record.flight);
    }
    return names;
}

}  // namespace flightwatt::test
