#include "log_passes.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"

#include <benchmark/benchmark.h>

/// The log reader inside one process, on the log that FLIGHTWATT_BENCH_LOG names (else the synthetic sample).
namespace flightwatt::bench {
namespace {

void count_bytes(benchmark::State& state, const telemetry::DataFile& data) {
    state.SetBytesProcessed(static_cast<std::int64_t>(data.text().size()) * state.iterations());
}

void energy_messages_of_a_log(benchmark::State& state) {
    const auto path = benchmark_log();
    const telemetry::DataFile data(path);
    std::optional<telemetry::LogConfiguration> configuration;
    if (const auto log_file = telemetry::find_log_file(path))
        configuration = telemetry::read_log_configuration(*log_file);
    for (auto _ : state) {
        benchmark::DoNotOptimize(parse_telemetry(data.text(), path, configuration, energy_messages()));
    }
    count_bytes(state, data);
}
BENCHMARK(energy_messages_of_a_log)->Unit(benchmark::kMillisecond);

void every_message_into_words(benchmark::State& state) {
    const telemetry::DataFile data(benchmark_log());
    for (auto _ : state) benchmark::DoNotOptimize(count_words(data.text()));
    count_bytes(state, data);
}
BENCHMARK(every_message_into_words)->Unit(benchmark::kMillisecond);

void every_message_as_numbers(benchmark::State& state) {
    const telemetry::DataFile data(benchmark_log());
    for (auto _ : state) benchmark::DoNotOptimize(count_numbers(data.text()));
    count_bytes(state, data);
}
BENCHMARK(every_message_as_numbers)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flightwatt::bench

BENCHMARK_MAIN();
