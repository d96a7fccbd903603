#pragma once

#include "mission/mission.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mission {

/// State of charge [points] that the battery has lost since a phase began, at evenly spread times, while one
/// configuration runs; with its rate, so that cubics between the nodes are smooth.
struct PhaseDepletion {
    struct Node {
        double depleted_percent = 0.0;
        double percent_per_s = 0.0;
    };
    double duration_s = 0.0;
    double cells_per_s = 0.0;
    bool deliverable = true;                       ///< all of it
    std::vector<Node> nodes;                       ///< cells + 1; empty for a phase that is not flown
    std::vector<std::size_t> undeliverable_cells;  ///< how many up to each node are beyond the power limit
    double error_percent = 0.0;  ///< the greatest seen halfway between nodes, and that of the quadrature
    /// Of a phase in pieces, whose power jumps: one for each piece, instead of nodes.
    struct Piece;
    std::vector<Piece> pieces;
};

struct PhaseDepletion::Piece {
    double start_s = 0.0;
    double depleted_before_percent = 0.0;
    PhaseDepletion depletion;
};

/// Cumulative depletion by every configuration over every phase of a mission. Where the current depends on the power
/// alone, a schedule depletes a sum of differences of its entries.
struct DepletionTable {
    std::vector<compute::Configuration> configurations;
    std::vector<PerPhase<PhaseDepletion>> depletions;  ///< one a configuration
    double initial_soc_percent = 100.0;
    bool charges = false;        ///< somewhere: what a full battery then refuses depends on the state of charge
    double error_percent = 0.0;  ///< the greatest of the phases'
};

/// A part of a phase in which one of the table's configurations runs.
struct IndexedSegment : PhaseSegment {
    std::size_t configuration = 0;
};

/// Tabulates the mission's phases for the configurations. Without resistance entries are the closed integral of
/// Eq. 1; with it, Gauss quadrature. Cells are halved until the error is under 1e-8 points (or there are 2^16 of
/// them). What the cut-off voltage forbids counts as undeliverable. Throws std::invalid_argument for a battery whose
/// source follows its charge.
DepletionTable make_depletion_table(const MissionSetup& mission, std::vector<compute::Configuration> configurations);

/// None if the table does not hold the configuration.
std::optional<std::size_t> index_of(const DepletionTable& table, const compute::Configuration& run);

/// A schedule in terms of a table. Throws std::invalid_argument for a configuration that it does not hold.
std::vector<IndexedSegment> to_indexed(const Schedule& schedule, const DepletionTable& table);

/// The depletion by a segment [points]; infinite if the battery cannot deliver its power.
double soc_depletion_percent(const DepletionTable& table, const IndexedSegment& segment);

/// State of charge after a whole schedule, as if the battery went on below empty. None where the table does not hold:
/// it charges, or cannot be delivered.
std::optional<double> soc_after_schedule(const DepletionTable& table, std::span<const IndexedSegment> schedule);

}  // namespace flightwatt::mission
