// flightwatt diff: what differs between two models, two batches or two missions, and whether it is more than chance.

#include "base/error.h"
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
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;
using mechanical::Difference;
using mechanical::Estimate;

enum class ComparedKind { model, batch, mission };

std::string_view to_string(ComparedKind kind) {
    return kind == ComparedKind::model   ? "a model"
           : kind == ComparedKind::batch ? "a folder of flightwatt batch"
                                         : "a mission";
}

ComparedKind compared_kind(const std::string& input) {
    std::error_code none;
    if (std::filesystem::is_directory(input, none)) return ComparedKind::batch;
    const auto file = parse_toml(read_file(input), input);
    if (file.has("takeoff") && file.is_table("takeoff") && !file.has("battery")) return ComparedKind::model;
    if (file.has("battery") || file.has("mechanical") || file.has("components")) return ComparedKind::mission;
    throw InputError({input}, "is neither a mechanical model nor a mission",
                     "give two models, two folders of flightwatt batch, or two missions");
}

mechanical::MechanicalModel read_model(const std::string& input, ComparedKind kind) {
    if (kind == ComparedKind::model) return mechanical::read_mechanical_model(input);
    auto fit = batch::read_batch_fit(input);
    if (!fit) throw InputError({input}, "holds no model of a batch", "run flightwatt batch ... -o " + input);
    return std::move(fit->model);
}

/// What a mission comes to is computed, and has no interval of its own.
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

double soc_at(const mission::SocCurve& curve, double time_s) {
    const auto after = std::ranges::lower_bound(curve.rows, time_s, {}, &mission::SocRow::time_s);
    if (after == curve.rows.begin()) return curve.rows.front().soc_percent;
    if (after == curve.rows.end()) return curve.rows.back().soc_percent;
    const auto& before = *std::prev(after);
    const auto part = (time_s - before.time_s) / (after->time_s - before.time_s);
    return std::lerp(before.soc_percent, after->soc_percent, part);
}

/// Where the states of charge are furthest apart, as long as both fly.
std::optional<Difference> soc_difference(const mission::SocCurve& a, const mission::SocCurve& b) {
    if (a.rows.empty() || b.rows.empty()) return std::nullopt;
    const auto end_s = std::min(a.rows.back().time_s, b.rows.back().time_s);
    double max_s = 0.0;
    double largest = -1.0;
    for (const auto* curve : {&a, &b}) {
        for (const auto& row : curve->rows) {
            if (row.time_s > end_s) break;
            const auto apart = std::abs(soc_at(b, row.time_s) - soc_at(a, row.time_s));
            if (apart > largest) std::tie(largest, max_s) = std::pair(apart, row.time_s);
        }
    }
    auto row = computed("mission", "soc_percent", "%", soc_at(a, max_s), soc_at(b, max_s));
    row.at_s = max_s;
    return row;
}

/// By how flights differ, where both missions say it: as drawn for both.
void add_intervals(const mission::SampledDifference& drawn, std::vector<Difference>& rows) {
    const std::map<std::string_view, const mission::DrawnIntervals*> intervals{
        {"duration_s", &drawn.duration_s},
        {"mechanical_energy_wh", &drawn.mechanical_energy_wh},
        {"compute_energy_wh", &drawn.compute_energy_wh},
        {"energy_wh", &drawn.energy_wh},
        {"final_soc_percent", &drawn.final_soc_percent}};
    const auto of = [](const battery::Interval& from) { return mechanical::Interval{from.low, from.high}; };
    for (auto& row : rows) {
        const auto found = intervals.find(row.quantity);
        if (row.part != "mission" || found == intervals.end() || !row.a || !row.b) continue;
        row.a->interval = of(found->second->a);
        row.b->interval = of(found->second->b);
        row.interval = of(found->second->difference);
        row.basis = mechanical::DifferenceBasis::flights;
    }
}

