// flightwatt diff: differences of two models, two batches or two missions, and their significance.

#include "base/error.h"
#include "base/input_file.h"
#include "base/toml_reader.h"
#include "batch/batch_fit.h"
#include "cli/output/difference_output.h"
#include "cli/output/mission_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "stages.h"

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace {

using namespace flightwatt;
using ComparedKind = cli::DifferenceKind;

std::string_view name_of(ComparedKind kind) {
    return kind == ComparedKind::models    ? "a model"
           : kind == ComparedKind::batches ? "a folder of flightwatt batch"
                                           : "a mission";
}

ComparedKind compared_kind(const std::string& input) {
    std::error_code none;
    if (std::filesystem::is_directory(input, none)) return ComparedKind::batches;
    const auto kind = kind_of_text(read_file(input));
    if (kind == FileKind::mechanical_model) return ComparedKind::models;
    if (kind == FileKind::mission) return ComparedKind::missions;
    throw InputError({input}, "is neither a mechanical model nor a mission",
                     "give two models, two folders of flightwatt batch, or two missions");
}

mechanical::MechanicalModel read_model(const std::string& input, ComparedKind kind) {
    if (kind == ComparedKind::models) return mechanical::read_mechanical_model(input);
    auto fit = batch::read_batch_fit(input);
    if (!fit) throw InputError({input}, "holds no model of a batch", "run flightwatt batch ... -o " + input);
    return std::move(fit->model);
}

/// Of two missions.
std::vector<mechanical::Difference> mission_differences(const cli::StageCall& call) {
    const auto a = mission::read_mission(call.inputs[0], {true, std::nullopt});
    const auto b = mission::read_mission(call.inputs[1], {true, std::nullopt});
    cli::warn_of_setup(call, setup_of(a));
    cli::warn_of_setup(call, setup_of(b));
    const auto prepared_a = prepare_mission(a);
    const auto prepared_b = prepare_mission(b);
    const auto flown_a = simulate_prepared(prepared_a).simulation;
    const auto flown_b = simulate_prepared(prepared_b).simulation;
    const auto drawn = sample_difference(prepared_a, prepared_b);
    if (drawn) cli::note(call, describe(*drawn));
    return cli::mission_difference(flown_a, flown_b, drawn);
}

/// Of two models or batches.
cli::Differences compare_models(const cli::StageCall& call, ComparedKind kind) {
    return {kind, model_difference(read_model(call.inputs[0], kind), read_model(call.inputs[1], kind))};
}

int show_difference(const cli::StageCall& call) {
    if (call.inputs.size() != 2)
        throw UsageError("expected two models, two folders of flightwatt batch or two missions");
    const auto& a = call.inputs[0];
    const auto& b = call.inputs[1];
    const auto kind = compared_kind(a);
    if (const auto other = compared_kind(b); other != kind) {
        throw UsageError(fmt::format("{} is {} and {} is {}: they have no quantity in common; give two of one kind", a,
                                     name_of(kind), b, name_of(other)));
    }
    const auto differences =
        kind == ComparedKind::missions ? cli::Differences{kind, mission_differences(call)} : compare_models(call, kind);
    const auto screen = screen_of(call);
    if (screen.is_terminal && !call.output && !call.json) {
        const auto table = table_of(differences.rows);
        cli::print(screen_text(table, screen,
                               {fmt::format("{} against {}", b, a),
                                {"part", "quantity", "a", "b", "difference", "low", "high", "differs", "at_s"}}));
    } else {
        cli::write_result(call, csv_of(differences.rows));
    }
    if (call.json) cli::print_json(call, differences);
    if (kind != ComparedKind::missions) note_differences(call, differences.rows);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::diff_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "diff", "A B",
        R"(Compares two mechanical models, two folders of flightwatt batch, or two missions: B minus A with its 95 %
interval, and whether that excludes 0. Intervals of coefficients follow from the noise of the samples (basis noise),
those of durations, mean powers, energies and physical terms from the variability between flights (basis flights). Flights that both models
rest on narrow the intervals. Differences of missions are exact; if both state the variability of flights, the intervals of
duration, energies and final charge are those of 95 of 100 flights drawn for both (basis flights).)"};
    stage.min_inputs = 2;
    stage.max_inputs = 2;
    stage.json_schema = cli::document_schema<cli::Differences>;
    stage.examples = {"flightwatt diff before.toml after.toml",
                      "flightwatt diff missions/a.toml missions/b.toml -o diff.csv"};
    stage.uses_threads = stage.shows_table = true;
    return cli::run_stage(argc, argv, stage, show_difference);
}
