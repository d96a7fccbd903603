#pragma once

#include "base/text_table.h"
#include "mechanical/model_fit.h"
#include "mechanical/prediction.h"
#include "report/batch_content.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace flightwatt::report {

/// What flightwatt predict would have said at a moment: what was measured until then and what was to come.
struct PredictedMoment {
    double flown_s = 0.0;    ///< since lift-off
    double energy_wh = 0.0;  ///< of the whole flight
    mechanical::EnergyInterval interval;
};

/// A flight that was predicted while it cruised.
struct PredictedFlight {
    std::vector<PredictedMoment> moments;  ///< every minute of the cruise
    double measured_wh = 0.0;              ///< of the whole flight
    std::size_t others = 0;                ///< flights that the model was fitted to
};

/// Each flight of one complete sortie, predicted by a model of the other flights, from nothing that was logged later
/// but the durations of cruise and landing, taken as known. By the flights' names; flights without a prediction are not
/// in it, and none is where there are less than 3 flights or more than `max_flights`.
std::map<std::string, PredictedFlight> predict_each_minute(const BatchContent& content, std::size_t max_flights);

/// A row a flight: the energy [Wh] that was predicted in the first, the middle and the last of these moments, with its
/// 95 % interval, beside the measured one, and the percentage of all moments' intervals that hold it.
TextTable predictions_table(const std::map<std::string, PredictedFlight>& flights);

}  // namespace flightwatt::report
