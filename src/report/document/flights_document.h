#pragma once

#include "base/parallel.h"
#include "report/batch_content.h"
#include "report/document/battery_document.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::report {

/// A flight of a log, with its summary.
struct SortieRow {
    std::string flight;  ///< with the number of the sortie, if the log has several
    std::size_t sortie = 1;
    FlightSummary facts;
    std::string_view used;  ///< see fitted_part
};
Fields<SortieRow> record_fields(const SortieRow*);

/// An edge of a phase with its name and evidence.
struct NamedEdge {
    double time_s = 0.0;
    std::string name;
    std::string evidence;
};
Fields<NamedEdge> record_fields(const NamedEdge*);

/// Returns the edges of a flight's phases; the common edge of two phases once.
std::vector<NamedEdge> name_edges(const ReportFlight& flight);

/// Returns the tracks of an accepted flight over time, as they are drawn on so many pixel columns (FlightDetail of
/// web/app/src/documents.ts). `model` and `battery` may be null.
Json flight_detail(const ReportFlight& flight, const mechanical::MechanicalModel* model, const ReportBattery* battery,
                   std::size_t columns);

/// The flights of a document.
struct FlightsDocument {
    Json flights = Json::array();
    Json exclusions = Json::array();
};

/// Makes the flights of a document. The details of more than 20 flights are compressed, and coarser except
/// `for_figures`. `battery` may be null.
FlightsDocument make_flights(const BatchContent& batch, const ReportBattery* battery, bool for_figures,
                             LatexTables& tables, const Progress& progress = {});

}  // namespace flightwatt::report
