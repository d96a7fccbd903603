// What a live predictor takes of memory and time in a flight:
//   live_allocations LOG.data MODEL.toml REMAINING_S BATTERY.toml | LOG.data MISSION.toml [--replan]
// Counts what operator new is asked for after the start. Exit code 1 where a push is refused, or where an update allocates
// more often than ever was seen.

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include <flightwatt/predictor.h>
#include <malloc.h>

namespace {

struct Allocations {
    std::size_t count = 0;
    std::size_t bytes = 0;
    std::size_t live_bytes = 0;
    std::size_t peak_bytes = 0;
};
Allocations allocations;

void* allocate(std::size_t size) {
    void* const memory = std::malloc(size);
    if (memory == nullptr) throw std::bad_alloc();
    ++allocations.count;
    allocations.bytes += size;
    allocations.live_bytes += malloc_usable_size(memory);
    allocations.peak_bytes = std::max(allocations.peak_bytes, allocations.live_bytes);
    return memory;
}

void release(void* memory) {
    if (memory == nullptr) return;
    allocations.live_bytes -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t& /*nothrow*/) noexcept {
    try {
        return allocate(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }

namespace {

using flightwatt::live::PredictorSetup;

double processor_ms() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

PredictorSetup setup_of(int argc, char** argv) {
    PredictorSetup setup;
    setup.definitions_file = std::filesystem::path(argv[1]).replace_extension(".log").string();
    setup.initial_soc_percent = 90.0;
    if (argc == 5) {
        setup.model_file = argv[2];
        setup.remaining_s = std::atof(argv[3]);
        setup.battery_file = argv[4];
    } else {
        setup.mission_file = argv[2];
        setup.replan = argc == 4;
    }
    return setup;
}

struct Look {
    std::size_t allocations = 0;
    double ms = 0.0;
    bool predicts = false;
};

std::vector<std::string> lines_of(const char* file) {
    std::vector<std::string> lines;
    std::ifstream log(file);
    for (std::string line; std::getline(log, line);) lines.push_back(line);
    return lines;
}

void print(const std::vector<Look>& looks, bool predicts) {
    std::size_t count = 0;
    std::size_t most = 0;
    std::size_t sum = 0;
    double sum_ms = 0.0;
    double max_ms = 0.0;
    for (const auto& look : looks) {
        if (look.predicts != predicts) continue;
        ++count;
        sum += look.allocations;
        most = std::max(most, look.allocations);
        sum_ms += look.ms;
        max_ms = std::max(max_ms, look.ms);
    }
    if (count == 0) return;
    std::printf("looks %s a prediction: %zu, allocations mean %zu, most %zu, processor mean %.2f, most %.2f ms\n",
                predicts ? "with" : "without", count, sum / count, most, sum_ms / static_cast<double>(count), max_ms);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 5) return 2;
    const auto lines = lines_of(argv[1]);
    const auto made = flightwatt::live::make_predictor(setup_of(argc, argv));
    if (!made.predictor) {
        std::fprintf(stderr, "%s\n", made.error.c_str());
        return 3;
    }
    auto& predictor = *made.predictor;
    std::vector<Look> looks;
    looks.reserve(lines.size());
    std::size_t pushes = 0;
    std::size_t in_pushes = 0;
    double most_push_ms = 0.0;
    double looked_at_s = 0.0;
    std::size_t settled_bytes = 0;
    std::size_t most_left_bytes = 0;
    const auto start_bytes = allocations.live_bytes;
    allocations.peak_bytes = start_bytes;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto before = allocations.count;
        const double push_ms = processor_ms();
        pushes += predictor.push_line(lines[i]) ? 1 : 0;
        most_push_ms = std::max(most_push_ms, processor_ms() - push_ms);
        in_pushes += allocations.count - before;
        const double time_s = std::atof(lines[i].c_str());
        if (time_s < looked_at_s + 1.0) continue;
        looked_at_s = time_s;
        const auto before_look = allocations.count;
        const double start_ms = processor_ms();
        const bool predicts = predictor.update().landing.has_value();
        looks.push_back({allocations.count - before_look, processor_ms() - start_ms, predicts});
        if (i < lines.size() / 2) settled_bytes = allocations.live_bytes;
        most_left_bytes = std::max(most_left_bytes, allocations.live_bytes);
    }
    std::printf("pushes %zu of %zu, allocations %zu, processor most %.3f ms\n", pushes, lines.size(), in_pushes,
                most_push_ms);
    print(looks, true);
    print(looks, false);
    std::printf("MB since the start: left behind %.1f at half of the flight, %.1f at most; in an update %.1f at most\n",
                static_cast<double>(settled_bytes - start_bytes) / 1e6,
                static_cast<double>(most_left_bytes - start_bytes) / 1e6,
                static_cast<double>(allocations.peak_bytes - start_bytes) / 1e6);
    constexpr std::size_t most_in_a_look = 1'500;  // 1,241 were seen, on a real flight of 29 minutes
    const bool looks_are_lean =
        std::ranges::all_of(looks, [](const Look& look) { return look.allocations <= most_in_a_look; });
    return pushes == lines.size() && looks_are_lean ? 0 : 1;
}
