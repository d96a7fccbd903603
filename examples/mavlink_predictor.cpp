// How an aircraft will land, on its own companion computer: MAVLink from a serial line, or from a file or pipe of its bytes.
//   mavlink_predictor MISSION.toml /dev/ttyAMA0
// The line's speed is set before: stty -F /dev/ttyAMA0 raw 57600

#include <chrono>
#include <cstdio>

#include <fcntl.h>
#include <flightwatt/predictor.h>
#include <poll.h>
#include <unistd.h>

namespace {

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void print(const flightwatt::live::PredictorState& now) {
    if (!now.landing)
        std::printf("waits for %s\n", now.waits_for.c_str());
    else if (now.landing->soc_percent)
        std::printf("lands with %.0f %%\n", *now.landing->soc_percent);
    for (const auto& alarm : now.alarms) std::printf("%s: %s\n", alarm.grade.c_str(), alarm.action.c_str());
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    flightwatt::live::PredictorSetup setup;
    setup.mission_file = argv[1];
    setup.input = flightwatt::live::PredictorInput::mavlink;
    const auto made = flightwatt::live::make_predictor(setup);
    const int line = ::open(argv[2], O_RDONLY | O_NOCTTY);
    if (!made.predictor || line < 0) {
        std::fprintf(stderr, "mavlink_predictor: %s\n", made.predictor ? argv[2] : made.error.c_str());
        return 3;
    }
    char bytes[4096];
    double heard_s = now_s();
    double updated_s = heard_s;
    for (;;) {
        pollfd waiting{line, POLLIN, 0};
        const bool has_bytes = ::poll(&waiting, 1, 1000) > 0;  // a line that is silent has its alarm, too
        const ssize_t count = has_bytes ? ::read(line, bytes, sizeof bytes) : 0;
        if (has_bytes && count <= 0) break;
        if (has_bytes) heard_s = now_s();
        if (has_bytes) made.predictor->push_frames(heard_s, {bytes, static_cast<std::size_t>(count)});
        if (now_s() - updated_s < 1.0) continue;
        updated_s = now_s();
        print(made.predictor->update(updated_s - heard_s));
    }
    print(made.predictor->end());
    return 0;
}
