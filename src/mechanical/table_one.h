#pragma once

#include "base/text_table.h"
#include "mechanical/mechanical_model.h"

#include <string>
#include <string_view>

namespace flightwatt::mechanical {

/// Whether each phase has a column of the coefficients' 95 % intervals, "LOW to HIGH", or why it is absent.
enum class TableIntervals { absent, present };

/// The model as the paper's Table I: rows a0, a1, b1, ... and xi, a column a phase with four significant digits, and
/// their units. xi is the paper's: the angular frequency on a time axis of 28 units a phase,
/// omega * duration / 28. '-' where a phase has a lower order than another.
TextTable table_one(const MechanicalModel& model, TableIntervals intervals = TableIntervals::absent);

/// Both models' Table I, phase by phase side by side, and below it the durations, the RMS difference of the curves over
/// the phase [W] and the difference of a0 in percent of the published one.
TextTable table_one_comparison(const MechanicalModel& published, const MechanicalModel& regenerated,
                               TableIntervals intervals = TableIntervals::absent);

/// Table I as a LaTeX table environment like the paper's: its caption on top, coefficients as $a_0$ ...
/// $\xi$, numbers in mathematical mode, 95 % intervals in brackets; a phase without any has its reason in the caption.
std::string to_latex(const TextTable& table, std::string_view label = "tab:mechanical-energy-model");

}  // namespace flightwatt::mechanical
