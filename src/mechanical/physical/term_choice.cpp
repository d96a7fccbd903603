#include "mechanical/physical/term_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::mechanical {
namespace {

/// Whether these coefficients are physically possible, in the order of `terms`.
bool are_physical(const std::vector<PowerTerm>& terms, const ColumnVector& coefficients) {
    double climb = 0.0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const double value = coefficients[static_cast<Eigen::Index>(i)];
        if (terms[i] == PowerTerm::climb) climb = value;
        if (terms[i] == PowerTerm::descent ? value > 0.0 || climb + value < 0.0 : value < 0.0) return false;
    }
    return true;
}

constexpr std::size_t max_folds = 10;
constexpr std::size_t blocks_of_single_flight = 5;

/// Level sd and drift correlation of the cross-validation: rough values are enough to compare terms.
constexpr double working_level_sd = level_prior_scale;
constexpr double working_correlation_bins = 2.0;

/// Means over a whole phase of a hold-out flight.
struct HoldOutPhase {
    ColumnVector columns = ColumnVector::Zero(column_count);
    double power_w = 0.0;
};

/// The flights, or the block of a single flight, that are left out together.
struct TermFold {
    std::vector<NormalEquations> flights;  ///< with the drift's correlation
    NormalEquations uncorrelated;          ///< of all bins
    std::vector<HoldOutPhase> phases;      ///< not used where bins decide
};

struct Folds {
    std::vector<TermFold> folds;
    bool bank_measured = true;
    bool payload_known = true;
    bool rotors_known = true;
    std::size_t rotorcraft = 0;
    bool phases_decide = true;
    std::size_t flights = 0;
    const PowerRegression* regression = nullptr;  ///< of all flights
};

void add_bins(TermFold& fold, std::span<const FlightBin> bins, double correlation_s) {
    fold.flights.push_back(accumulate_normal_equations(bins, correlation_s));
    const auto sums = accumulate_normal_equations(bins, 0.0);
    fold.uncorrelated.products += sums.products;
    fold.uncorrelated.responses += sums.responses;
    fold.uncorrelated.square += sums.square;
    fold.uncorrelated.bins += sums.bins;
}

std::vector<HoldOutPhase> phases_of(std::span<const FlightBin> bins) {
    std::vector<HoldOutPhase> phases;
    for (const auto phase : flight::all_phases) {
        HoldOutPhase sum;
        double duration_s = 0.0;
        for (const auto& bin : bins) {
            if (bin.phase != phase) continue;
            sum.columns += bin.duration_s * as_columns(bin.values);
            sum.power_w += bin.duration_s * bin.power_w;
            duration_s += bin.duration_s;
        }
        if (duration_s > 0.0) phases.push_back({sum.columns / duration_s, sum.power_w / duration_s});
    }
    return phases;
}

Folds folds_of(std::span<const BinnedFlight> flights, const PowerRegression& regression) {
    Folds made;
    made.regression = &regression;
    made.flights = flights.size();
    made.bank_measured = std::ranges::all_of(flights, &BinnedFlight::bank_measured);
    made.payload_known = std::ranges::all_of(flights, &BinnedFlight::payload_known);
    made.rotors_known = std::ranges::all_of(flights, [](const auto& of) { return of.load.rotors.has_value(); });
    made.rotorcraft = static_cast<std::size_t>(std::ranges::count_if(flights, &BinnedFlight::is_rotorcraft));
    const double correlation_s = working_correlation_bins * usual_bin_s(flights);
    if (flights.size() == 1) {
        const std::span bins(flights.front().bins);
        made.phases_decide = false;
        made.folds.resize(std::min(blocks_of_single_flight, bins.size()));
        for (std::size_t i = 0; i < made.folds.size(); ++i) {
            const auto first = bins.size() * i / made.folds.size();
            const auto last = bins.size() * (i + 1) / made.folds.size();
            add_bins(made.folds[i], bins.subspan(first, last - first), correlation_s);
        }
        return made;
    }
    made.folds.resize(std::min(max_folds, flights.size()));
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& fold = made.folds[i % made.folds.size()];
        add_bins(fold, flights[i].bins, correlation_s);
        const auto phases = phases_of(flights[i].bins);
        made.phases_decide = made.phases_decide && phases.size() > 1;
        fold.phases.insert(fold.phases.end(), phases.begin(), phases.end());
    }
    return made;
}

