// Flights and phases of logs with their energies: read_log LOG...

#include <cstdio>
#include <exception>

#include <flightwatt/flight.h>
#include <flightwatt/log.h>

namespace {

void print(const flightwatt::Log& log) {
    const auto power = log.track("power_w");
    std::printf("%s of %s: %zu samples of power from %s\n", log.name().c_str(), log.aircraft().c_str(),
                power.value.size(), power.source.c_str());
    for (const auto& warning : log.warnings()) std::printf("  warning: %s\n", warning.c_str());
    if (!log.exclusion().empty()) std::printf("  not to be used: %s\n", log.exclusion().c_str());
    for (const auto& flight : flightwatt::find_flights(log)) {
        for (const auto& part : flight.parts)
            std::printf("  %s %.17g s %.17g Wh %.17g W%s\n", flightwatt::name_of(part.phase), part.end_s - part.start_s,
                        part.energy_wh, part.mean_power_w, part.complete ? "" : ", incomplete");
        std::printf("  %s: %.17g Wh in %.17g s\n", flight.name.c_str(), flight.energy_wh(), flight.duration_s());
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        for (int i = 1; i < argc; ++i)
            for (const auto& log : flightwatt::read_log(argv[i])) print(log);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "read_log: %s\n", error.what());
        return 3;
    }
}