std::vector<Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b) {
    std::vector<Difference> all;
    all.reserve(mission::all_phases.size() + 8);  // and of the whole mission
    for (const auto phase : mission::all_phases) {
        all.push_back(computed(std::string(to_string(phase)), "energy_wh", "Wh", phase_energy_wh(a.curve, phase),
                               phase_energy_wh(b.curve, phase)));
    }
    const auto add = [&](const char* quantity, const char* unit, const std::optional<double>& of_a,
                         const std::optional<double>& of_b) {
        if (of_a || of_b) all.push_back(computed("mission", quantity, unit, of_a, of_b));
    };
    const auto& x = a.summary;
    const auto& y = b.summary;
    add("duration_s", "s", x.duration_s, y.duration_s);
    add("mechanical_energy_wh", "Wh", x.mechanical_energy_wh, y.mechanical_energy_wh);
    add("compute_energy_wh", "Wh", x.compute_energy_wh, y.compute_energy_wh);
    add("energy_wh", "Wh", x.energy_wh, y.energy_wh);
    add("final_soc_percent", "%", x.final_soc_percent, y.final_soc_percent);
    add("depleted_at_s", "s", x.depleted_at_s, y.depleted_at_s);
    add("utility", "", x.utility, y.utility);
    if (const auto curve = soc_difference(a.curve, b.curve)) all.push_back(*curve);
    return all;
}

/// "yes", "no", or "-" where nobody can say. A computed difference is one wherever it is more than rounding.
std::string verdict(const Difference& row, ComparedKind kind) {
    if (kind != ComparedKind::mission || row.interval) {
        const auto significant = is_significant(row);
        return !significant ? "-" : *significant ? "yes" : "no";
    }
    const auto difference = difference_of(row);
    if (!difference) return "-";  // only one of them has it
    constexpr double rounding = 1e-9;
    return std::abs(*difference) > rounding * std::max(std::abs(row.a->value), std::abs(row.b->value)) ? "yes" : "no";
}

std::string basis_of(const Difference& row, ComparedKind kind) {
    return kind == ComparedKind::mission && !row.interval ? "computed" : to_string(row.basis);
}

template <typename Form>
TextTable difference_table(const std::vector<Difference>& rows, ComparedKind kind, const Form& form) {
    TextTable table{{"part", "quantity", "unit", "a", "a_low", "a_high", "b", "b_low", "b_high", "difference", "low",
                     "high", "differs", "basis", "at_s"},
                    {}};
    for (const auto& row : rows) {
        std::vector<std::string> cells{row.part, row.quantity, row.unit};
        const auto number = [&](const std::optional<double>& value) { cells.push_back(value ? form(*value) : "-"); };
        const auto interval = [&](const std::optional<mechanical::Interval>& of) {
            number(of ? std::optional(of->low) : std::nullopt);
            number(of ? std::optional(of->high) : std::nullopt);
        };
        for (const auto* side : {&row.a, &row.b}) {
            number(*side ? std::optional((*side)->value) : std::nullopt);
            interval(*side ? (*side)->interval : std::nullopt);
        }
        number(difference_of(row));
        interval(row.interval);
        cells.push_back(verdict(row, kind));
        const auto basis = basis_of(row, kind);
        cells.push_back(basis.empty() ? "-" : basis);
        number(row.at_s);
        table.rows.push_back(std::move(cells));
    }
    return table;
}

cli::Json difference_json(const std::vector<Difference>& rows, ComparedKind kind,
                          const std::vector<std::string>& shared) {
    const auto interval = [](const std::optional<mechanical::Interval>& of) {
        return of ? cli::Json::array({of->low, of->high}) : cli::Json(nullptr);
    };
    cli::Json json{{"kind", kind == ComparedKind::mission ? "missions"
                            : kind == ComparedKind::batch ? "batches"
                                                          : "models"},
                   {"shared_flights", shared},
                   {"differences", cli::Json::array()}};
    for (const auto& row : rows) {
        cli::Json item{{"part", row.part}, {"quantity", row.quantity}, {"unit", row.unit}};
        for (const auto& [name, side] : {std::pair("a", &row.a), std::pair("b", &row.b)}) {
            item[name] = *side ? cli::Json((*side)->value) : cli::Json(nullptr);
            item[fmt::format("{}_interval", name)] = interval(*side ? (*side)->interval : std::nullopt);
        }
        item["difference"] = cli::optional_json(difference_of(row));
        item["interval"] = interval(row.interval);
        const auto differs = verdict(row, kind);
        item["differs"] = differs == "-" ? cli::Json(nullptr) : cli::Json(differs == "yes");
        item["basis"] = basis_of(row, kind);
        item["at_s"] = cli::optional_json(row.at_s);
        json["differences"].push_back(std::move(item));
    }
    return json;
}