/// Where whole phases decide, a model has no more terms than each of its fits has phases.
std::size_t max_terms(const Folds& of) {
    if (!of.phases_decide) return power_term_count;
    std::size_t all = 0;
    std::size_t max = 0;
    for (const auto& fold : of.folds) {
        all += fold.phases.size();
        max = std::max(max, fold.phases.size());
    }
    return all - max;
}

/// Square errors of predictions, summed over each fold.
struct HoldOutError {
    Eigen::ArrayXd bins_w2;
    Eigen::ArrayXd deciding_w2;  ///< of the mean powers of whole phases, or of bins where these decide
    double deciding = 0.0;       ///< number of phases or bins
    double rms_w() const { return std::sqrt(deciding_w2.sum() / deciding); }
};

/// std::nullopt where a fit is not determined.
std::optional<HoldOutError> hold_out_error(const Folds& of, const std::vector<int>& columns) {
    const auto count = std::ssize(of.folds);
    HoldOutError error{Eigen::ArrayXd::Zero(count), Eigen::ArrayXd::Zero(count)};
    for (Eigen::Index out = 0; out < count; ++out) {
        std::vector<NormalEquations> others;
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto& flights = of.folds[static_cast<std::size_t>(i)].flights;
            if (i != out) others.insert(others.end(), flights.begin(), flights.end());
        }
        if (others.empty()) return std::nullopt;
        const auto fit = fit_gls(others, columns, of.flights == 1 ? 0.0 : working_level_sd);
        if (!fit) return std::nullopt;
        const auto& fold = of.folds[static_cast<std::size_t>(out)];
        error.bins_w2[out] = std::max(fold.uncorrelated.select(columns).square_about(fit->coefficients), 0.0);
        error.deciding += static_cast<double>(of.phases_decide ? fold.phases.size() : fold.uncorrelated.bins);
        if (!of.phases_decide) continue;
        for (const auto& phase : fold.phases) {
            const double power_w = fit->coefficients.dot(phase.columns(columns));
            error.deciding_w2[out] += std::pow(std::max(power_w, 0.0) - phase.power_w, 2);
        }
    }
    if (!of.phases_decide) error.deciding_w2 = error.bins_w2;
    return error;
}

/// Terms that are similar in all motions: few flights cannot distinguish them.
bool is_level_term(PowerTerm term) {
    return term == PowerTerm::drag || term == PowerTerm::induced || term == PowerTerm::constant ||
           term == PowerTerm::hover || term == PowerTerm::blade;
}

/// Reason not to try a term with others; empty without one.
std::string_view not_tried_reason(const Folds& of, const std::vector<PowerTerm>& terms, PowerTerm term) {
    const bool of_wings = term == PowerTerm::induced || term == PowerTerm::turn;
    const bool of_rotors = term == PowerTerm::hover || term == PowerTerm::blade;
    if (of_wings && of.rotorcraft > 0) return "not tried: rotors carry, not wings";
    if (of_rotors && of.rotorcraft < of.flights) return "not tried: wings carry, not rotors";
    if (term == PowerTerm::hover && !of.rotors_known) return "not tried: mass and rotor area are not stated";
    if (term == PowerTerm::payload && !of.payload_known) return "not tried: not every flight states its payload";
    if (term == PowerTerm::turn && !of.bank_measured) return "not tried: the bank was not measured in all flights";
    if (term == PowerTerm::descent && std::ranges::find(terms, PowerTerm::climb) == terms.end())
        return "not tried without the climb";
    if (terms.size() >= max_terms(of)) return "not tried: as many terms as whole phases of a fit determine";
    const auto level_terms = static_cast<std::size_t>(std::ranges::count_if(terms, is_level_term));
    const bool has_room = !is_level_term(term) || level_terms == 0 || level_terms + 1 < of.flights;
    return has_room ? "" : "not tried: so few flights cannot distinguish it from the other level terms";
}

std::vector<PowerTerm> with_term(std::vector<PowerTerm> terms, PowerTerm term) {
    terms.push_back(term);
    std::ranges::sort(terms);
    return terms;
}

