#include "mechanical/physical/term_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {
namespace {

constexpr std::size_t max_folds = 10;
constexpr std::size_t blocks_of_single_flight = 5;

/// The level and the drift that the choice works with: about right is enough to compare terms.
constexpr double working_level_sd = level_prior_scale;
constexpr double working_correlation_s = 2.0 * default_bin_s;

/// Means over a whole phase of a flight that is held back.
struct HeldPhase {
    ColumnVector columns = ColumnVector::Zero(column_count);
    double power_w = 0.0;
};

/// What is held back at once.
struct TermFold {
    std::vector<NormalEquations> flights;  ///< their drift taken out
    NormalEquations plain;                 ///< of all bins as they are
    std::vector<HeldPhase> phases;         ///< empty where bins decide
};

struct Folds {
    std::vector<TermFold> folds;
    double level_sd = working_level_sd;
    bool bank_measured = true;
    bool phases_decide = false;
    std::size_t flights = 0;
    const PowerRegression* regression = nullptr;  ///< of all flights
};

void add_to(NormalEquations& sum, const NormalEquations& other) {
    sum.products += other.products;
    sum.responses += other.responses;
    sum.square += other.square;
    sum.bins += other.bins;
}

void add_bins(TermFold& fold, std::span<const FlightBin> bins) {
    fold.flights.push_back(accumulate_normal_equations(bins, working_correlation_s));
    add_to(fold.plain, accumulate_normal_equations(bins, 0.0));
}

std::vector<HeldPhase> phases_of(std::span<const FlightBin> bins) {
    const auto scale = column_scale();
    std::vector<HeldPhase> phases;
    for (const auto phase : flight::all_phases) {
        HeldPhase sum;
        double duration_s = 0.0;
        for (const auto& bin : bins) {
            if (bin.phase != phase) continue;
            sum.columns += bin.duration_s * column_values(bin, scale);
            sum.power_w += bin.duration_s * bin.power_w;
            duration_s += bin.duration_s;
        }
        if (duration_s > 0.0) phases.push_back({sum.columns / duration_s, sum.power_w / duration_s});
    }
    return phases;
}

Folds folds_of_single(const BinnedFlight& flight) {
    Folds made;
    made.level_sd = 0.0;
    const std::span<const FlightBin> bins(flight.bins);
    made.folds.resize(std::min(blocks_of_single_flight, bins.size()));
    for (std::size_t i = 0; i < made.folds.size(); ++i) {
        const auto first = bins.size() * i / made.folds.size();
        const auto last = bins.size() * (i + 1) / made.folds.size();
        add_bins(made.folds[i], bins.subspan(first, last - first));
    }
    return made;
}

Folds folds_of_several(std::span<const BinnedFlight> flights) {
    Folds made;
    made.phases_decide = true;
    made.folds.resize(std::min(max_folds, flights.size()));
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& fold = made.folds[i % made.folds.size()];
        add_bins(fold, flights[i].bins);
        const auto phases = phases_of(flights[i].bins);
        made.phases_decide = made.phases_decide && phases.size() > 1;
        fold.phases.insert(fold.phases.end(), phases.begin(), phases.end());
    }
    return made;
}

Folds folds_of(std::span<const BinnedFlight> flights) {
    auto made = flights.size() == 1 ? folds_of_single(flights.front()) : folds_of_several(flights);
    made.flights = flights.size();
    made.bank_measured = std::ranges::all_of(flights, &BinnedFlight::bank_measured);
    return made;
}

/// A model that whole phases choose has no more terms than each of its fits rests on phases.
std::size_t most_terms(const Folds& of) {
    if (!of.phases_decide) return power_term_count;
    std::size_t all = 0;
    std::size_t most = 0;
    for (const auto& fold : of.folds) {
        all += fold.phases.size();
        most = std::max(most, fold.phases.size());
    }
    return all - most;
}

struct SquareErrors {
    std::vector<double> sums;  ///< one a fold
    double mean = 0.0;
};

/// How well columns predict what was held back.
struct HeldBackError {
    SquareErrors bins;
    SquareErrors phases;  ///< of mean powers; those of the bins where bins decide
    double rms_w() const { return std::sqrt(phases.mean); }
};

SquareErrors square_errors(std::vector<double> sums, std::size_t count) {
    const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
    return {std::move(sums), sum / static_cast<double>(count)};
}

