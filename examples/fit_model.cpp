// A power model of several flights of one aircraft: fit_model MODEL.toml LOG...

#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

#include <flightwatt/model.h>

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    try {
        const std::vector<std::filesystem::path> files(argv + 2, argv + argc);
        const auto model = flightwatt::fit_model(flightwatt::read_logs(files));
        for (const auto phase : {flightwatt::Phase::takeoff, flightwatt::Phase::cruise, flightwatt::Phase::landing}) {
            const double duration_s = flightwatt::duration_s(model, phase);
            std::printf("%s: %.1f s, %.2f W on average, %.2f W in the middle, by the %s\n", flightwatt::name_of(phase),
                        duration_s, flightwatt::mean_power_w(model, phase),
                        flightwatt::power_w(model, phase, duration_s / 2.0),
                        flightwatt::has_curve(model, phase) ? "curve" : "mean");
        }
        flightwatt::write_model(model, argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fit_model: %s\n", error.what());
        return 3;
    }
}
