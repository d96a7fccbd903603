// The front: `flightwatt STAGE ...` runs flightwatt-STAGE, which stands beside it, as git does.

#include "base/toml_reader.h"
#include "cli/stage.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

namespace {

struct StageLine {
    std::string_view name;
    std::string_view summary;
};

constexpr StageLine stages[] = {
    {"parse", "a Paparazzi log to a table of its power samples (CSV)"},
    {"segment", "take-off, cruise and landing of every sortie in a log"},
    {"fit", "several flights to a mechanical power model and Table I"},
    {"validate", "leaves each flight out and predicts its energy, beside simple baselines"},
    {"predict", "the energy to the end of a flight that is in the air"},
    {"battery", "flights to the battery that they were flown on"},
    {"batch", "parse, segment and fit every log of a folder, incrementally"},
    {"profile", "software to its power by quality of service, measured while it runs"},
    {"simulate", "a mission file to its state of charge over time"},
    {"compare", "several missions, ranked by final state of charge"},
    {"plan", "the schedule worth most that lands a mission with its reserve"},
    {"report", "flights, model and missions as one page, and figures for papers"},
    {"synthesize", "made-up Paparazzi logs of flights after a model"},
};

std::string overview() {
    std::string text =
        "flightwatt: the energy of electric drone missions, flight and on-board computer together\n\n"
        "usage: flightwatt STAGE [arguments]; flightwatt STAGE --help tells more\n\nStages:\n";
    for (const auto& [name, summary] : stages) text += fmt::format("  {:<11} {}\n", name, summary);
    return text;
}

std::filesystem::path own_folder() {
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path() : self.parent_path();
}

/// Prints the text; the exit code tells whether it was written.
int show(const std::string& text) {
    const bool written = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
    if (written) return flightwatt::cli::ok;
    fmt::print(stderr, "flightwatt: error: cannot write the standard output: {}\n", std::strerror(errno));
    return flightwatt::cli::internal_error;
}

int refuse_stage(const std::string& stage) {
    std::vector<std::string> names;
    for (const auto& line : stages) {
        if (line.name != stage) {
            names.emplace_back(line.name);
            continue;
        }
        fmt::print(stderr, "flightwatt: error: the program flightwatt-{} is missing beside flightwatt\n",
                   stage);
        return flightwatt::cli::internal_error;
    }
    const auto near = flightwatt::nearest_word(stage, names);
    fmt::print(stderr, "flightwatt: error: there is no stage '{}'; {}\n", stage,
               near.empty() ? "flightwatt alone lists them" : fmt::format("did you mean '{}'?", near));
    return flightwatt::cli::usage_error;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string stage = argc > 1 ? argv[1] : "--help";
    if (stage == "--help" || stage == "-h") return show(overview());
    if (stage == "--version") return show("flightwatt " FLIGHTWATT_VERSION "\n");
    if (stage.find('/') != std::string::npos || stage.starts_with('-')) return refuse_stage(stage);
    const auto program = "flightwatt-" + stage;
    const auto beside = own_folder() / program;
    ::execv(beside.c_str(), argv + 1);
    if (errno == ENOENT) ::execvp(program.c_str(), argv + 1);
    if (errno == ENOENT) return refuse_stage(stage);
    fmt::print(stderr, "flightwatt: error: cannot run {}: {}\n", beside.string(), std::strerror(errno));
    return flightwatt::cli::internal_error;
}