/// Whether the fit of all flights is physically possible.
bool is_possible(const Folds& of, const std::vector<PowerTerm>& terms) {
    const auto posterior = of.regression->posterior(columns_of(terms));
    return posterior && are_physical(terms, mean_coefficients(*posterior));
}

struct Candidate {
    PowerTerm term = PowerTerm::drag;
    HoldOutError error;
};

/// By min_mse_reduction, and in more than half of the flights; of two in one. Of a single flight's fifths only one may
/// hold a climb: there the sum alone counts.
bool is_less(const Folds& of, const Eigen::ArrayXd& now_w2, const Eigen::ArrayXd& before_w2) {
    if (now_w2.sum() > (1.0 - min_mse_reduction) * before_w2.sum()) return false;
    const auto improved = (now_w2 < before_w2).count();
    return of.flights == 1 || 2 * improved > now_w2.size() || (now_w2.size() == 2 && improved == 1);
}

/// Tries a term with those that were chosen, and puts the result into the trial. Whole phases decide, as their energy
/// is predicted, but bins must not be predicted worse. This rule was found on four real flights, whose take-offs need a
/// descent term (docs/validation.md, Airspeed and climb): they are no independent evidence for it.
std::optional<Candidate> try_term(const Folds& of, const std::vector<PowerTerm>& terms, const HoldOutError& before,
                                  TermTrial& trial) {
    trial.rms_before_w.reset();
    trial.rms_after_w.reset();
    trial.reason = not_tried_reason(of, terms, trial.term);
    if (!trial.reason.empty()) return std::nullopt;
    const auto more = with_term(terms, trial.term);
    const auto error = hold_out_error(of, columns_of(more));
    if (!error) {
        trial.reason = "not tried: these flights do not determine it";
        return std::nullopt;
    }
    trial.rms_before_w = before.rms_w();
    trial.rms_after_w = error->rms_w();
    // What payload adds is small against a missing term of take-off and landing: bins alone decide on it.
    const bool is_payload = trial.term == PowerTerm::payload;
    if (is_payload ? error->bins_w2.sum() >= before.bins_w2.sum()
                   : !is_less(of, error->deciding_w2, before.deciding_w2)) {
        trial.reason = "does not improve predictions";
    } else if (error->bins_w2.sum() > before.bins_w2.sum()) {
        trial.reason = "predicts whole phases better, but bins worse";
    } else if (!is_possible(of, more)) {
        trial.reason = "would have a physically impossible coefficient";
    }
    if (!trial.reason.empty()) return std::nullopt;
    return Candidate{trial.term, *error};
}

/// The drag, or a constant where these flights' power does not follow it. Bins decide: whole phases differ by their
/// climb, which has no term yet.
std::optional<Candidate> first_term(const Folds& of) {
    std::optional<Candidate> first;
    for (const auto term : {PowerTerm::drag, PowerTerm::constant, PowerTerm::hover}) {
        if (!not_tried_reason(of, {}, term).empty()) continue;
        auto error = hold_out_error(of, columns_of({term}));
        if (!error || !is_possible(of, {term})) continue;
        if (!first || is_less(of, error->bins_w2, first->error.bins_w2)) first = Candidate{term, std::move(*error)};
    }
    return first;
}

}  // namespace

TermSelection select_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression) {
    const auto of = folds_of(flights, regression);
    TermSelection choice{{}, {}, of.folds.size(), of.phases_decide};
    for (const auto term : all_power_terms) choice.trials.push_back({term, false, {}, {}, ""});
    const auto trial_of = [&](PowerTerm term) -> TermTrial& { return choice.trials[static_cast<std::size_t>(term)]; };
    auto best = first_term(of);
    if (best) trial_of(best->term).rms_after_w = best->error.rms_w();
    while (best) {
        const auto chosen = *best;
        best.reset();
        trial_of(chosen.term).kept = true;
        trial_of(chosen.term).reason.clear();
        choice.terms = with_term(std::move(choice.terms), chosen.term);
        for (auto& trial : choice.trials) {
            if (trial.kept) continue;
            auto candidate = try_term(of, choice.terms, chosen.error, trial);
            if (!candidate) continue;
            trial.reason = "another term in its place predicts better";
            if (!best || candidate->error.deciding_w2.sum() < best->error.deciding_w2.sum())
                best = std::move(candidate);
        }
    }
    return choice;
}

}  // namespace flightwatt::mechanical