double bin_square(const NormalEquations& plain, const std::vector<int>& columns, const ColumnVector& c) {
    const ColumnVector fitted = plain.products(columns, columns) * c;
    const ColumnVector responses = plain.responses(columns);
    return std::max(plain.square - 2.0 * c.dot(responses) + c.dot(fitted), 0.0);
}

/// As a phase's energy is predicted: not below 0.
double phase_square(std::span<const HeldPhase> phases, const std::vector<int>& columns, const ColumnVector& c) {
    double sum = 0.0;
    for (const auto& phase : phases) {
        const ColumnVector values = phase.columns(columns);
        sum += std::pow(std::max(c.dot(values), 0.0) - phase.power_w, 2);
    }
    return sum;
}

/// std::nullopt where a fit is not determined.
std::optional<HeldBackError> held_back_error(const Folds& of, const std::vector<int>& columns) {
    std::vector<double> bin_sums;
    std::vector<double> phase_sums;
    bin_sums.reserve(of.folds.size());
    phase_sums.reserve(of.folds.size());
    std::size_t bins = 0;
    std::size_t phases = 0;
    for (std::size_t out = 0; out < of.folds.size(); ++out) {
        std::vector<NormalEquations> others;
        for (std::size_t i = 0; i < of.folds.size(); ++i)
            if (i != out) others.insert(others.end(), of.folds[i].flights.begin(), of.folds[i].flights.end());
        if (others.empty()) return std::nullopt;
        const auto fit = fit_gls(others, columns, of.level_sd);
        if (!fit) return std::nullopt;
        const auto& fold = of.folds[out];
        bin_sums.push_back(bin_square(fold.plain, columns, fit->coefficients));
        phase_sums.push_back(phase_square(fold.phases, columns, fit->coefficients));
        bins += fold.plain.bins;
        phases += fold.phases.size();
    }
    HeldBackError error{square_errors(std::move(bin_sums), bins), {}};
    error.phases = of.phases_decide ? square_errors(std::move(phase_sums), phases) : error.bins;
    return error;
}

/// Terms that every motion has much alike: between few flights they cannot be told apart.
bool is_of_level(PowerTerm term) {
    return term == PowerTerm::drag || term == PowerTerm::induced || term == PowerTerm::constant;
}

bool has(const std::vector<PowerTerm>& terms, PowerTerm term) { return std::ranges::find(terms, term) != terms.end(); }

/// Why a term cannot be tried beside others; empty if it can.
std::string why_untried(const Folds& of, const std::vector<PowerTerm>& terms, PowerTerm term) {
    if (term == PowerTerm::turn && !of.bank_measured) return "not tried: the bank was not measured in all flights";
    if (term == PowerTerm::descent && !has(terms, PowerTerm::climb)) return "not tried without the climb";
    if (terms.size() >= most_terms(of))
        return fmt::format("not tried: as many terms as the {} whole phases of a fit determine", most_terms(of));
    const auto levels = std::ranges::count_if(terms, is_of_level);
    if (is_of_level(term) && levels > 0 &&
        static_cast<std::size_t>(levels) + 1 > std::max<std::size_t>(1, of.flights - 1))
        return fmt::format("not tried beside {}: {} flight{} cannot tell them apart",
                           fmt::join(
                               [&] {
                                   std::vector<std::string_view> names;
                                   for (const auto other : terms)
                                       if (is_of_level(other)) names.push_back(to_string(other));
                                   return names;
                               }(),
                               " and "),
                           of.flights, of.flights == 1 ? "" : "s");
    return "";
}

std::vector<PowerTerm> with(std::vector<PowerTerm> terms, PowerTerm term) {
    terms.push_back(term);
    std::ranges::sort(terms);
    return terms;
}

/// Whether the fit of all flights is one that physics lets be.
bool is_possible(const Folds& of, const std::vector<PowerTerm>& terms) {
    const auto posterior = of.regression->posterior(columns_of(terms));
    return posterior && are_physical(terms, mean_coefficients(*posterior));
}

struct Candidate {
    PowerTerm term = PowerTerm::drag;
    HeldBackError error;
};

