// flightwatt diff: differences of two models, two batches or two missions, and their significance.

#include "base/input_file.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "batch/batch_fit.h"
#include "cli/output/mission_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mechanical/model_difference.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "stages.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {

Fields<Difference> record_fields(const Difference*) {
    using R = Difference;
    const auto basis = [](const R& r) {
        const auto name = to_string(r.basis);
        return name.empty() ? std::nullopt : std::optional(name);
    };
    return {field("part", &R::part, "the phase, `physical` or `mission`", column{}, csv_column{}),
            field("quantity", &R::quantity, "name of the quantity", column{}, csv_column{}),
            field("unit", &R::unit, "unit of the quantity", column{}, csv_column{}),
            field("a", at(&R::a, &Estimate::value), "value of A", column{"", ".4g"}, csv_column{}),
            field("a_interval_95", at(&R::a, &Estimate::interval), "", column{"a_low|a_high", ".4g"},
                  csv_column{"a_low|a_high"}),
            field("b", at(&R::b, &Estimate::value), "value of B", column{"", ".4g"}, csv_column{}),
            field("b_interval_95", at(&R::b, &Estimate::interval), "", column{"b_low|b_high", ".4g"},
                  csv_column{"b_low|b_high"}),
            field("difference", difference_of, "B less A", column{"", ".4g"}, csv_column{}),
            field("difference_interval_95", &R::interval, "", column{"low|high", ".4g"}, csv_column{"low|high"}),
            field("differs", is_significant, "the interval excludes 0; null: no interval", column{}, csv_column{}),
            field("basis", basis, "`noise` or `flights`; null: no interval", column{}, csv_column{}),
            field("at_s", &R::at_s, "of a curve: time of the largest difference", column{"", ".4g"}, csv_column{})};
}

}  // namespace flightwatt::mechanical

namespace {

using namespace flightwatt;

enum class ComparedKind { models, batches, missions };

/// JSON of the stage.
struct Differences {
    ComparedKind kind = ComparedKind::models;
    std::vector<mechanical::Difference> rows = {};
};

Fields<Differences> record_fields(const Differences*) {
    using R = Differences;
    const auto kind = [](const R& r) {
        constexpr std::array kinds{"models", "batches", "missions"};
        return std::string(kinds.at(static_cast<std::size_t>(r.kind)));
    };
    return {field("kind", kind, "`models`, `batches` or `missions`"), field("differences", &R::rows, "quantities")};
}

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

using mechanical::Difference;
using mechanical::Estimate;

/// A computed quantity of two missions, without intervals.
Difference computed(std::string part, std::string quantity, std::string unit, const std::optional<double>& a,
                    const std::optional<double>& b) {
    const auto estimate = [](const std::optional<double>& value) {
        return value ? std::optional(Estimate{*value, {}}) : std::nullopt;
    };
    return {std::move(part), std::move(quantity), std::move(unit), estimate(a), estimate(b)};
}

double phase_energy_wh(const mission::SocCurve& curve, mission::Phase phase) {
    double energy_j = 0.0;
    for (std::size_t i = 1; i < curve.rows.size(); ++i) {
        const auto& from = curve.rows[i - 1];
        const auto& to = curve.rows[i];
        if (from.phase == phase) energy_j += (to.time_s - from.time_s) * (from.power_w + to.power_w) / 2.0;
    }
    return units::wh_from_joule(energy_j);
}

/// Energy of each phase and the quantities of the whole mission, without intervals.
std::vector<Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b) {
    std::vector<Difference> all;
    all.reserve(2 * mission::all_phases.size());
    for (const auto phase : mission::all_phases) {
        all.push_back(computed(std::string(to_string(phase)), "energy_wh", "Wh", phase_energy_wh(a.curve, phase),
                               phase_energy_wh(b.curve, phase)));
    }
    const auto add = [&](const char* quantity, const char* unit, auto mission::MissionSummary::*member) {
        auto row = computed("mission", quantity, unit, a.summary.*member, b.summary.*member);
        if (row.a || row.b) all.push_back(std::move(row));
    };
    using S = mission::MissionSummary;
    add("duration_s", "s", &S::duration_s);
    add("mechanical_energy_wh", "Wh", &S::mechanical_energy_wh);
    add("compute_energy_wh", "Wh", &S::compute_energy_wh);
    add("energy_wh", "Wh", &S::energy_wh);
    add("final_soc_percent", "%", &S::final_soc_percent);
    add("depleted_at_s", "s", &S::depleted_at_s);
    add("utility", "", &S::utility);
    return all;
}

/// Of two missions.
std::vector<Difference> mission_differences(const cli::StageCall& call) {
    const auto a = mission::read_mission(call.inputs[0], {true, std::nullopt});
    const auto b = mission::read_mission(call.inputs[1], {true, std::nullopt});
    cli::warn_of_setup(call, setup_of(a));
    cli::warn_of_setup(call, setup_of(b));
    const auto flown_a = simulate_prepared(prepare_mission(a)).simulation;
    return mission_difference(flown_a, simulate_prepared(prepare_mission(b)).simulation);
}

/// Of two models or batches.
Differences compare_models(const cli::StageCall& call, ComparedKind kind) {
    return {kind, model_difference(read_model(call.inputs[0], kind), read_model(call.inputs[1], kind))};
}

/// Notes which quantities of two models differ: by more than flights do, and by more than the noise of their samples.
void note_differences(const cli::StageCall& call, const std::vector<Difference>& rows) {
    const auto compared = std::ranges::count_if(rows, [](const auto& row) { return is_significant(row).has_value(); });
    if (compared == 0)
        return cli::note(call,
                         "no significance test: the models have no intervals; `flightwatt fit --errors` writes them");
    for (const auto& [basis, than] : {std::pair{mechanical::DifferenceBasis::flights, "flights of one aircraft do"},
                                      std::pair{mechanical::DifferenceBasis::noise, "the noise of their samples"}}) {
        std::vector<std::string> differing;
        for (const auto& row : rows)
            if (row.basis == basis && is_significant(row).value_or(false))
                differing.push_back(row.part + " " + row.quantity);
        if (!differing.empty())
            cli::note(call, fmt::format("differ by more than {} (of {} compared, one in 20 by chance): {}", than,
                                        compared, fmt::join(differing, ", ")));
    }
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
        kind == ComparedKind::missions ? Differences{kind, mission_differences(call)} : compare_models(call, kind);
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
rest on narrow the intervals. Differences of missions are those of the missions as computed, without intervals:
`flightwatt simulate --samples N` draws the flights of each.)"};
    stage.min_inputs = 2;
    stage.max_inputs = 2;
    stage.json_schema = cli::document_schema<Differences>;
    stage.examples = {"flightwatt diff before.toml after.toml",
                      "flightwatt diff missions/a.toml missions/b.toml -o diff.csv"};
    stage.uses_threads = stage.shows_table = true;
    return cli::run_stage(argc, argv, stage, show_difference);
}