/// Coefficients that differ by noise alone say little of the aircraft: they are told apart from means over flights.
void say_what_differs(const cli::StageCall& call, const std::vector<Difference>& rows) {
    std::vector<std::string> beyond_noise;
    std::vector<std::string> beyond_flights;
    std::size_t judged = 0;
    for (const auto& row : rows) {
        const auto significant = is_significant(row);
        if (significant) ++judged;
        if (!significant.value_or(false)) continue;
        auto& differing = row.basis == mechanical::DifferenceBasis::noise ? beyond_noise : beyond_flights;
        differing.push_back(row.part + " " + row.quantity);
    }
    if (judged == 0) {
        cli::note(call, "nothing can be judged: these models hold no intervals; `flightwatt fit --errors` writes them");
    } else if (beyond_noise.empty() && beyond_flights.empty()) {
        cli::note(call, fmt::format("none of {} quantities differs by more than its 95 % interval", judged));
    }
    if (!beyond_flights.empty()) {
        cli::note(call,
                  fmt::format("differ by more than flights of one aircraft do (of {} judged, one in 20 by chance): {}",
                              judged, fmt::join(beyond_flights, ", ")));
    }
    if (!beyond_noise.empty()) {
        cli::note(call, fmt::format("differ by more than the noise of their samples, as other flights of the same "
                                    "aircraft may: {}",
                                    fmt::join(beyond_noise, ", ")));
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
                                     to_string(kind), b, to_string(other)));
    }
    std::vector<Difference> rows;
    std::vector<std::string> shared;
    if (kind == ComparedKind::mission) {
        const auto missions =
            std::pair(mission::read_mission(a, {true, std::nullopt}), mission::read_mission(b, {true, std::nullopt}));
        cli::warn_of_setup(call, setup_of(missions.first));
        cli::warn_of_setup(call, setup_of(missions.second));
        const auto prepared_a = prepare_mission(missions.first);
        const auto prepared_b = prepare_mission(missions.second);
        rows = mission_difference(simulate_prepared(prepared_a).simulation, simulate_prepared(prepared_b).simulation);
        if (const auto drawn = sample_difference(prepared_a, prepared_b)) {
            add_intervals(*drawn, rows);
            cli::note(call, describe(*drawn));
        }
    } else {
        const auto of_a = read_model(a, kind);
        const auto of_b = read_model(b, kind);
        shared = shared_flights(of_a, of_b);
        rows = model_difference(of_a, of_b);
        if (!shared.empty()) {
            cli::note(call, fmt::format("both rest on {}: the intervals of the differences allow for that",
                                        fmt::join(shared, ", ")));
        }
    }
    const auto screen = screen_of(call);
    if (screen.is_terminal && !call.output && !call.json) {
        const auto table = difference_table(rows, kind, [](double value) { return fmt::format("{:.4g}", value); });
        cli::print(screen_text(table, screen,
                               {fmt::format("{} against {}", b, a),
                                {"part", "quantity", "a", "b", "difference", "low", "high", "differs", "at_s"}}));
    } else {
        cli::write_result(call, to_csv(difference_table(rows, kind, [](double v) { return fmt::format("{}", v); })));
    }
    if (call.json) cli::print(cli::json_text(difference_json(rows, kind, shared)));
    if (kind != ComparedKind::mission) say_what_differs(call, rows);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::diff_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "diff", "A B",
        R"(Says what differs between two mechanical models, two folders of flightwatt batch, or two missions: B minus A
with its 95 % interval, and whether that excludes 0. Coefficients are judged by the noise of the samples (basis noise),
durations, mean powers, energies and physical terms by how flights differ (basis flights). Flights that both models
rest on narrow the intervals. Missions are computed: each difference is one; where both say how flights differ, duration,
energies and final charge are judged by what 95 of 100 flights drawn for both differ by (basis flights).)"};
    stage.min_inputs = 2;
    stage.max_inputs = 2;
    stage.shows_table = true;
    return cli::run_stage(argc, argv, stage, show_difference);
}
