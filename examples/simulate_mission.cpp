// How a mission lands: simulate_mission MISSION.toml [DRAWN_FLIGHTS]

#include <cstdio>
#include <cstdlib>
#include <exception>

#include <flightwatt/mission.h>

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    try {
        const std::size_t drawn = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
        const auto result = flightwatt::simulate_mission(argv[1], {.step_s = 60.0, .drawn_flights = drawn});
        for (const auto& point : result.curve)
            std::printf("%7.1f s %6.2f %% %7.1f W %6.2f V\n", point.time_s, point.soc_percent, point.power_w,
                        point.voltage_v);
        if (!result.final_soc_percent) {
            std::printf("%s: the battery cannot deliver the power\n", result.name.c_str());
            return 0;
        }
        std::printf("%s: %.17g %% left after %.0f s and %.17g Wh, %s the reserve\n", result.name.c_str(),
                    *result.final_soc_percent, result.duration_s, result.energy_wh,
                    result.keeps_reserve ? "with" : "below");
        if (result.probability_below_reserve)
            std::printf("below the reserve: %.17g of drawn flights\n", *result.probability_below_reserve);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "simulate_mission: %s\n", error.what());
        return 3;
    }
}
