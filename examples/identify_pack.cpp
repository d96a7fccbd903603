// The battery of several flights: identify_pack PACK.toml CAPACITY_AH LOG...

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <vector>

#include <flightwatt/battery.h>

int main(int argc, char** argv) {
    if (argc < 4) return 2;
    try {
        const std::vector<std::filesystem::path> files(argv + 3, argv + argc);
        const auto pack = flightwatt::identify_pack(flightwatt::read_logs(files), {.capacity_ah = std::atof(argv[2])});
        std::printf("%.2f Ah, %.4f ohm", flightwatt::capacity_ah(pack), flightwatt::resistance_ohm(pack));
        if (const auto interval = flightwatt::resistance_interval_ohm(pack))
            std::printf(" (%.4f to %.4f ohm in 95 %%)", interval->first, interval->second);
        std::printf("\n");
        for (const double soc_percent : {100.0, 50.0, 20.0, 0.0})
            std::printf("%5.0f %%  %.2f V\n", soc_percent, flightwatt::open_circuit_voltage_v(pack, soc_percent));
        flightwatt::write_pack(pack, argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "identify_pack: %s\n", error.what());
        return 3;
    }
}
