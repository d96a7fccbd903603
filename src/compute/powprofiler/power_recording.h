#pragma once

#include "base/csv.h"

#include <filesystem>
#include <vector>

namespace flightwatt::compute {

/// Power over time of one configuration, as powprofiler's layer 1 records it: equally spaced samples.
struct PowerRecording {
    std::vector<double> power_w;
    double sampling_hz = 0.0;
};

inline constexpr double powprofiler_sampling_hz = 10.0;  ///< what powprofiler samples at unless told

double mean_power_w(const PowerRecording& recording);
double duration_s(const PowerRecording& recording);

/// Mean power times duration [J]. The energy columns of a layer 2 are not that: see powprofiler_csv.h.
double energy_j(const PowerRecording& recording);

/// Reads a layer 1 file: columns 100 (total power), 101, 102, no time. Throws InputError for another header,
/// no samples, a cell that is no number, or a frequency that is not positive.
PowerRecording read_power_recording(const std::filesystem::path& path,
                                    double sampling_hz = powprofiler_sampling_hz);

/// The same from a table read without header, its first row the flags.
PowerRecording power_recording_from(const CsvTable& table, double sampling_hz = powprofiler_sampling_hz);

}  // namespace flightwatt::compute