/// By min_mse_reduction, and in more than half of the flights; of two in one. Of a single flight's fifths only one may
/// hold a climb: there the sum alone counts.
bool is_less(const Folds& of, const SquareErrors& now, const SquareErrors& before) {
    if (now.mean > (1.0 - min_mse_reduction) * before.mean) return false;
    std::size_t won = 0;
    for (std::size_t i = 0; i < now.sums.size(); ++i)
        if (now.sums[i] < before.sums[i]) ++won;
    const auto folds = now.sums.size();
    return of.flights == 1 || 2 * won > folds || (folds == 2 && won == 1);
}

/// Why a term that was tried is not kept; empty if it may be. Whole phases decide, as it is their energy that is
/// predicted; but no term may describe the course of the power worse. This rule was found with four real flights in
/// view, whose take-offs need a descent term (docs/validation.md, Airspeed and climb): they prove little of it.
std::string why_dropped(const Folds& of, const HeldBackError& now, const HeldBackError& before) {
    if (!is_less(of, now.phases, before.phases)) return "does not predict what was held back";
    if (now.bins.mean > before.bins.mean) return "predicts whole phases better, but stretches of them worse";
    return "";
}

/// Tries a term beside those that were chosen, and says in the trial what came of it.
std::optional<Candidate> tried(const Folds& of, const std::vector<PowerTerm>& terms, const HeldBackError& before,
                               TermTrial& trial) {
    const auto term = trial.term;
    trial.rms_before_w.reset();
    trial.rms_after_w.reset();
    trial.reason = why_untried(of, terms, term);
    if (!trial.reason.empty()) return std::nullopt;
    const auto more = with(terms, term);
    const auto error = held_back_error(of, columns_of(more));
    if (!error) {
        trial.reason = "not tried: these flights do not determine it";
        return std::nullopt;
    }
    trial.rms_before_w = before.rms_w();
    trial.rms_after_w = error->rms_w();
    trial.reason = why_dropped(of, *error, before);
    if (!trial.reason.empty()) return std::nullopt;
    if (!is_possible(of, more)) {
        trial.reason = "would take a coefficient that physics does not let be";
        return std::nullopt;
    }
    return Candidate{term, *error};
}

/// The drag, or a constant where these flights' power does not follow it. Bins decide: whole phases differ by their
/// climb, which has no term yet.
std::optional<Candidate> first_term(const Folds& of) {
    std::optional<Candidate> first;
    for (const auto term : {PowerTerm::drag, PowerTerm::constant}) {
        auto error = held_back_error(of, columns_of({term}));
        if (!error || !is_possible(of, {term})) continue;
        if (!first || is_less(of, error->bins, first->error.bins)) first = Candidate{term, std::move(*error)};
    }
    return first;
}

}  // namespace

bool are_physical(const std::vector<PowerTerm>& terms, const ColumnVector& coefficients) {
    double climb = 0.0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const double value = coefficients[static_cast<Eigen::Index>(i)];
        if (terms[i] == PowerTerm::climb) climb = value;
        if (terms[i] == PowerTerm::descent ? value > 0.0 || climb + value < 0.0 : value < 0.0) return false;
    }
    return true;
}

TermSelection select_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression) {
    auto of = folds_of(flights);
    of.regression = &regression;
    TermSelection choice;
    choice.folds = of.folds.size();
    choice.phases_decided = of.phases_decide;
    for (const auto term : all_power_terms) choice.trials.push_back({term, false, {}, {}, ""});
    const auto first = first_term(of);
    if (!first) return choice;
    choice.terms = {first->term};
    auto error = first->error;
    choice.trials[static_cast<std::size_t>(first->term)].kept = true;
    choice.trials[static_cast<std::size_t>(first->term)].rms_after_w = error.rms_w();
    for (bool grown = true; grown;) {
        std::optional<Candidate> best;
        for (const auto term : all_power_terms) {
            auto& trial = choice.trials[static_cast<std::size_t>(term)];
            if (trial.kept) continue;
            auto candidate = tried(of, choice.terms, error, trial);
            if (!candidate) continue;
            trial.reason = "another term in its place predicts better";
            if (!best || candidate->error.phases.mean < best->error.phases.mean) best = std::move(candidate);
        }
        grown = best.has_value();
        if (!grown) continue;
        auto& trial = choice.trials[static_cast<std::size_t>(best->term)];
        trial.kept = true;
        trial.reason.clear();
        choice.terms = with(choice.terms, best->term);
        error = best->error;
    }
    return choice;
}

}  // namespace flightwatt::mechanical
