#include "compute/powprofiler/power_recording.h"

#include "base/error.h"
#include "compute/powprofiler/powprofiler_csv.h"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::compute {

double mean_power_w(const PowerRecording& recording) {
    return std::accumulate(recording.power_w.begin(), recording.power_w.end(), 0.0) /
           static_cast<double>(recording.power_w.size());
}

double duration_s(const PowerRecording& recording) {
    return static_cast<double>(recording.power_w.size()) / recording.sampling_hz;
}

double energy_j(const PowerRecording& recording) { return mean_power_w(recording) * duration_s(recording); }

PowerRecording power_recording_from(const CsvTable& table, double sampling_hz) {
    if (!(sampling_hz > 0.0) || !std::isfinite(sampling_hz)) {
        throw InputError({table.file},
                         fmt::format("cannot be sampled at {} Hz, expected more than 0", sampling_hz));
    }
    const auto columns = powprofiler_columns(table);
    if (!columns || !columns->parameters.empty()) {
        throw InputError({table.file, table.rows.front().line},
                         "is no powprofiler layer 1, whose first row is 100,101,102",
                         columns ? "flags from 200 are QoS parameters: this is a layer 2" : "");
    }
    PowerRecording recording{{}, sampling_hz};
    for (std::size_t i = 1; i < table.rows.size(); ++i) {
        recording.power_w.push_back(cell_number(table, table.rows[i], columns->power));
    }
    if (recording.power_w.empty()) {
        throw InputError({table.file, table.rows.front().line}, "has a header and no samples");
    }
    return recording;
}

PowerRecording read_power_recording(const std::filesystem::path& path, double sampling_hz) {
    return power_recording_from(read_csv(path, CsvHeader::absent), sampling_hz);
}

}  // namespace flightwatt::compute
