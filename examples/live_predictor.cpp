// How a flight will land, once a second while it flies: an example of flightwatt::live.
//   live_predictor LOG.log MISSION.toml < LOG.data
//   live_predictor LOG.log MODEL.toml REMAINING_S BATTERY.toml < LOG.data

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include <flightwatt/predictor.h>

namespace {

void print(const flightwatt::live::PredictorState& now) {
    if (!now.landing) return;
    const auto& landing = *now.landing;
    std::printf("%.3f s  %.17g Wh so far, %.17g to %.17g more", now.time_s, now.energy_wh.value_or(0.0),
                landing.energy_low_wh, landing.energy_high_wh);
    if (landing.soc_percent) std::printf(", lands with %.17g %% at %.17g V", *landing.soc_percent, *landing.voltage_v);
    if (landing.chance_below_reserve) std::printf(", below the reserve: %.17g", *landing.chance_below_reserve);
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 && argc != 5) return 2;
    flightwatt::live::PredictorSetup setup;
    setup.definitions_file = argv[1];
    if (argc == 3) {
        setup.mission_file = argv[2];
    } else {
        setup.model_file = argv[2];
        setup.remaining_s = std::atof(argv[3]);
        setup.battery_file = argv[4];
    }
    const auto made = flightwatt::live::make_predictor(setup);
    if (!made.predictor) {
        std::fprintf(stderr, "live_predictor: %s\n", made.error.c_str());
        return 3;
    }
    auto& predictor = *made.predictor;
    double updated_at_s = -1.0;
    for (std::string line; std::getline(std::cin, line);) {
        const double time_s = std::atof(line.c_str());
        if (!predictor.push_line(line)) std::fprintf(stderr, "live_predictor: a line was dropped\n");
        if (time_s - updated_at_s < 1.0) continue;
        updated_at_s = time_s;
        print(predictor.update());
    }
    print(predictor.end());
    return 0;
}
